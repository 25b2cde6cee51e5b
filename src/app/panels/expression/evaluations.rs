//! The evaluations of a watched expression at the pinned pixel.

use egui::{Button, Label, RichText, ScrollArea, Ui};

use crate::app::command::source::SHOW_FILE;
use crate::app::command::spec::Command;
use crate::app::source_line::SourceLine;
use crate::app::state::State;
use crate::app::state::trace::choice::evaluations;
use crate::app::widgets::theme::{QUIET, small_mono};
use crate::settings::Settings;
use crate::shader::trace::Event;

/// Height of the list, and of a row of it, points.
const HEIGHT: f32 = 130.0;
const ROW: f32 = 18.0;
/// Between two calls of a path.
const CALL: &str = " > ";

/// Lists the evaluations of the watched expression at the pinned pixel, with their values and calls. A click chooses one.
pub(super) fn show(
    ui: &mut Ui,
    state: &State,
    settings: &mut Settings,
    (shown, name): (&SourceLine, &str),
    commands: &mut Vec<Command>,
) {
    let told = |ui: &mut Ui, text: &str| drop(ui.add(Label::new(RichText::new(text).small().color(QUIET)).wrap()));
    if state.inspection.pin.is_none() {
        return told(ui, "Click a pixel of the picture to list the evaluations there");
    }
    let Some(newest) = state.traces.newest().filter(|newest| newest.file == shown.path) else {
        // The panel Source has another file traced.
        if state.workspace.sight.source && ui.small_button("List the evaluations at the pinned pixel").clicked() {
            commands.push(SHOW_FILE.with(shown.path.clone()));
        }
        return;
    };
    let (trace, fragment) = match (&newest.trace, state.traces.fragment()) {
        (Ok(trace), Some(fragment)) => (trace, fragment),
        (Err(message), _) => return told(ui, message),
        (Ok(_), None) => return,
    };
    let found = evaluations(trace, fragment, (shown.path.as_str(), shown.line), name);
    if found.is_empty() {
        return told(ui, "No evaluation at the pinned pixel stores or returns it");
    }
    let shared = shared_calls(&found);
    let chosen = match settings.expression.evaluation {
        0 => found.last().map_or(0, |(last, _)| *last),
        number => number,
    };
    ScrollArea::vertical().id_salt("evaluations").max_height(HEIGHT).show_rows(ui, ROW, found.len(), |ui, rows| {
        for index in rows {
            let (number, Event { value, calls, .. }) = found[index];
            let value = value.map(|value| value.text()).unwrap_or_default();
            let own: Vec<&str> = calls.split(CALL).skip(shared).collect();
            let text = small_mono(format!("{number:>3}  {value}  {}", own.join(CALL)));
            let row = ui.add(Button::selectable(number == chosen, text).truncate());
            if row.on_hover_text(format!("Show evaluation {number} of {name} in each pixel: {calls}")).clicked() {
                settings.expression.evaluation = number;
            }
        }
    });
}

/// How many calls all evaluations have in common, from the outermost. A single one has its own.
fn shared_calls(found: &[(u32, &Event)]) -> usize {
    let Some(((_, first), others)) = found.split_first() else { return 0 };
    let alike = |(_, other): &(u32, &Event)| {
        first.calls.split(CALL).zip(other.calls.split(CALL)).take_while(|(a, b)| a == b).count()
    };
    others.iter().map(alike).min().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use crate::app::state::trace::sample;
    use crate::shader::trace::Act;
    use crate::shader::trace::sample::called;
    use crate::shader::{ShaderSet, Source, TreePath};

    #[test]
    fn a_click_chooses_an_evaluation_at_the_pinned_pixel() {
        let texts = BTreeMap::from([(TreePath::from("a.glsl"), Arc::<str>::from("float a = 2.0 * x;\n"))]);
        let shaders = Arc::new(ShaderSet { texts, ..ShaderSet::default() });
        let text = &shaders.texts[&TreePath::from("a.glsl")];
        let line = SourceLine::new(&shaders, &"a.glsl".into(), 1, text).unwrap();
        let show_list = move |ui: &mut Ui, state: &mut State| {
            let (mut settings, mut asked) = (state.session.settings.clone(), Vec::new());
            show(ui, state, &mut settings, (&line, "a"), &mut asked);
            state.session.settings = settings;
            assert!(asked.is_empty());
        };
        let state = State::new(Settings::of_window(), Source::embedded());
        let mut harness = Harness::new_ui_state(show_list, state);
        harness.run();
        harness.get_by_label_contains("Click a pixel of the picture");
        let state = harness.state_mut();
        state.inspection.pin = Some([3, 4]);
        let events = [("main > f", 2.0), ("main > f [2]", 4.0), ("main > f [3] > g", 8.0)];
        let events = events.map(|(calls, value)| called(calls, 1, Act::Store, "a", &[value])).to_vec();
        sample::add(&mut state.traces, &shaders, 1, events, &[1]);
        harness.run();
        harness.get_by_label_contains("3  8  f [3] > g");
        harness.get_by_label_contains("2  4  f [2]").click();
        harness.run();
        assert_eq!(harness.state().session.settings.expression.evaluation, 2);
    }
}
