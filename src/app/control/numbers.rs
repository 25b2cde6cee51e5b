//! The command `numbers`: other numbers in a line of the shaders, shown without a change of the file, or written to it.

use serde_json::{Value, json};

use super::{Next, Until};
use crate::app::command::Command;
use crate::app::engine::Engine;
use crate::app::execute::execute;
use crate::app::source_line::SourceLine;
use crate::app::state::State;
use crate::app::state::shaders::edits::NO_FOLDER;
use crate::control::Numbers;
use crate::shader::rewrite::Edit;

/// Lists the numbers of a line, shows others in their place, writes these, or goes back to the file.
pub(in crate::app) fn numbers_as(state: &mut State, engine: &mut Engine, request: Numbers) -> Result<Next, String> {
    let Some(at) = &request.at else {
        return if request.write { write_numbers(state, engine) } else { Ok(show_numbers(state, engine, Vec::new())) };
    };
    let shaders = state.session.shaders.clone().ok_or("the shaders have not been compiled yet")?;
    // Numbers that are shown already are not those of the file.
    let base = state.edits.draft.as_ref().map(|draft| (draft.path.clone(), draft.base.clone()));
    let line = SourceLine::place(&shaders, at).and_then(|(path, text, line)| {
        let text = base.as_ref().filter(|(of, _)| of == path).map_or(text, |(_, base)| base);
        SourceLine::new(path, line, text)
    });
    let mut line = line.ok_or_else(|| format!("the shaders have no line {at}; expected FILE:LINE"))?;
    let Some(values) = request.values else {
        let numbers = line.numbers.iter().map(|(literal, value)| json!({ "text": literal.text, "value": value }));
        return Ok(Next::Done(json!({ "line": line.before.trim(), "numbers": numbers.collect::<Vec<_>>() })));
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
        return write_edits_of(state, engine, edits);
    }
    Ok(show_numbers(state, engine, edits))
}

/// Shows the picture with edits, or with the file.
fn show_numbers(state: &mut State, engine: &mut Engine, edits: Vec<Edit>) -> Next {
    if edits.is_empty() && state.edits.draft.as_ref().is_none() {
        return Next::Done(Value::Null);
    }
    execute(state, engine, Command::Draft(edits));
    Next::Wait(Until::Reloaded)
}

/// Writes the numbers that are shown.
fn write_numbers(state: &mut State, engine: &mut Engine) -> Result<Next, String> {
    let edits = state.edits.draft.as_ref().map(|draft| draft.edits.clone());
    write_edits_of(state, engine, edits.ok_or("no other numbers are shown")?)
}

/// Writes edits into the files. The answer lists them.
pub(in crate::app) fn write_edits_of(state: &mut State, engine: &mut Engine, edits: Vec<Edit>) -> Result<Next, String> {
    if !state.has_folder() {
        return Err(NO_FOLDER.into());
    }
    let told = edits.iter().map(|edit| json!({ "name": edit.name, "file": edit.path, "line": edit.line }));
    let told = told.collect();
    execute(state, engine, Command::WriteEdits(edits));
    Ok(Next::Wait(Until::EditsWritten(told)))
}
