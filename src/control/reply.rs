//! The answer to a command: exactly one line, whatever becomes of the command.

use serde_json::{Map, Value, json};

use super::Client;

/// Receives the result of a command that the window itself issued.
type Taken = Box<dyn FnOnce(Result<Value, String>) + Send>;

/// The number of a client, and the identifier of one of its commands.
pub(crate) type Key = (u64, Value);

/// A command, and the client that waits for its answer.
pub(crate) struct Asked {
    /// Its name, which may be unknown.
    pub(crate) command: String,
    pub(crate) fields: Map<String, Value>,
    pub(crate) reply: Reply,
}

/// The client that waits for the answer to a command. Dropping it answers that the command was not carried out.
pub(crate) struct Reply {
    to: To,
    id: Value,
    command: String,
}

enum To {
    Client(Client),
    Window(Taken),
    /// The reply has been sent.
    Nobody,
}

impl Reply {
    pub(super) fn new(client: &Client, id: Value, command: String) -> Self {
        client.begin();
        Self { to: To::Client(client.clone()), id, command }
    }

    /// A reply to a command that the window itself issued.
    pub(crate) fn to_window(take: impl FnOnce(Result<Value, String>) + Send + 'static) -> Self {
        Self { to: To::Window(Box::new(take)), id: Value::Null, command: String::new() }
    }

    /// The number of the client, 0 for the window itself, and the identifier in the line of the command, null without one.
    pub(crate) fn key(&self) -> Key {
        let client = if let To::Client(client) = &self.to { client.number() } else { 0 };
        (client, self.id.clone())
    }

    /// Answers that the command is done. `result` is its result, or null.
    pub(crate) fn done(mut self, result: Value) {
        self.answer(Ok(result), Value::Null);
    }

    /// Answers that the command cannot be carried out, and why.
    pub(crate) fn error(mut self, message: impl Into<String>) {
        self.answer(Err(message.into()), Value::Null);
    }

    /// [`Reply::error`] with more fields than a message.
    pub(crate) fn error_with(mut self, message: impl Into<String>, fields: Value) {
        self.answer(Err(message.into()), fields);
    }

    /// Reports the progress of the command.
    pub(crate) fn progress(&self, done: u64, of: u64) {
        if let To::Client(client) = &self.to {
            let line = json!({ "event": "progress", "id": self.id, "command": self.command, "done": done, "of": of });
            client.send(&line.to_string().into());
        }
    }

    fn answer(&mut self, result: Result<Value, String>, fields: Value) {
        let client = match std::mem::replace(&mut self.to, To::Nobody) {
            To::Client(client) => client,
            To::Window(take) => return take(result),
            To::Nobody => return,
        };
        let mut line = json!({ "event": "done", "id": self.id, "command": self.command });
        match result {
            Ok(Value::Null) => {}
            Ok(result) => line["result"] = result,
            Err(message) => {
                line["event"] = json!("error");
                line["message"] = json!(message);
                if let Value::Object(fields) = fields {
                    fields.into_iter().for_each(|(key, value)| line[key] = value);
                }
            }
        }
        client.answer(&line.to_string().into());
        client.end();
    }
}

impl Drop for Reply {
    fn drop(&mut self) {
        self.answer(
            Err("this was not done: the window is closing, or a thread of it has failed".to_owned()),
            Value::Null,
        );
    }
}
