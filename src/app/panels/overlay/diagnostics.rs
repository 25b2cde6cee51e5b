//! The card with diagnostics and their source lines.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use egui::scroll_area::ScrollBarVisibility;
use egui::{Align2, Id, Rect, RichText, ScrollArea, Ui};

use super::card::{area, card};
use crate::app::command::file::OPEN_EDITOR;
use crate::app::command::spec::Command;
use crate::app::editor::Place;
use crate::app::widgets::plural;
use crate::app::widgets::theme::{ERROR, QUIET, STRONG, TEXT, WARNING};
use crate::shader::{Diagnostic, Severity};

/// Whether the files of the diagnostics exist. The disk is asked once for each file, not in each frame.
#[derive(Default)]
pub(in crate::app::panels) struct Files(BTreeMap<String, bool>);

impl Files {
    /// Asks for the files of new diagnostics, and forgets those of old ones.
    pub(super) fn update(&mut self, diagnostics: &[Diagnostic]) {
        self.0.retain(|file, _| diagnostics.iter().any(|diagnostic| diagnostic.file == *file));
        for Diagnostic { file, .. } in diagnostics {
            if !self.0.contains_key(file) {
                self.0.insert(file.clone(), Path::new(file).is_file());
            }
        }
    }

    pub(super) fn is_file(&self, file: &str) -> bool {
        self.0.get(file).copied().unwrap_or_default()
    }
}

/// Contents of the card.
pub(super) struct Shown<'a> {
    pub(super) diagnostics: &'a [Diagnostic],
    /// Whether one of them is about a loop that did not end.
    pub(super) cut_short: bool,
    pub(super) picture: Rect,
}

/// Largest part of the picture's height that the list takes, so that the picture stays in sight.
const PART: f32 = 0.45;

/// Shows the card. Returns its rectangle, and whether the user hides it.
pub(super) fn show(
    egui: &egui::Context,
    shown: &Shown<'_>,
    files: &mut Files,
    commands: &mut Vec<Command>,
) -> (Rect, bool) {
    let Shown { diagnostics, cut_short, picture } = *shown;
    files.update(diagnostics);
    let failed = diagnostics.iter().any(|d| d.severity == Severity::Error);
    let mut hide = false;
    // An area keeps its first size, so other messages or another picture are another area.
    let id = Id::new(("diagnostics", diagnostics, picture.width() as u32, picture.height() as u32));
    let area = area(id, Align2::LEFT_BOTTOM, picture).default_size(picture.size()).fade_in(false);
    let response = area.show(egui, |ui| {
        card(if failed { ERROR } else { WARNING }).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).max(200.0));
            ui.horizontal(|ui| {
                ui.label(RichText::new(counts(diagnostics)).strong());
                let hover = "Hide them until they change. The panel Shaders lists them";
                hide = ui.small_button("Hide").on_hover_text(hover).clicked();
            });
            // The fade has the color of panels, and would lie over the card as a bar.
            ui.spacing_mut().scroll.fade.strength = 0.0;
            // A bar that is in sight tells that there is more.
            ui.spacing_mut().scroll.dormant_handle_opacity = 0.6;
            let fits_id = id.with("fits");
            let fits = ui.data(|data| data.get_temp(fits_id)).unwrap_or(true);
            let bar = if fits { ScrollBarVisibility::AlwaysHidden } else { ScrollBarVisibility::VisibleWhenNeeded };
            let scroll = ScrollArea::vertical().scroll_bar_visibility(bar);
            let shown = scroll.max_height((picture.height() * PART).max(40.0)).show(ui, |ui| {
                for diagnostic in diagnostics {
                    one(ui, diagnostic, files.is_file(&diagnostic.file), commands);
                }
                let picture = match cut_short {
                    true => "Magenta marks where the picture was cut short.",
                    false => "Showing the last version that compiled.",
                };
                if failed {
                    ui.label(RichText::new(picture).small().color(QUIET));
                    ui.add_space(4.0);
                }
            });
            // The room of an area is rounded, and less than a line is no reason to scroll.
            let fits = shown.content_size.y < shown.inner_rect.height() + 8.0;
            ui.data_mut(|data| data.insert_temp(fits_id, fits));
        });
    });
    (response.response.rect, hide)
}

/// A summary such as "3 errors, 1 warning".
fn counts(diagnostics: &[Diagnostic]) -> String {
    let count = |severity: Severity| diagnostics.iter().filter(|d| d.severity == severity).count();
    let parts = [Severity::Error, Severity::Warning].map(|severity| (count(severity), severity));
    let words = parts.iter().filter(|(n, _)| *n > 0).map(|(n, severity)| plural(*n, &severity.to_string()));
    words.collect::<Vec<_>>().join(", ")
}

pub(super) fn one(ui: &mut Ui, diagnostic: &Diagnostic, is_file: bool, commands: &mut Vec<Command>) {
    position(ui, diagnostic, is_file, commands);
    // A monospace character is 7.6 points wide; the number of the line and its bar take up to 8.
    let columns = (ui.available_width() / 7.6) as usize;
    let full = diagnostic.clone().within(columns.saturating_sub(8)).full();
    // Skip the first two lines, message and position, which are shown above. Source lines fit, and notes behind a `=` wrap.
    let (notes, source): (Vec<&str>, Vec<&str>) =
        full.lines().skip(2).partition(|line| line.trim_start().starts_with("= "));
    ui.label(RichText::new(&diagnostic.message).monospace().color(STRONG));
    let text = |lines: Vec<&str>| RichText::new(lines.join("\n")).monospace().color(TEXT);
    if !source.is_empty() {
        ui.add(egui::Label::new(text(source)).extend());
    }
    if !notes.is_empty() {
        ui.add(egui::Label::new(text(notes)).wrap());
    }
    ui.add_space(6.0);
}

/// The position of a diagnostic, which opens in the editor if it is a file. The built-in tree has none.
fn position(ui: &mut Ui, diagnostic: &Diagnostic, is_file: bool, commands: &mut Vec<Command>) {
    let color = if diagnostic.severity == Severity::Error { ERROR } else { WARNING };
    let place = match diagnostic.line {
        Some(line) => format!("{}:{line}", diagnostic.file),
        None => diagnostic.file.clone(),
    };
    let label = egui::Label::new(RichText::new(&place).monospace().color(color).strong());
    let response = ui.add(label.sense(egui::Sense::click()));
    if response.clicked() {
        let Diagnostic { file, line, column, .. } = diagnostic;
        match is_file {
            true => commands.push(OPEN_EDITOR.with(Place { file: PathBuf::from(file), line: *line, column: *column })),
            false => ui.ctx().copy_text(place.clone()),
        }
    }
    response.context_menu(|ui| {
        if ui.button("Copy the position").clicked() {
            ui.ctx().copy_text(place.clone());
            ui.close();
        }
    });
    let hint = if is_file { "Click to open in the editor" } else { "Click to copy the position" };
    response.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text(hint);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disk_is_asked_once_for_each_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.glsl");
        std::fs::write(&file, "").unwrap();
        let name = file.display().to_string();
        let diagnostics = [Diagnostic::error(&name, "wrong"), Diagnostic::error("no such file", "wrong")];
        let mut files = Files::default();
        files.update(&diagnostics);
        assert!(files.is_file(&name) && !files.is_file("no such file"));
        std::fs::remove_file(&file).unwrap();
        files.update(&diagnostics);
        assert!(files.is_file(&name), "the disk is asked in each frame");
        files.update(&diagnostics[1..]);
        files.update(&diagnostics);
        assert!(!files.is_file(&name), "the answer outlives its diagnostic");
    }
}
