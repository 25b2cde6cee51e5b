//! The first statement that makes NaN or infinity at the pixel. A click opens its line in the editor.

use std::path::PathBuf;

use egui::{CursorIcon, RichText, Sense, Ui};

use crate::app::command::file::OPEN_EDITOR;
use crate::app::command::spec::Command;
use crate::app::editor::Place;
use crate::app::state::inspection::NotFiniteSearch;
use crate::app::widgets::rows::elided;
use crate::app::widgets::theme::{ACCENT, ERROR, QUIET};
use crate::shader::not_finite::ELSEWHERE;
use crate::shader::{FirstNotFinite, Site};

/// Shows the search or its result. `has_files`: the tree is on disk, so an editor can open it.
pub(super) fn show(ui: &mut Ui, search: &NotFiniteSearch, has_files: bool, commands: &mut Vec<Command>) {
    let mode = &search.mode;
    let quiet = |ui: &mut Ui, text: String| drop(ui.label(RichText::new(text).small().color(QUIET)));
    match search.found.as_ref().map(|found| &found.found) {
        None => {
            ui.horizontal(|ui| {
                ui.spinner();
                quiet(ui, format!("Looking for the first line with NaN or Inf in {mode}…"));
            });
        }
        Some(Ok(Some(found @ FirstNotFinite { first, value, nan, .. }))) => {
            line(ui, first, (value, &found.components()), mode, has_files, commands);
            if let Some(nan) = nan {
                line(ui, nan, ("NaN", ""), mode, has_files, commands);
            }
        }
        Some(Ok(None)) => quiet(ui, format!("NaN or Inf in {mode}: {ELSEWHERE}")),
        Some(Err(message)) => quiet(ui, format!("NaN or Inf in {mode}: {message}")),
    }
}

/// The last folder and the name of a file.
fn short(file: &str) -> &str {
    file.rmatch_indices('/').nth(1).map_or(file, |(at, _)| &file[at + 1..])
}

fn line(
    ui: &mut Ui,
    site: &Site,
    (value, components): (&str, &str),
    mode: &str,
    has_files: bool,
    commands: &mut Vec<Command>,
) {
    let Site { file, line, column, code } = site;
    let text = RichText::new(format!("{value}  {}:{line}  {code}", short(file))).small().color(ERROR);
    let label = ui.add(elided(text).sense(Sense::click()));
    if label.clicked() {
        match has_files {
            true => {
                let (line, column) = (Some(*line), Some(*column));
                commands.push(OPEN_EDITOR.with(Place { file: PathBuf::from(file), line, column }));
            }
            false => ui.ctx().copy_text(format!("{file}:{line}:{column}: {code}")),
        }
    }
    let hint = if has_files { "Click to open it in the editor" } else { "Click to copy it" };
    label.on_hover_cursor(CursorIcon::PointingHand).on_hover_ui(|ui| {
        ui.set_max_width(480.0);
        ui.label(RichText::new(format!("{file}:{line}")).strong());
        ui.label(RichText::new(code).monospace());
        ui.label(format!(
            "The first statement in {mode} that produces {value}{components} at this pixel, in the order of execution"
        ));
        ui.label(RichText::new(hint).small().color(ACCENT));
    });
}
