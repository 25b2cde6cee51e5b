//! Arguments of tools, and their schemas.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};

use crate::mcp::program::Failure;

/// Longest side of a picture, pixels.
pub const LARGEST: u32 = 2048;

/// The arguments as a type.
///
/// # Errors
/// A name or a value is wrong; the message names it.
pub fn read<T: DeserializeOwned>(mut arguments: Map<String, Value>) -> Result<T, Failure> {
    arguments.retain(|_, value| !value.is_null());
    // serde does not report which argument is wrong, so each is tried alone.
    for (name, value) in &arguments {
        let alone = Map::from_iter([(name.clone(), value.clone())]);
        if let Err(error) = serde_json::from_value::<T>(Value::Object(alone))
            && !error.to_string().starts_with("missing field")
        {
            let why = error.to_string();
            return Err(Failure::new(if why.starts_with("unknown field") { why } else { format!("`{name}`: {why}") }));
        }
    }
    serde_json::from_value(Value::Object(arguments)).map_err(|error| Failure::new(error.to_string()))
}

/// Text.
pub fn text(doc: &str) -> Value {
    json!({ "type": "string", "description": doc })
}

/// A number in a range.
pub fn number(doc: &str, low: f64, high: f64) -> Value {
    json!({ "type": "number", "minimum": low, "maximum": high, "description": doc })
}

/// A whole number of at least 0.
pub fn whole(doc: &str) -> Value {
    json!({ "type": "integer", "minimum": 0, "description": doc })
}

/// True or false.
pub fn flag(doc: &str) -> Value {
    json!({ "type": "boolean", "description": doc })
}

/// Three numbers.
pub fn vector(doc: &str) -> Value {
    json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3, "description": doc })
}

/// A list of texts.
pub fn texts(doc: &str) -> Value {
    json!({ "type": "array", "items": { "type": "string" }, "description": doc })
}

/// Width and height.
pub fn size(doc: &str) -> Value {
    json!({ "type": "array", "items": { "type": "integer", "minimum": 1, "maximum": LARGEST }, "minItems": 2, "maxItems": 2,
        "description": doc })
}

/// Whether a text has another, in any case.
pub fn has(text: &str, part: &str) -> bool {
    text.to_lowercase().contains(&part.to_lowercase())
}
