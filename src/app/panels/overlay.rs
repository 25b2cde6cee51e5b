//! The overlay: diagnostics with their source lines, messages, loading state, the mode and the value under the mouse.

use std::path::PathBuf;

use egui::{Align2, Area, Color32, CornerRadius, Frame, Id, Margin, Order, RichText, Stroke, Ui};

use super::{ERROR, QUIET, Readings, WARNING, plural};
use crate::app::command::Command;
use crate::app::editor::Place;
use crate::app::viewer::Viewer;
use crate::shader::{Diagnostic, Severity};

/// Maximum number of model warnings to show. The rest is counted.
const MODEL_WARNINGS: usize = 4;

/// Shows what lies over the picture.
pub(super) fn show(
    egui: &egui::Context,
    viewer: &mut Viewer,
    readings: &Readings,
    picture: egui::Rect,
    commands: &mut Vec<Command>,
) {
    let cut_short = viewer.is_cut_short();
    let messages = &viewer.session.diagnostics;
    if !messages.is_empty() && diagnostics(egui, messages, cut_short, picture, commands) {
        viewer.session.diagnostics.clear();
    }
    warnings(egui, viewer, picture);
    notice(egui, viewer, picture);
    if viewer.panels.visible {
        label(egui, readings, picture);
    }
}

/// Kept messages and the model's warnings, until the user hides them.
fn warnings(egui: &egui::Context, viewer: &mut Viewer, picture: egui::Rect) {
    let model = viewer.session.model().filter(|_| viewer.panels.show_model_warnings);
    let mut lines: Vec<String> = viewer.notices.kept().to_vec();
    lines.extend(model.map(|model| model.first_warnings(MODEL_WARNINGS)).unwrap_or_default());
    if lines.is_empty() {
        return;
    }
    let mut hide = false;
    // An area keeps its first size, so other messages or another picture are another area.
    let id = Id::new(("warnings", &lines, picture.width() as u32));
    area(id, Align2::RIGHT_TOP, picture).fade_in(false).show(egui, |ui| {
        card(WARNING).show(ui, |ui| {
            ui.set_max_width((picture.width() * 0.5).clamp(200.0, 420.0));
            for line in &lines {
                ui.label(RichText::new(line).small());
            }
            hide = ui.small_button("Hide").clicked();
        });
    });
    if hide {
        viewer.notices.dismiss();
        viewer.panels.show_model_warnings = false;
    }
}

/// The passing message, or that a model is loading.
fn notice(egui: &egui::Context, viewer: &Viewer, picture: egui::Rect) {
    let has_model = viewer.session.model().is_some_and(|model| !model.instances.is_empty());
    // If no model could be loaded, the message stays.
    let stays = !has_model && !viewer.model.loading;
    let notice = viewer.notices.passing(stays);
    if let Some((_, left)) = notice.filter(|_| !stays) {
        egui.request_repaint_after(left);
    }
    let loading = viewer.model.loading.then_some("Loading the model…");
    let Some(text) = notice.map(|(text, _)| text).or(loading) else { return };
    area(Id::new("notice"), Align2::CENTER_BOTTOM, picture).show(egui, |ui| {
        card(Color32::from_gray(90)).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).clamp(200.0, 560.0));
            let wrap = if picture.width() > 500.0 { egui::TextWrapMode::Wrap } else { egui::TextWrapMode::Truncate };
            ui.add(egui::Label::new(text).wrap_mode(wrap));
        });
    });
}

/// The title with the mode, and the value under the mouse.
fn label(egui: &egui::Context, readings: &Readings, picture: egui::Rect) {
    if readings.title.is_none() && readings.value.is_none() {
        return;
    }
    area(Id::new("mode"), Align2::LEFT_TOP, picture).interactable(false).show(egui, |ui| {
        card(Color32::from_gray(60)).show(ui, |ui| {
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            readings.title.iter().for_each(|title| drop(ui.label(RichText::new(title).strong())));
            readings.value.iter().for_each(|value| drop(ui.label(RichText::new(value).monospace())));
        });
    });
}

/// Shows diagnostics. `cut_short`: one is of a loop that did not end. Returns whether the user hides them, which is possible only
/// without errors.
fn diagnostics(
    egui: &egui::Context,
    diagnostics: &[Diagnostic],
    cut_short: bool,
    picture: egui::Rect,
    commands: &mut Vec<Command>,
) -> bool {
    let failed = diagnostics.iter().any(|d| d.severity == Severity::Error);
    let mut hide = false;
    // An area keeps its first size, so other messages or another picture are another area.
    let id = Id::new(("diagnostics", diagnostics, picture.width() as u32, picture.height() as u32));
    let area = area(id, Align2::LEFT_BOTTOM, picture).default_size(picture.size()).fade_in(false);
    area.show(egui, |ui| {
        card(if failed { ERROR } else { WARNING }).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).max(200.0));
            if diagnostics.len() > 1 || !failed {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(counts(diagnostics)).strong());
                    hide = !failed && ui.small_button("Hide").on_hover_text("Hide until the next reload").clicked();
                });
            }
            egui::ScrollArea::vertical().max_height((picture.height() * 0.6).max(80.0)).show(ui, |ui| {
                for diagnostic in diagnostics {
                    one(ui, diagnostic, commands);
                }
                let picture = match cut_short {
                    true => "Where the picture is magenta, it was cut short.",
                    false => "The picture is the last good one.",
                };
                if failed {
                    ui.label(RichText::new(picture).small().color(QUIET));
                }
            });
        });
    });
    hide
}

/// A summary such as "3 errors, 1 warning".
fn counts(diagnostics: &[Diagnostic]) -> String {
    let count = |severity: Severity| diagnostics.iter().filter(|d| d.severity == severity).count();
    let parts = [Severity::Error, Severity::Warning].map(|severity| (count(severity), severity));
    let words = parts.iter().filter(|(n, _)| *n > 0).map(|(n, severity)| plural(*n, &severity.to_string()));
    words.collect::<Vec<_>>().join(", ")
}

fn one(ui: &mut Ui, diagnostic: &Diagnostic, commands: &mut Vec<Command>) {
    let color = if diagnostic.severity == Severity::Error { ERROR } else { WARNING };
    let place = match diagnostic.line {
        Some(line) => format!("{}:{line}", diagnostic.file),
        None => diagnostic.file.clone(),
    };
    position(ui, diagnostic, &place, color, commands);
    // A monospace character is 7.6 points wide; the number of the line and its bar take up to 8.
    let columns = (ui.available_width() / 7.6) as usize;
    let full = diagnostic.clone().within(columns.saturating_sub(8)).full();
    // Skip the first two lines, message and position, which are shown above. Source lines fit, and notes behind a `=` wrap.
    let (notes, source): (Vec<&str>, Vec<&str>) =
        full.lines().skip(2).partition(|line| line.trim_start().starts_with("= "));
    ui.label(RichText::new(&diagnostic.message).monospace().color(Color32::WHITE));
    let text = |lines: Vec<&str>| RichText::new(lines.join("\n")).monospace().color(Color32::from_gray(215));
    if !source.is_empty() {
        ui.add(egui::Label::new(text(source)).extend());
    }
    if !notes.is_empty() {
        ui.add(egui::Label::new(text(notes)).wrap());
    }
    ui.add_space(6.0);
}

/// The position of a diagnostic, which opens in the editor if it is a file.
fn position(ui: &mut Ui, diagnostic: &Diagnostic, place: &str, color: Color32, commands: &mut Vec<Command>) {
    let label = egui::Label::new(RichText::new(place).monospace().color(color).strong());
    let response = ui.add(label.sense(egui::Sense::click()));
    let file = PathBuf::from(&diagnostic.file);
    // The built-in tree has no files.
    let is_file = file.is_file();
    if response.clicked() {
        match is_file {
            true => commands.push(Command::Edit(Place { file, line: diagnostic.line, column: diagnostic.column })),
            false => ui.ctx().copy_text(place.to_owned()),
        }
    }
    response.context_menu(|ui| {
        if ui.button("Copy the position").clicked() {
            ui.ctx().copy_text(place.to_owned());
            ui.close();
        }
    });
    let hint = if is_file { "Click to open in the editor" } else { "Click to copy the position" };
    response.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text(hint);
}

fn area(id: Id, corner: Align2, picture: egui::Rect) -> Area {
    let at = corner.pos_in_rect(&picture.shrink(12.0));
    Area::new(id).order(Order::Foreground).pivot(corner).fixed_pos(at).constrain_to(picture)
}

pub(super) fn card(edge: Color32) -> Frame {
    Frame::new()
        .fill(Color32::from_rgba_unmultiplied(16, 17, 20, 235))
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(CornerRadius::same(6))
        .inner_margin(Margin::symmetric(12, 8))
}
