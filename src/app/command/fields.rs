//! The fields of a line as the arguments of a command. A message about a mistake names the field and says what the command takes.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::about::About;
use crate::control::kind;

/// The fields of a line but for `id` and `command`.
pub(in crate::app) type Fields = Map<String, Value>;

/// The fields of a type. All but the required ones may be left out; null leaves a field out, too.
pub(super) fn typed<T: DeserializeOwned>(about: &About, mut fields: Fields) -> Result<T, String> {
    fields.retain(|_, value| !value.is_null());
    if about.required.iter().any(|field| !fields.contains_key(*field)) {
        return Err(needs(about));
    }
    let wrong = |what: String| format!("{what}. `{}` takes {}", about.id, about.takes.unwrap_or_default());
    // serde does not report which field is wrong, so each field is tried alone.
    for (field, value) in &fields {
        let alone = Map::from_iter([(field.clone(), value.clone())]);
        if let Err(error) = serde_json::from_value::<T>(Value::Object(alone)) {
            let what = error.to_string();
            return Err(wrong(if what.starts_with("unknown field") { what } else { format!("`{field}`: {what}") }));
        }
    }
    serde_json::from_value(Value::Object(fields)).map_err(|error| wrong(error.to_string()))
}

/// No fields.
pub(super) fn none(about: &About, fields: Fields) -> Result<(), String> {
    end(about, (), fields)
}

/// `arguments`, if no field is left.
pub(super) fn end<T>(about: &About, arguments: T, left: Fields) -> Result<T, String> {
    match left.keys().next() {
        None => Ok(arguments),
        Some(field) => Err(format!("`{}` has no field `{field}`; it takes none", about.id)),
    }
}

/// A message about a missing field.
pub(super) fn needs(about: &About) -> String {
    format!("`{}` needs {}", about.id, about.takes.unwrap_or_default())
}

/// Takes a field, unless it is null.
pub(super) fn take(fields: &mut Fields, field: &str) -> Option<Value> {
    fields.remove(field).filter(|value| !value.is_null())
}

/// Takes a field with text.
pub(super) fn text(fields: &mut Fields, field: &str) -> Result<Option<String>, String> {
    match take(fields, field) {
        None => Ok(None),
        Some(Value::String(text)) => Ok(Some(text)),
        Some(other) => Err(format!("`{field}` takes text, found {}", kind(&other))),
    }
}
