//! A tool, and what it needs to answer a call.

use std::sync::Arc;

use serde_json::{Map, Value, json};

use crate::mcp::places::Places;
use crate::mcp::program::{Call, Failure};
use crate::mcp::shared::Shared;

/// The effect of a tool, for clients that ask their user before.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// It changes nothing.
    Reads,
    /// It changes the settings of the session, or writes a new file to the output folder.
    Changes,
    /// It writes over files.
    Writes,
}

/// A tool.
pub struct Tool {
    pub name: &'static str,
    pub title: &'static str,
    pub doc: &'static str,
    pub effect: Effect,
    /// The members of the object that the tool takes, as JSON Schema, and those that must be there.
    pub schema: fn() -> (Value, &'static [&'static str]),
    pub run: fn(&Caller<'_>, Map<String, Value>) -> Content,
}

/// The content of an answer: text and pictures.
pub type Content = Result<Vec<Value>, Failure>;

/// A call on its way.
pub struct Caller<'a> {
    pub shared: &'a Shared,
    pub call: &'a Arc<Call>,
}

impl Caller<'_> {
    /// Asks a command of the program.
    pub fn ask(&self, command: &str, fields: &Value) -> Result<Value, Failure> {
        self.shared.program.ask(self.call, command, fields)
    }

    /// Where the call may write.
    pub fn places(&self) -> &Places {
        &self.shared.places
    }
}

/// Text as content.
pub fn text(text: impl Into<String>) -> Value {
    json!({ "type": "text", "text": text.into() })
}

/// A message as a failure.
pub fn failed(message: String) -> Failure {
    Failure::new(message)
}
