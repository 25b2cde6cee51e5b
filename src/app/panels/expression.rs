//! The panel Expression: shows the value of an expression of the shaders over the model, and offers the numbers of its line as
//! sliders.

mod evaluations;

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Button, DragValue, Key, Label, RichText, ScrollArea, TextEdit, Ui, vec2};

use crate::app::command::shaders::DRAFT;
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::draft::show_draft;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::source_line::{SourceLine, stop, watch};
use crate::app::state::State;
use crate::app::state::shaders::difference::{Kind, Line};
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::rows::elided;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{ACCENT, ERROR, QUIET, small_mono};
use crate::settings::Settings;
use crate::shader::Expression;
use crate::shader::expression::{MODE, Variable};
use crate::shader::rewrite::Edit;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Expression", Group::Shaders, "watch variable numbers of a line sliders", || {
        Box::<ExpressionState>::default()
    });

/// Height of a menu of members, points.
const MENU: f32 = 320.0;

/// Most edited lines that the panel offers.
const MOST_LINES: usize = 8;

/// State of the panel between frames.
#[derive(Default)]
pub(in crate::app) struct ExpressionState {
    /// The text of the field.
    field: String,
    /// The setting that the field was last set to.
    known: String,
    /// Why the text of the field cannot be watched.
    error: Option<String>,
    takes_focus: bool,
    /// The line of the field.
    shown: Option<SourceLine>,
}

impl ExpressionState {
    /// Shows a line, with what it offers.
    fn show_line(&mut self, file: &str, line: u32) {
        (self.field, self.error) = (format!("{file}:{line}:"), None);
    }
}

impl PanelUi for ExpressionState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        show(ui, context.state, self, commands);
    }

    fn on_request(&mut self, request: &PanelRequest) {
        self.takes_focus |= *request == PanelRequest::FocusExpression;
    }
}

/// Shows the panel.
fn show(ui: &mut Ui, state: &State, own: &mut ExpressionState, commands: &mut Commands) {
    let Commands { settings, list, sight, .. } = commands;
    if own.known != settings.expression.at {
        own.known.clone_from(&settings.expression.at);
        own.field.clone_from(&settings.expression.at);
        own.error = None;
    }
    field(ui, settings, own);
    let unparsed = own.error.as_deref();
    // The error of an expression that is no longer watched is not told.
    let shaders =
        state.session.shaders.as_ref().filter(|_| !own.field.is_empty() && own.field == settings.expression.at);
    let compiled = shaders.and_then(|shaders| shaders.expression_error()).map(|error| error.message.as_str());
    if let Some(error) = unparsed.or(compiled) {
        ui.add(Label::new(RichText::new(error).small().color(ERROR)).wrap());
    }
    find_line(state, own);
    match own.shown.take() {
        Some(mut shown) => {
            line(ui, &mut shown, own);
            if let Some(name) = offered(ui, settings, &shown, own) {
                sight.evaluations = Some(shown.path.clone());
                evaluations::show(ui, state, settings, (&shown, &name), list);
            }
            numbers(ui, state, &mut shown, list);
            own.shown = Some(shown);
        }
        None => suggestions(ui, state, own),
    }
}

/// The field for the expression, and the buttons beside it.
fn field(ui: &mut Ui, settings: &mut Settings, own: &mut ExpressionState) {
    let is_on = !settings.expression.at.is_empty();
    ui.horizontal(|ui| {
        let room = ui.available_width() - 62.0;
        let edit = TextEdit::singleline(&mut own.field).desired_width(room).font(egui::TextStyle::Monospace);
        let edit = named(ui.add(edit.hint_text("brdf/ndf.glsl:20 a2")), "Expression");
        if std::mem::take(&mut own.takes_focus) {
            edit.request_focus();
        }
        let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        edit.on_hover_text(
            "FILE:LINE and a variable or an expression of the shaders. Enter shows its value over the model, as a mode. \
             `return` is the value that the line returns",
        );
        let is_empty = own.field.trim().is_empty();
        let ends = is_on && (is_empty || (settings.mode == MODE && own.field == settings.expression.at));
        let (name, hint) = match ends {
            true => ("Stop", "Watch it no longer, and go back to the picture"),
            false => ("Watch", "Show the value over the picture (Enter)"),
        };
        let clicked = ui.add_sized(vec2(52.0, 20.0), Button::new(name)).on_hover_text(hint).clicked();
        if ends && (clicked || (entered && is_empty)) {
            stop(settings);
        } else if clicked || entered {
            match Expression::parse(&own.field, 0) {
                Ok(expression) => {
                    own.error = None;
                    watch(settings, expression.to_string());
                }
                Err(message) => own.error = (!is_empty).then_some(message),
            }
        }
    });
}

/// Finds the line that the field names.
fn find_line(state: &State, own: &mut ExpressionState) {
    let Some(shaders) = &state.session.shaders else { return };
    let found = SourceLine::place(shaders, &own.field);
    let Some((path, text, line)) = found else {
        own.shown = None;
        return;
    };
    let is_dragged = state.edits.draft.as_ref().is_some();
    let is_same = own.shown.as_ref().is_some_and(|shown| {
        (&shown.path, shown.line) == (path, line)
            && (is_dragged || Arc::ptr_eq(&shown.text, text) || shown.text == *text)
    });
    if !is_same {
        own.shown = SourceLine::new(shaders, path, line, text);
    }
}

/// The line itself, with its number to step through the file.
fn line(ui: &mut Ui, shown: &mut SourceLine, own: &mut ExpressionState) {
    ui.horizontal(|ui| {
        ui.add(Label::new(RichText::new(shown.path.as_str()).small().color(QUIET)).truncate());
        let mut number = shown.line;
        let last = u32::try_from(shown.text.lines().count()).unwrap_or(u32::MAX);
        let drag = ui.add(DragValue::new(&mut number).range(1..=last.max(1)).speed(0.2).prefix("line "));
        if drag
            .on_hover_text("The line whose variables and numbers are listed below. Drag to step through the file")
            .changed()
        {
            own.show_line(shown.path.as_str(), number);
        }
    });
    let text = small_mono(shown.before.trim());
    ui.add(elided(text)).on_hover_text(shown.before.trim());
}

/// The variables that the line offers, and which evaluation counts. Returns the watched expression, if it is one of this line.
fn offered(ui: &mut Ui, settings: &mut Settings, shown: &SourceLine, own: &mut ExpressionState) -> Option<String> {
    let watched = Expression::parse(&settings.expression.at, 0).ok();
    let watched =
        watched.filter(|watched| watched.line == shown.line && settings.mode == MODE).map(|watched| watched.text);
    let Some(variables) = &shown.variables else {
        let text = "Values of this file cannot be shown: no vertex or fragment stage of the model or of a pass that covers its image includes it.";
        ui.label(RichText::new(text).small().color(QUIET));
        return None;
    };
    let returns = shown.before.trim_start().starts_with("return");
    let mut chosen: Option<&str> = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        if returns {
            let button =
                ui.selectable_label(watched.as_deref() == Some("return"), RichText::new("returned value").small());
            if button.on_hover_text("The value that the line returns: click to see it over the picture").clicked() {
                chosen = Some("return");
            }
        }
        let struct_of = |variable: &Variable| variable.name.split_once('.').map(|(of, _)| of.to_owned());
        for variables in variables.chunk_by(|a, b| struct_of(a).is_some() && struct_of(a) == struct_of(b)) {
            let mut offer = |ui: &mut Ui| {
                for Variable { name, kind } in variables {
                    let button = ui.selectable_label(watched.as_ref() == Some(name), small_mono(name));
                    let hint = format!("{kind} {name}: click to see its value over the picture");
                    if button.on_hover_text(hint).clicked() {
                        chosen = Some(name);
                    }
                }
            };
            match variables.first().and_then(struct_of) {
                None => offer(ui),
                Some(of) => {
                    let list = |ui: &mut Ui| ScrollArea::vertical().max_height(MENU).show(ui, &mut offer);
                    ui.menu_button(small_mono(format!("{of}.")), list).response.on_hover_text("Its members");
                }
            }
        }
    });
    if let Some(name) = chosen {
        own.error = None;
        watch(settings, format!("{}:{}:{name}", shown.path, shown.line));
    }
    ui.add_enabled_ui(watched.is_some(), |ui| {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Evaluation").small());
            let value = &mut settings.expression.evaluation;
            let text = |number: f64, _: std::ops::RangeInclusive<usize>| match number {
                0.0 => "last".to_owned(),
                number => format!("{number:.0}"),
            };
            let parse = |text: &str| if text.trim() == "last" { Some(0.0) } else { text.trim().parse().ok() };
            let drag = DragValue::new(value).range(0..=100_000).speed(0.05).custom_formatter(text).custom_parser(parse);
            let hint = "Which evaluation of the line is shown where it runs more than once in a pixel: in a loop, or for each \
                light. Only evaluations that reach the line count, so the second is not that of light 2 where light 1 is left out \
                before; `lights.chosen` selects one light";
            ui.add(drag).on_hover_text(hint).on_disabled_hover_text(hint);
        });
    });
    watched
}

/// The numbers of the line as sliders.
fn numbers(ui: &mut Ui, state: &State, shown: &mut SourceLine, commands: &mut Vec<Command>) {
    let draft = state.edits.draft.as_ref();
    let is_here = |edit: &Edit| edit.path == shown.path && edit.line == shown.line;
    let is_own = draft.is_some_and(|draft| draft.edits.first().is_some_and(is_here));
    if !shown.numbers.is_empty() {
        let mut changed = false;
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new("Numbers").small().color(QUIET));
            for (literal, value) in &mut shown.numbers {
                let speed = if literal.is_whole { 0.05 } else { 0.005 * literal.value.abs().max(0.1) };
                let drag = DragValue::new(value).speed(speed).max_decimals(5);
                let drag =
                    if literal.is_whole { drag.range(0.0..=f64::from(u32::MAX)).fixed_decimals(0) } else { drag };
                let hint = format!(
                    "{} in the file. Drag to see the picture with another number; Write saves it",
                    literal.text
                );
                let drag = ui.add_enabled(draft.is_none() || is_own, drag).on_hover_text(hint);
                changed |= drag.on_disabled_hover_text("Write or cancel the numbers of the other line first").changed();
            }
        });
        if changed {
            // The compiler gets an f32 or an integer, so integers are rounded.
            for (literal, value) in &mut shown.numbers {
                *value = if literal.is_whole { value.round() } else { *value };
            }
            commands.push(DRAFT.with(shown.edits()));
        }
    }
    let Some(draft) = draft else { return };
    let cancels = ui.horizontal(|ui| show_draft(ui, state, draft, !is_own, commands)).inner;
    if cancels {
        for (literal, value) in &mut shown.numbers {
            *value = literal.value;
        }
    }
}

/// Lines to begin with: those with errors, and those of the last edit.
fn suggestions(ui: &mut Ui, state: &State, own: &mut ExpressionState) {
    let newest = state.versions.iter().next_back();
    let edited = newest.map(|version| edited_lines(state.versions.difference(version))).unwrap_or_default();
    let text = match edited.is_empty() {
        true => "Type a file and a line to see its variables and numbers.",
        false => "Lines of the last edit:",
    };
    ui.label(RichText::new(text).small().color(QUIET));
    ui.horizontal_wrapped(|ui| {
        for (path, line) in edited {
            let name = path.rsplit('/').next().unwrap_or(&path);
            let text = small_mono(format!("{name}:{line}")).color(ACCENT);
            if ui
                .add(Button::new(text).frame(false))
                .on_hover_text(format!("Show the variables and numbers of {path}:{line}"))
                .clicked()
            {
                own.show_line(&path, line);
            }
        }
    });
}

/// Whether a line may have something to watch: no directive, comment or declaration.
fn has_expression(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default().trim();
    !code.starts_with('#') && (code.contains('=') || code.contains("return") || code.ends_with(");"))
}

/// The first lines with expressions that a difference adds, by file.
fn edited_lines(difference: &[Line]) -> Vec<(String, u32)> {
    let mut out: BTreeMap<(String, u32), ()> = BTreeMap::new();
    let (mut file, mut line) = (String::new(), 1);
    for Line { kind, text } in difference {
        match kind {
            Kind::Place => match text.strip_prefix("@@ line ").and_then(|number| number.parse().ok()) {
                Some(number) => line = number,
                None => file.clone_from(text),
            },
            Kind::Removed => {}
            Kind::Same => line += 1,
            Kind::Added => {
                if has_expression(&text[1..]) {
                    out.insert((file.clone(), line), ());
                }
                line += 1;
            }
        }
    }
    out.into_keys().take(MOST_LINES).collect()
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use crate::app::state::shaders::difference::difference;
    use crate::shader::{Diagnostic, ShaderSet, Source, TreePath, Watching};

    /// The panel over a window that watches an expression which does not compile.
    fn panel() -> Harness<'static, (State, ExpressionState)> {
        let mut state = State::new(Settings::of_window(), Source::embedded());
        watch(&mut state.session.settings, "a.glsl:1:x".to_owned());
        let error = Some(Diagnostic::error("a.glsl", "cannot watch `x` here: 'x' : undeclared identifier"));
        let expression = Expression::parse("a.glsl:1:x", 0).unwrap();
        let watched = Some(Watching { expression, line: 1, error });
        state.session.shaders = Some(Arc::new(ShaderSet { watched, ..ShaderSet::default() }));
        let show_panel = |ui: &mut Ui, (state, own): &mut (State, ExpressionState)| {
            let mut commands = Commands::new(&state.session.settings);
            show(ui, state, own, &mut commands);
            state.session.settings = commands.settings;
        };
        let mut harness = Harness::new_ui_state(show_panel, (state, ExpressionState::default()));
        harness.run();
        harness
    }

    #[test]
    fn an_expression_that_does_not_compile_is_told_here_alone_until_it_is_stopped() {
        let mut harness = panel();
        harness.get_by_label_contains("cannot watch `x` here");
        assert!(!harness.state().0.has_errors(), "it counts as an error of the tree");
        assert!(harness.state().0.shown_expression_error().is_some());
        harness.state_mut().0.session.settings.mode = "final".to_owned();
        assert!(harness.state().0.shown_expression_error().is_none(), "the error is over another mode");
        watch(&mut harness.state_mut().0.session.settings, "a.glsl:1:x".to_owned());
        harness.run();
        harness.get_by_role_and_label(Role::Button, "Stop").click();
        harness.run();
        let settings = &harness.state().0.session.settings;
        assert_eq!((settings.expression.at.as_str(), settings.mode.as_str()), ("", "final"));
        assert!(harness.query_by_label_contains("cannot watch").is_none());
    }

    #[test]
    fn an_emptied_field_stops_too() {
        let mut harness = panel();
        harness.state_mut().0.session.settings.mode = "final".to_owned();
        harness.state_mut().1.field.clear();
        harness.run();
        harness.get_by_role_and_label(Role::Button, "Stop").click();
        harness.run();
        assert_eq!(harness.state().0.session.settings.expression.at, "");
    }

    #[test]
    fn the_lines_of_an_edit_are_offered() {
        let tree = |text: &str| BTreeMap::from([(TreePath::from("brdf/a.glsl"), Arc::<str>::from(text))]);
        let lines = difference(
            &tree("a;\nb = 1;\nc;\nd;\n"),
            &tree("a;\nb = 2;\nc;\n}\nd;\nreturn e;\n#include \"f\"\n// g = 1\nuniform float h;\n"),
        );
        assert_eq!(edited_lines(&lines), [("brdf/a.glsl".to_owned(), 2), ("brdf/a.glsl".to_owned(), 6)]);
    }
}
