//! The panels: modes on the left, everything that can be set on the right, messages over the picture. One file per panel.

mod camera;
mod environment;
mod lights;
mod model;
mod modes;
mod output;
mod overlay;
mod parameters;
mod shaders;

use egui::{Color32, FontId, Margin, TextStyle, Ui};

use super::document::Document;

/// Behind the panels.
const PANEL: Color32 = Color32::from_rgb(24, 25, 28);
/// Names of things that can be chosen.
const ACCENT: Color32 = Color32::from_rgb(94, 182, 255);
/// Errors.
const ERROR: Color32 = Color32::from_rgb(255, 110, 100);
/// Warnings.
const WARNING: Color32 = Color32::from_rgb(255, 196, 92);
/// Text that only explains.
const QUIET: Color32 = Color32::from_rgb(150, 154, 162);

/// Sets the look of the user interface.
pub(super) fn style(egui: &egui::Context) {
    egui.set_theme(egui::Theme::Dark);
    egui.all_styles_mut(|style| {
        style.visuals.panel_fill = PANEL;
        style.visuals.window_fill = PANEL;
        style.visuals.selection.bg_fill = Color32::from_rgb(35, 86, 134);
        style.visuals.hyperlink_color = ACCENT;
        style.text_styles.insert(TextStyle::Body, FontId::proportional(13.0));
        style.text_styles.insert(TextStyle::Button, FontId::proportional(13.0));
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(12.5));
        style.text_styles.insert(TextStyle::Small, FontId::proportional(11.0));
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.spacing.slider_width = 100.0;
    });
}

/// Shows everything; returns the rectangle that is left for the picture.
pub(super) fn show(ui: &mut Ui, document: &mut Document, device_ms: Option<f64>) -> egui::Rect {
    let whole = ui.max_rect();
    let frame = egui::Frame::new().fill(PANEL).inner_margin(Margin::symmetric(8, 6));
    // On a window too narrow for both, the picture goes first.
    if document.show_ui && whole.width() > 460.0 {
        if whole.width() > 760.0 {
            let panel = egui::Panel::left("modes").frame(frame).default_size(170.0).min_size(120.0).max_size(320.0);
            panel.show(ui, |ui| modes::show(ui, document));
        }
        let panel = egui::Panel::right("settings").frame(frame).default_size(304.0).min_size(220.0).max_size(480.0);
        panel.show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                shaders::show(ui, document, device_ms);
                parameters::show(ui, document);
                environment::show(ui, document);
                lights::show(ui, document);
                output::show(ui, document);
                camera::show(ui, document);
                model::show(ui, document);
            });
        });
    }
    let picture = ui.available_rect_before_wrap();
    overlay::show(ui.ctx(), document, picture);
    picture
}

/// A heading that folds what is below it.
fn section(ui: &mut Ui, title: &str, open: bool, body: impl FnOnce(&mut Ui)) {
    let heading = egui::RichText::new(title).strong().size(14.0);
    egui::CollapsingHeader::new(heading).id_salt(title).default_open(open).show_unindented(ui, body);
    ui.add_space(4.0);
}

/// A row: name on the left, control on the right.
fn row<R>(ui: &mut Ui, name: &str, doc: &str, control: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let size = egui::vec2(120.0, 18.0);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let label = |ui: &mut Ui| {
            ui.set_min_size(size);
            ui.add(egui::Label::new(name).truncate())
        };
        let response = ui.allocate_ui_with_layout(size, layout, label).inner;
        if !doc.is_empty() {
            response.on_hover_text(doc);
        }
        control(ui)
    })
    .inner
}

/// "1 draw", "2 draws".
fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// A color as linear RGB.
fn color(ui: &mut Ui, linear: &mut [f32; 3]) {
    egui::widgets::color_picker::color_edit_button_rgb(ui, linear);
}
