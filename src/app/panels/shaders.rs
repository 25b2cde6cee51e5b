//! The panel Shaders: the last reload and the time of each step. Its height is constant, so that an error does not move the
//! panels below.

use egui::{Align, Label, Layout, RichText, Ui};

use super::{ACCENT, ERROR, QUIET, plural};
use crate::app::command::Command;
use crate::app::editor::Place;
use crate::app::status::ShaderStatus;
use crate::events::{ReloadEvent, in_short};
use crate::shader::{Diagnostic, Severity};

/// Shows the panel. `generation` is 0 before the first shaders. `cut_short`: a loop of the picture did not end.
pub(super) fn show(
    ui: &mut Ui,
    status: &ShaderStatus,
    generation: u64,
    diagnostics: &[Diagnostic],
    cut_short: bool,
    commands: &mut Vec<Command>,
) {
    let bar = |ui: &mut Ui| {
        // The button first, so that a long text in a narrow column is elided beside it.
        if ui.button("Reload").on_hover_text("Compile everything again (F5)").clicked() {
            commands.push(Command::Reload);
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
            let (text, hover) = state(status, generation, errors, cut_short);
            let text = if errors > 0 && !status.compiling { text.color(ERROR) } else { text };
            ui.add(Label::new(text).truncate()).on_hover_text(hover);
        });
    };
    ui.horizontal(|ui| ui.with_layout(Layout::right_to_left(Align::Center), bar));
    tree(ui, status, commands);
    let (edit, times, hover) = status.last.as_ref().map(lines).unwrap_or_default();
    for line in [edit, times] {
        // A space keeps the height of an empty line.
        let text = if line.is_empty() { " ".to_owned() } else { line };
        let response = ui.add(Label::new(RichText::new(text).monospace().small()).truncate());
        if !hover.is_empty() {
            response.on_hover_text(&hover);
        }
    }
}

/// The state of the shaders in a few words, and in a sentence.
fn state(status: &ShaderStatus, generation: u64, errors: usize, cut_short: bool) -> (RichText, &'static str) {
    // No spinner: on a software device its frames would slow the compilation down.
    match (status.compiling, errors) {
        (true, _) => ("Compiling…".into(), "The picture stays until the new shaders are ready"),
        (_, 0) if generation == 0 => ("No shaders yet".into(), "The first shaders have not compiled yet"),
        (_, 0) => {
            (format!("Generation {generation}").into(), "Number of the shaders on screen: 1 is that of the start")
        }
        (_, errors) if cut_short => (plural(errors, "error").into(), "A loop did not end"),
        (_, errors) => (plural(errors, "error").into(), "The picture is that of the last good shaders"),
    }
}

/// The folder or file to edit, which opens in the editor.
fn tree(ui: &mut Ui, status: &ShaderStatus, commands: &mut Vec<Command>) {
    let text = RichText::new(&status.tree).small();
    let Some(folder) = &status.location else {
        ui.add(Label::new(text.color(QUIET)).truncate()).on_hover_text(&status.tree);
        return;
    };
    let label = ui.add(Label::new(text.color(ACCENT)).truncate().sense(egui::Sense::click()));
    if label.clicked() {
        commands.push(Command::Edit(Place { file: folder.clone(), line: None, column: None }));
    }
    let hint = format!("{}\nSave a file here, and the picture follows. Click to open it in the editor", status.tree);
    label.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text(hint);
}

/// Three texts: the changed files with the compiled stages, the time of each step, and a hover text with the details.
pub(super) fn lines(last: &ReloadEvent) -> (String, String, String) {
    let name = |path: &String| path.rsplit('/').next().unwrap_or(path).to_owned();
    let changed =
        if last.changed.is_empty() { vec!["start".to_owned()] } else { last.changed.iter().map(name).collect() };
    let stages = if last.stages.is_empty() { "nothing to do".to_owned() } else { last.stages.join(" ") };
    // A save that repairs a failed one compiles nothing if the text is the last good one again.
    let edit = match last.changed.is_empty() && last.stages.is_empty() {
        true => "repaired: the last good text again".to_owned(),
        false => format!("{} -> {}", changed.join(" "), in_short(&last.stages)),
    };
    let times = match last.ok {
        true => format!(
            "{:.0} ms compile + {:.0} ms pipeline + {:.0} ms frame",
            last.compile_ms, last.pipeline_ms, last.first_frame_ms
        ),
        false => format!("failed after {:.0} ms", last.compile_ms),
    };
    let hover = format!(
        "{}\n-> {stages}\n{times}\nSeen {:.1} ms after the first file event. The frame is the first with the new shaders.",
        if last.changed.is_empty() { "start".to_owned() } else { last.changed.join("\n") },
        last.detect_ms
    );
    (edit, times, hover)
}
