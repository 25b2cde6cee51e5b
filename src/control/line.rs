//! A line as the name and the fields of a command.

use serde_json::{Map, Value};

/// A line that was read.
pub(super) struct Parsed {
    /// The line's own `id`; null without one.
    pub(super) id: Value,
    /// The command's name as it was sent.
    pub(super) command: String,
    /// The other fields, or the error.
    pub(super) fields: Result<Map<String, Value>, String>,
}

/// Parses a line.
pub(super) fn parse(line: &[u8]) -> Parsed {
    let failed = |message: String| Parsed { id: Value::Null, command: String::new(), fields: Err(message) };
    let mut fields = match serde_json::from_slice(line) {
        Ok(Value::Object(fields)) => fields,
        Ok(other) => return failed(format!("expected a JSON object, as {EXAMPLE}, found {}", kind(&other))),
        Err(error) => return failed(format!("no JSON: {error}. Expected an object in one line, as {EXAMPLE}")),
    };
    let id = fields.remove("id").unwrap_or_default();
    match fields.remove("command") {
        Some(Value::String(command)) => Parsed { id, command, fields: Ok(fields) },
        other => {
            let found = other.map_or_else(|| "none".to_owned(), |other| kind(&other).to_owned());
            let fields = Err(format!("`command` is missing: expected its name, as {EXAMPLE}, found {found}"));
            Parsed { id, command: String::new(), fields }
        }
    }
}

const EXAMPLE: &str = r#"{"id": 1, "command": "set", "values": {"view.ev": 1}}"#;

/// The kind of a value, for messages.
pub(crate) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_line_names_its_command() {
        let line = json!({"id": "a", "command": "set", "values": {"view.ev": 1}});
        let Parsed { id, command, fields } = parse(line.to_string().as_bytes());
        assert_eq!((id, command.as_str()), (json!("a"), "set"));
        assert_eq!(Value::Object(fields.unwrap()), json!({"values": {"view.ev": 1}}));
    }

    #[test]
    fn lines_without_a_command_are_refused() {
        for (line, part) in [
            ("{\"comand\": \"set\"}", "`command` is missing"),
            ("{\"command\": 1}", "found a number"),
            ("[1]", "expected a JSON object"),
            ("{\"a\"", "no JSON: "),
        ] {
            let error = parse(line.as_bytes()).fields.unwrap_err();
            assert!(error.contains(part), "{line}: {error}");
        }
        assert!(parse(b"\xff\xfe").fields.unwrap_err().starts_with("no JSON: "));
    }
}
