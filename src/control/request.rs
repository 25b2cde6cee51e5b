//! The commands, and how a line becomes one. What is wrong with a line is told in words that help: the nearest command or field, and
//! what a field takes.

use std::path::PathBuf;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::described::COMMANDS;
use super::fields::{
    Camera, Capture, Compare, Grid, Numbers, Pick, Playback, Probe, Run, Sheet, Timeline, Turntable, WriteDefaults,
};
use super::values::assignments;
use crate::message::did_you_mean;

/// A command.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    Set(Vec<String>),
    Get(Option<String>),
    Mode(String),
    Camera(Camera),
    Capture(Capture),
    Probe(Probe),
    Reload,
    Open(Open),
    Compare(Compare),
    /// Slugs of the modes to show side by side; fewer than two end that.
    Grid(Vec<String>),
    /// A pixel of the picture to click, or none to take the last click back.
    Pick(Option<[u32; 2]>),
    /// Names of the parameters whose values become the defaults in the files; empty for all.
    WriteDefaults(Vec<String>),
    Numbers(Numbers),
    /// The number of the version to write to the files, if any.
    Versions(VersionsRequest),
    Undo,
    Redo,
    Pass(String, Option<bool>),
    Playback(Playback),
    Modes,
    Settings,
    Commands,
    Entries,
    Run(Run),
    Sheet(Sheet),
    Turntable(Turntable),
    Timeline(Timeline),
    Cancel,
    Quit,
}

/// Argument of `open`.
#[derive(Clone, Debug, PartialEq)]
pub enum Open {
    File(PathBuf),
    Model(PathBuf),
    Environment(PathBuf),
    Tree(PathBuf),
    Look(PathBuf),
    Measured(PathBuf),
}

/// The uses of `versions`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VersionsRequest {
    /// Lists them.
    List,
    /// Writes one over the files.
    Write(u64),
    /// Shows one in place of the newest.
    Show(u64),
    /// Goes back to the newest.
    ShowNewest,
}

/// A line as a command.
pub(super) struct Parsed {
    /// The line's own `id`; null without one.
    pub(super) id: Value,
    /// The command's name as it was sent.
    pub(super) command: String,
    /// The command, or the error.
    pub(super) request: Result<Request, String>,
}

/// Parses a line.
pub(super) fn parse(line: &[u8]) -> Parsed {
    let failed = |message: String| Parsed { id: Value::Null, command: String::new(), request: Err(message) };
    let mut fields = match serde_json::from_slice(line) {
        Ok(Value::Object(fields)) => fields,
        Ok(other) => return failed(format!("expected a JSON object, as {EXAMPLE}, found {}", kind(&other))),
        Err(error) => return failed(format!("no JSON: {error}. Expected an object in one line, as {EXAMPLE}")),
    };
    let id = fields.remove("id").unwrap_or_default();
    match fields.remove("command") {
        Some(Value::String(command)) => {
            let request = request(&command, fields);
            Parsed { id, command, request }
        }
        other => {
            let found = other.map_or_else(|| "none".to_owned(), |other| kind(&other).to_owned());
            let request = Err(format!("`command` is missing: expected its name, as {EXAMPLE}, found {found}"));
            Parsed { id, command: String::new(), request }
        }
    }
}

const EXAMPLE: &str = r#"{"id": 1, "command": "set", "values": {"view.ev": 1}}"#;

fn request(command: &str, mut fields: Map<String, Value>) -> Result<Request, String> {
    let nothing = |request: Request, fields: Map<String, Value>| match fields.keys().next() {
        None => Ok(request),
        Some(field) => Err(format!("`{command}` has no field `{field}`; it takes none")),
    };
    Ok(match command {
        "set" => {
            let values = fields.remove("values").unwrap_or_default();
            nothing(Request::Set(assignments(&values)?), fields)?
        }
        "get" => {
            let path = text(&mut fields, "path")?;
            nothing(Request::Get(path), fields)?
        }
        "mode" => {
            let name = text(&mut fields, "name")?.ok_or_else(|| needs(command))?;
            nothing(Request::Mode(name), fields)?
        }
        "camera" => Request::Camera(of(command, fields, &[])?),
        "capture" => Request::Capture(of(command, fields, &[])?),
        "probe" => Request::Probe(of(command, fields, &["at"])?),
        "reload" => nothing(Request::Reload, fields)?,
        "open" => Request::Open(open(&fields)?),
        "compare" => Request::Compare(of(command, fields, &[])?),
        "grid" => Request::Grid(of::<Grid>(command, fields, &["modes"])?.modes),
        "pick" => Request::Pick(of::<Pick>(command, fields, &[])?.at),
        "numbers" => Request::Numbers(of(command, fields, &[])?),
        "write-defaults" => Request::WriteDefaults(of::<WriteDefaults>(command, fields, &[])?.names),
        "versions" => {
            let mut take = |field: &str| fields.remove(field).filter(|value| !value.is_null());
            let number = |field: &str, value: Value| {
                value.as_u64().ok_or_else(|| format!("`{field}` is no number of a version: {value}"))
            };
            let request = match (take("write"), take("show")) {
                (None, None) => VersionsRequest::List,
                (Some(write), _) => VersionsRequest::Write(number("write", write)?),
                (None, Some(show)) if show == "newest" => VersionsRequest::ShowNewest,
                (None, Some(show)) => VersionsRequest::Show(number("show", show)?),
            };
            nothing(Request::Versions(request), fields)?
        }
        "undo" => nothing(Request::Undo, fields)?,
        "redo" => nothing(Request::Redo, fields)?,
        "pass" => {
            let name = text(&mut fields, "name")?.ok_or_else(|| needs(command))?;
            let on = fields.remove("on").filter(|on| !on.is_null());
            let on = on.map(|on| on.as_bool().ok_or(format!("`on` cannot be {on}; it takes true or false")));
            nothing(Request::Pass(name, on.transpose()?), fields)?
        }
        "playback" => Request::Playback(of(command, fields, &[])?),
        "modes" => nothing(Request::Modes, fields)?,
        "settings" => nothing(Request::Settings, fields)?,
        "commands" | "help" => nothing(Request::Commands, fields)?,
        "entries" => nothing(Request::Entries, fields)?,
        "run" => Request::Run(of(command, fields, &["entry"])?),
        "sheet" => Request::Sheet(of(command, fields, &["file"])?),
        "turntable" => Request::Turntable(of(command, fields, &["file"])?),
        "timeline" => Request::Timeline(of(command, fields, &["file"])?),
        "cancel" => nothing(Request::Cancel, fields)?,
        "quit" => nothing(Request::Quit, fields)?,
        unknown => {
            let hint = did_you_mean(unknown, COMMANDS.iter().map(|known| known.command));
            return Err(format!("there is no command `{unknown}`.{hint} `commands` lists them all"));
        }
    })
}

/// The fields of a command. All but `required` may be left out; null leaves a field out, too.
fn of<T: DeserializeOwned>(command: &str, mut fields: Map<String, Value>, required: &[&str]) -> Result<T, String> {
    fields.retain(|_, value| !value.is_null());
    if required.iter().any(|field| !fields.contains_key(*field)) {
        return Err(needs(command));
    }
    // serde does not report which field is wrong, so each field is tried alone.
    for (field, value) in &fields {
        let alone = Map::from_iter([(field.clone(), value.clone())]);
        if let Err(error) = serde_json::from_value::<T>(Value::Object(alone)) {
            let what = error.to_string();
            let what = if what.starts_with("unknown field") { what } else { format!("`{field}`: {what}") };
            return Err(format!("{what}. `{command}` takes {}", takes(command)));
        }
    }
    serde_json::from_value(Value::Object(fields))
        .map_err(|error| format!("{error}. `{command}` takes {}", takes(command)))
}

fn takes(command: &str) -> &'static str {
    COMMANDS.iter().find(|known| known.command == command).map_or("", |known| known.takes)
}

fn needs(command: &str) -> String {
    format!("`{command}` needs {}", takes(command))
}

/// Takes a text field.
fn text(fields: &mut Map<String, Value>, field: &str) -> Result<Option<String>, String> {
    match fields.remove(field) {
        None | Some(Value::Null) => Ok(None),
        Some(Value::String(text)) => Ok(Some(text)),
        Some(other) => Err(format!("`{field}` takes text, found {}", kind(&other))),
    }
}

fn open(fields: &Map<String, Value>) -> Result<Open, String> {
    let mut given = fields.iter();
    let (Some((field, Value::String(path))), None) = (given.next(), given.next()) else { return Err(needs("open")) };
    let path = PathBuf::from(path);
    Ok(match field.as_str() {
        "file" => Open::File(path),
        "model" => Open::Model(path),
        "environment" => Open::Environment(path),
        "tree" => Open::Tree(path),
        "look" => Open::Look(path),
        "measured" => Open::Measured(path),
        unknown => {
            let hint = did_you_mean(unknown, ["file", "model", "environment", "tree", "look", "measured"]);
            return Err(format!("`open` has no field `{unknown}`.{hint} It takes {}", takes("open")));
        }
    })
}

fn kind(value: &Value) -> &'static str {
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

    fn parsed(line: &Value) -> Result<Request, String> {
        parse(line.to_string().as_bytes()).request
    }

    #[test]
    fn commands_are_parsed() {
        let set = json!({"id": "a", "command": "set", "values": {"view.ev": 1}});
        let Parsed { id, command, request } = parse(set.to_string().as_bytes());
        assert_eq!((id, command.as_str()), (json!("a"), "set"));
        assert_eq!(request, Ok(Request::Set(vec!["view.ev=1".into()])));
        let capture = json!({"command": "capture", "file": "a.exr", "size": [64, 32], "mode": null});
        let expected = Capture { file: Some("a.exr".into()), size: Some([64, 32]), ..Capture::default() };
        assert_eq!(parsed(&capture), Ok(Request::Capture(expected)));
        assert_eq!(
            parsed(&json!({"command": "open", "model": "a.glb"})),
            Ok(Request::Open(Open::Model("a.glb".into())))
        );
        assert_eq!(parsed(&json!({"command": "pass", "name": "bloom"})), Ok(Request::Pass("bloom".into(), None)));
    }

    #[test]
    fn every_command_of_the_list_exists() {
        for known in COMMANDS {
            let error = parsed(&json!({"command": known.command})).err().unwrap_or_default();
            assert!(!error.contains("there is no command"), "{error}");
            let error = parsed(&json!({"command": known.command, "nonsense": 1})).unwrap_err();
            assert!(!error.is_empty());
        }
    }

    #[test]
    fn mistakes_are_told() {
        for (line, part) in [
            (json!({"command": "sett"}), "there is no command `sett`. Did you mean `set`?"),
            (json!({"comand": "set"}), "`command` is missing"),
            (json!([1]), "expected a JSON object"),
            (json!({"command": "probe"}), "`probe` needs \"at\": [x,y]"),
            (json!({"command": "probe", "at": [1, "x"]}), "`at`: invalid type"),
            (json!({"command": "probe", "at": [1, -2]}), "`at`: invalid value"),
            (json!({"command": "capture", "sise": 1}), "unknown field `sise`, expected one of"),
            (json!({"command": "undo", "twice": true}), "`undo` has no field `twice`; it takes none"),
            (json!({"command": "open"}), "`open` needs"),
            (json!({"command": "open", "modell": "a"}), "Did you mean `model`?"),
            (json!({"command": "mode", "name": 1}), "`name` takes text, found a number"),
            (json!({"command": "pass", "name": "a", "on": 1}), "`on` cannot be 1; it takes true or false"),
        ] {
            let error = parsed(&line).unwrap_err();
            assert!(error.contains(part), "{line}: {error}");
        }
        assert!(parse(b"{\"a\"").request.unwrap_err().starts_with("no JSON: "));
        assert!(parse(b"\xff\xfe").request.unwrap_err().starts_with("no JSON: "));
    }
}
