//! The command `numbers`: other numbers in a line of the shaders, shown without a change of the file, or written to it.

use serde::Deserialize;
use serde_json::{Value, json};

use super::modes::shaders;
use super::shaders::write_listed;
use super::spec::{Outcome, Spec, Until};
use crate::app::actions::edits::draft;
use crate::app::engine::Engine;
use crate::app::source_line::SourceLine;
use crate::app::state::State;
use crate::shader::rewrite::Edit;

/// Fields of `numbers`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Numbers {
    at: Option<String>,
    values: Option<Vec<Option<f64>>>,
    write: bool,
}

pub(in crate::app) static NUMBERS: Spec<Numbers> = Spec::new("numbers", numbers).takes(
    r#""at"?: "brdf/ndf.glsl:20", "values"?: [0.5, null, ...], "write"?: true"#,
    "Lists the numbers of a line of the shaders, or shows the picture with other values in their place (null leaves one), without a \
     change of the file. write puts them into it; without fields it goes back to the file. Result: line, numbers; generation; edits",
);

/// Lists the numbers of a line, shows others in their place, writes these, or goes back to the file.
fn numbers(state: &mut State, engine: &mut Engine, request: Numbers) -> Outcome {
    let Some(at) = &request.at else {
        return if request.write { write_shown(state, engine) } else { Ok(show(state, engine, Vec::new())) };
    };
    let shaders = shaders(state)?;
    // Numbers that are shown already are not those of the file.
    let base = state.edits.draft.as_ref().map(|draft| (draft.path.clone(), draft.base.clone()));
    let line = SourceLine::place(&shaders, at).and_then(|(path, text, line)| {
        let text = base.as_ref().filter(|(of, _)| of == path).map_or(text, |(_, base)| base);
        SourceLine::new(&shaders, path, line, text)
    });
    let mut line = line.ok_or_else(|| format!("the shaders have no line {at}; expected FILE:LINE"))?;
    let Some(values) = request.values else {
        let numbers = line.numbers.iter().map(|(literal, value)| json!({ "text": literal.text, "value": value }));
        return Ok(Until::Now(json!({ "line": line.before.trim(), "numbers": numbers.collect::<Vec<_>>() })));
    };
    if values.len() > line.numbers.len() {
        let (given, count) = (values.len(), line.numbers.len());
        return Err(format!("`values` has {given} numbers, and the line has {count}: {}", line.before.trim()));
    }
    for ((literal, number), value) in line.numbers.iter_mut().zip(values) {
        let Some(value) = value else { continue };
        if literal.is_whole && (value.fract() != 0.0 || value < 0.0) {
            return Err(format!("{} takes a whole number, 0 or more, not {value}", literal.text));
        }
        *number = value;
    }
    if let Some(restored) = &state.edits.restored {
        return Err(format!("version {} is shown; show the newest one first", restored.number));
    }
    if state.edits.draft.as_ref().is_some_and(|draft| !draft.is_at(&line.path, line.line)) {
        return Err("the numbers of another line are shown; write them or go back to the file first".into());
    }
    let edits = line.edits();
    if request.write && !edits.is_empty() {
        return write_listed(state, engine, edits);
    }
    Ok(show(state, engine, edits))
}

/// Shows the picture with edits, or with the file.
fn show(state: &mut State, engine: &mut Engine, edits: Vec<Edit>) -> Until {
    if edits.is_empty() && state.edits.draft.as_ref().is_none() {
        return Until::Now(Value::Null);
    }
    draft(state, engine, edits);
    Until::Reloaded
}

/// Writes the numbers that are shown.
fn write_shown(state: &mut State, engine: &mut Engine) -> Outcome {
    let edits = state.edits.draft.as_ref().map(|draft| draft.edits.clone());
    write_listed(state, engine, edits.ok_or("no other numbers are shown")?)
}
