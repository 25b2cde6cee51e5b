//! What lies over the picture: diagnostics with their source line, a message for a while, and what is being loaded.

use std::time::Duration;

use egui::{Align2, Area, Color32, CornerRadius, Frame, Id, Margin, Order, RichText, Stroke};

use super::{ERROR, QUIET, WARNING, plural};
use crate::app::document::Document;
use crate::render::PixelValue;
use crate::shader::{Diagnostic, Severity};

const NOTICE: Duration = Duration::from_secs(6);

pub(super) fn show(egui: &egui::Context, document: &mut Document, picture: egui::Rect) {
    if !document.diagnostics.is_empty() && diagnostics(egui, &document.diagnostics, picture) {
        document.diagnostics.clear();
    }
    let loading = document.loading.then(|| "Loading the model…".to_owned());
    // Without a model the reason stays; anything else is said for a while.
    let stays = document.model.instances.is_empty() && !document.loading;
    let notice = document.notice.as_ref().filter(|(_, since)| stays || since.elapsed() < NOTICE);
    if let Some((_, since)) = notice.filter(|_| !stays) {
        egui.request_repaint_after(NOTICE.saturating_sub(since.elapsed()));
    }
    let text = notice.map(|(text, _)| text.clone()).or(loading);
    if let Some(text) = text {
        area(Id::new("notice"), Align2::CENTER_BOTTOM, picture).show(egui, |ui| {
            card(Color32::from_gray(90)).show(ui, |ui| {
                ui.set_max_width((picture.width() - 60.0).clamp(200.0, 560.0));
                ui.add(egui::Label::new(text).wrap_mode(if picture.width() > 500.0 {
                    egui::TextWrapMode::Wrap
                } else {
                    egui::TextWrapMode::Truncate
                }));
            });
        });
    }
    if document.show_ui {
        let title = document.title();
        let value = document.hover.map(|hover| {
            let pixel = PixelValue::decode(hover.value);
            let [r, g, b, _] = pixel.value.map(number);
            let numbers = if pixel.no_data { "no data".into() } else { format!("{r} {g} {b}") };
            format!("{numbers}   at {}, {}", hover.x, hover.y)
        });
        if title.is_some() || value.is_some() {
            area(Id::new("mode"), Align2::LEFT_TOP, picture).interactable(false).show(egui, |ui| {
                card(Color32::from_gray(60)).show(ui, |ui| {
                    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                    title.map(|title| ui.label(RichText::new(title).strong()));
                    value.map(|value| ui.label(RichText::new(value).monospace()));
                });
            });
        }
    }
}

/// Shows them; returns whether the user wants them away, which only warnings offer.
fn diagnostics(egui: &egui::Context, diagnostics: &[Diagnostic], picture: egui::Rect) -> bool {
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
                    hide = !failed && ui.small_button("Hide").on_hover_text("Until the next reload").clicked();
                });
            }
            egui::ScrollArea::vertical().max_height((picture.height() * 0.6).max(80.0)).show(ui, |ui| {
                for diagnostic in diagnostics {
                    one(ui, diagnostic);
                }
                if failed {
                    ui.label(RichText::new("The picture is the last good one.").small().color(QUIET));
                }
            });
        });
    });
    hide
}

/// As "3 errors, 1 warning".
fn counts(diagnostics: &[Diagnostic]) -> String {
    let count = |severity: Severity| diagnostics.iter().filter(|d| d.severity == severity).count();
    let parts = [Severity::Error, Severity::Warning].map(|severity| (count(severity), severity));
    let words = parts.iter().filter(|(n, _)| *n > 0).map(|(n, severity)| plural(*n, &severity.to_string()));
    words.collect::<Vec<_>>().join(", ")
}

fn one(ui: &mut egui::Ui, diagnostic: &Diagnostic) {
    let color = if diagnostic.severity == Severity::Error { ERROR } else { WARNING };
    let place = match diagnostic.line {
        Some(line) => format!("{}:{line}", diagnostic.file),
        None => diagnostic.file.clone(),
    };
    let response = ui.label(RichText::new(&place).monospace().color(color).strong());
    if response.on_hover_text("Click to copy the place").interact(egui::Sense::click()).clicked() {
        ui.ctx().copy_text(place);
    }
    let full = diagnostic.full();
    // Without the first two lines: message and place stand above.
    let rest = full.lines().skip(2).collect::<Vec<_>>().join("\n");
    ui.label(RichText::new(&diagnostic.message).monospace().color(Color32::WHITE));
    if !rest.is_empty() {
        ui.add(egui::Label::new(RichText::new(rest).monospace().color(Color32::from_gray(215))).extend());
    }
    ui.add_space(6.0);
}

/// Five digits that count, and room for a sign, so that the numbers do not dance.
fn number(value: f32) -> String {
    let magnitude = value.abs();
    match magnitude {
        _ if !value.is_finite() => format!("{value:>8}"),
        m if m != 0.0 && !(1e-3..1e5).contains(&m) => format!("{value:>8.2e}"),
        m => format!("{value:>8.*}", 4 - (m.max(1.0).log10() as usize).min(4)),
    }
}

fn area(id: Id, corner: Align2, picture: egui::Rect) -> Area {
    let at = corner.pos_in_rect(&picture.shrink(12.0));
    Area::new(id).order(Order::Foreground).pivot(corner).fixed_pos(at).constrain_to(picture)
}

fn card(edge: Color32) -> Frame {
    Frame::new()
        .fill(Color32::from_rgba_unmultiplied(16, 17, 20, 235))
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(CornerRadius::same(6))
        .inner_margin(Margin::symmetric(12, 8))
}
