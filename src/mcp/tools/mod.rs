//! The tools that an agent sees. Each is an entry of [`TOOLS`]: its name, what it says of itself, the schema of its arguments, and the
//! commands that it asks.

mod arguments;
mod pictures;
mod scene;
mod shaders;
mod tool;
mod values;

use std::sync::Arc;

use serde_json::{Map, Value, json};

use super::diagnostics;
use super::message::Refused;
use super::program::{Call, Failure};
use super::shared::Shared;
use crate::message::did_you_mean;
use tool::{Caller, Effect, Tool, text};

/// All tools, in the order in which a client lists them.
static TOOLS: &[&Tool] = &[
    &pictures::RENDER,
    &pictures::MODES,
    &scene::OPEN,
    &scene::SETTINGS,
    &scene::SET,
    &scene::CAMERA,
    &shaders::READ_SHADER,
    &shaders::EDIT_SHADER,
    &shaders::CHECK,
    &values::PROBE,
    &values::TRACE,
    &values::FURNACE,
    &pictures::DIFF,
];

/// The tools as a client sees them.
pub fn list() -> Vec<Value> {
    let described = |tool: &&Tool| {
        let (properties, required) = (tool.schema)();
        json!({ "name": tool.name, "title": tool.title, "description": tool.doc,
            "inputSchema": { "type": "object", "properties": properties, "required": required, "additionalProperties": false },
            "annotations": { "title": tool.title, "readOnlyHint": tool.effect == Effect::Reads,
                "destructiveHint": tool.effect == Effect::Writes, "idempotentHint": true, "openWorldHint": false } })
    };
    TOOLS.iter().map(described).collect()
}

/// The tool that a request calls, and its arguments.
///
/// # Errors
/// There is no such tool, or the arguments are no object.
pub fn find(params: &mut Map<String, Value>) -> Result<(&'static Tool, Map<String, Value>), Refused> {
    let name = params.get("name").and_then(Value::as_str).ok_or_else(|| Refused::params("`name` is missing"))?;
    let tool = TOOLS.iter().find(|tool| tool.name == name).copied().ok_or_else(|| {
        let hint = did_you_mean(name, TOOLS.iter().map(|tool| tool.name));
        Refused::params(format!("there is no tool `{name}`.{hint}"))
    })?;
    match params.remove("arguments") {
        None | Some(Value::Null) => Ok((tool, Map::new())),
        Some(Value::Object(arguments)) => Ok((tool, arguments)),
        Some(_) => Err(Refused::params("`arguments` is no object")),
    }
}

/// Calls a tool. What goes wrong is part of the result, so that the agent sees it; `None` if the call was canceled.
pub(super) fn call(tool: &Tool, arguments: Map<String, Value>, shared: &Shared, call: &Arc<Call>) -> Option<Value> {
    match (tool.run)(&Caller { shared, call }, arguments) {
        Ok(content) => Some(json!({ "content": content, "isError": false })),
        Err(Failure::Canceled) => None,
        Err(Failure::Refused { message, diagnostics }) => {
            let found = diagnostics::text_of(&diagnostics);
            // The message of the program is the first diagnostic in short.
            let said = if found.is_empty() || message.contains('\n') { format!("{message}\n{found}") } else { found };
            Some(json!({ "content": [text(said.trim())], "isError": true }))
        }
    }
}
