//! All values of a statement, with their type, their unit or space, their bits and the calls that led to them.

use egui::{Grid, RichText, Ui};

use super::declared::{Declared, declared};
use super::model::CodeLine;
use super::{bar, neighborhood};
use crate::app::state::State;
use crate::app::state::trace::rows::Note;
use crate::app::widgets::plural;
use crate::app::widgets::theme::{ACCENT, CODE_COMMENT, ERROR, QUIET, small_mono};
use crate::shader::TreePath;
use crate::shader::trace::{Act, Once, light_of};

/// Values that are listed.
const MOST: usize = 12;

/// Shows the hover text of a value.
pub(super) fn show(
    ui: &mut Ui,
    state: &State,
    (path, line): (&TreePath, &CodeLine),
    note: &Note,
    expression: Option<&str>,
) {
    ui.set_max_width(520.0);
    let done = &note.done;
    let kind = done.values().next().map(|value| value.type_name()).unwrap_or_default();
    let declared = declaration(state, (path, line), note);
    let what = match done.act {
        Act::Argument => format!("{kind} {}, an argument", done.name),
        Act::Store => format!("{kind} {}", done.name),
        Act::Condition => "A condition".to_owned(),
        Act::Return => format!("{kind}, returned"),
        Act::Discard => "Discards the fragment".to_owned(),
        Act::Leave => "Returns without a value".to_owned(),
    };
    ui.horizontal(|ui| {
        ui.label(RichText::new(what).strong());
        if let Some(unit) = declared.as_ref().and_then(|declared| declared.unit.as_ref()) {
            ui.label(unit);
        }
        ui.label(RichText::new(format!("{path}:{}", line.row.line)).small().color(QUIET));
    });
    if let Some(declared) = &declared {
        show_declaration(ui, declared);
    }
    if let Some(before) = &note.before {
        ui.label(small_mono(format!("before the last edit: {before}")).color(ACCENT));
    }
    if note.is_new {
        ui.label(small_mono("a line of the last edit").color(ACCENT));
    }
    let all: Vec<&Once> = done.first.iter().chain(&done.last).collect();
    Grid::new("values").num_columns(4).spacing([12.0, 1.0]).show(ui, |ui| {
        for once in all.iter().take(MOST) {
            let text = once.value.map(|value| value.text()).unwrap_or_default();
            let is_bad = once.value.is_some_and(|value| !value.is_finite());
            let value = small_mono(text);
            ui.label(small_mono(once.time.to_string()).color(QUIET));
            ui.label(if is_bad { value.color(ERROR) } else { value });
            ui.label(small_mono(once.value.map(|value| value.float_bits()).unwrap_or_default()).color(QUIET));
            ui.label(RichText::new(calls_text(state, &once.calls)).small().color(QUIET));
            ui.end_row();
        }
    });
    let more = done.count.saturating_sub(all.len().min(MOST));
    if more > 0 {
        ui.label(RichText::new(format!("and {more} more of {}", plural(done.count, "time"))).small().color(QUIET));
    }
    if bar::value(note).is_some() {
        neighborhood::show(ui, state, line, note);
        ui.label(RichText::new(bar::LEGEND).small().color(QUIET));
    }
    if expression.is_some() {
        ui.label(RichText::new("Click to see it over the whole model").small().color(ACCENT));
    }
}

/// The declaration of the value, in the text that was traced.
fn declaration(state: &State, (path, line): (&TreePath, &CodeLine), note: &Note) -> Option<Declared> {
    let newest = state.traces.newest()?;
    declared(&newest.of.picture.shaders, (path, line.row.traced?), note.done.act, &note.done.name)
}

/// Shows what the author wrote about the value. A declaration without a comment says no more than the line itself.
fn show_declaration(ui: &mut Ui, declared: &Declared) {
    let Some(comment) = &declared.comment else { return };
    ui.label(RichText::new(comment).color(CODE_COMMENT));
    let place = format!("{}   {}:{}", declared.code, declared.file, declared.line);
    ui.label(small_mono(place).color(QUIET));
}

/// The calls that led to a value, with the light that they are about.
fn calls_text(state: &State, calls: &str) -> String {
    let trace = state.traces.newest().and_then(|newest| newest.trace.as_ref().ok());
    let number = light_of(calls).and_then(|number| number.checked_sub(1));
    match trace.zip(number).and_then(|(trace, number)| trace.lights.get(number)) {
        Some(light) => format!("{calls}   {}", light.text()),
        None => calls.to_owned(),
    }
}
