//! The panel Shaders: the last reload and the time of each step. Its height is constant, so that an error does not move the
//! panels below.

use std::path::PathBuf;

use egui::{Label, RichText, Ui};

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
    ui.horizontal(|ui| {
        let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        match (status.compiling, errors) {
            // No spinner: on a software device its frames would slow the compilation down.
            (true, _) => ui.label("Compiling…"),
            (_, 0) if generation == 0 => ui.label("No shaders yet"),
            (_, 0) => ui.label(format!("Generation {generation}")),
            (_, errors) if cut_short => ui.colored_label(ERROR, plural(errors, "error")),
            (_, errors) => ui.colored_label(ERROR, format!("{}; showing the last good", plural(errors, "error"))),
        };
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("Reload").on_hover_text("Compile everything again (F5)").clicked() {
                commands.push(Command::Reload);
            }
        });
    });
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

/// The folder to edit, which opens in the editor.
fn tree(ui: &mut Ui, status: &ShaderStatus, commands: &mut Vec<Command>) {
    let folder = PathBuf::from(&status.tree);
    let text = RichText::new(&status.tree).small();
    if !folder.exists() {
        ui.add(Label::new(text.color(QUIET)).truncate()).on_hover_text(&status.tree);
        return;
    }
    let label = ui.add(Label::new(text.color(ACCENT)).truncate().sense(egui::Sense::click()));
    if label.clicked() {
        commands.push(Command::Edit(Place { file: folder, line: None, column: None }));
    }
    let hint = format!("{}\nSave a file here and the picture follows. Click to open in the editor", status.tree);
    label.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text(hint);
}

/// Three texts: the changed files with the compiled stages, the time of each step, and a hover text with the details.
pub(super) fn lines(last: &ReloadEvent) -> (String, String, String) {
    let name = |path: &String| path.rsplit('/').next().unwrap_or(path).to_owned();
    let changed =
        if last.changed.is_empty() { vec!["start".to_owned()] } else { last.changed.iter().map(name).collect() };
    let stages = if last.stages.is_empty() { "nothing to do".to_owned() } else { last.stages.join(" ") };
    let edit = format!("{} -> {}", changed.join(" "), in_short(&last.stages));
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
