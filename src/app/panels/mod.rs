//! The panels: modes on the left, settings on the right, messages over the picture. Each panel has a file of its own and
//! receives only what it shows and sets.

mod camera;
mod environment;
mod keys;
mod lights;
mod model;
mod modes;
mod output;
mod overlay;
mod parameters;
mod passes;
mod shaders;
mod timing;

use std::ops::RangeInclusive;

use egui::{Color32, FontId, Margin, Slider, TextStyle, Ui};

use super::command::Command;
use super::viewer::Viewer;
use crate::gpu::PassTime;

/// Background of the panels.
const PANEL: Color32 = Color32::from_rgb(24, 25, 28);
/// Links.
const ACCENT: Color32 = Color32::from_rgb(94, 182, 255);
/// Errors.
const ERROR: Color32 = Color32::from_rgb(255, 110, 100);
/// Warnings.
const WARNING: Color32 = Color32::from_rgb(255, 196, 92);
/// Explanations.
const QUIET: Color32 = Color32::from_rgb(150, 154, 162);

/// Sets colors, fonts and spacing.
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
        // Keeps the bar beside the content even while it is wide, under the mouse.
        let scroll = &mut style.spacing.scroll;
        scroll.floating_allocated_width = scroll.bar_width + scroll.bar_inner_margin;
    });
}

/// State of the panels between frames.
pub(super) struct PanelState {
    /// Whether the panels are shown (H).
    pub(super) visible: bool,
    /// Whether the list of keys is shown (F1).
    pub(super) show_keys: bool,
    /// The search in the list of modes.
    search: String,
    /// Whether the warnings of the model are shown over the picture.
    pub(super) show_model_warnings: bool,
    /// Slug of the mode that the list was last scrolled to.
    scrolled_to: String,
    timing: timing::Timing,
}

impl Default for PanelState {
    fn default() -> Self {
        Self {
            visible: true,
            show_keys: false,
            search: String::new(),
            show_model_warnings: true,
            scrolled_to: String::new(),
            timing: timing::Timing::default(),
        }
    }
}

/// Measurements of the last frames.
pub(super) struct Readings {
    /// Device time of the newest finished frame, milliseconds.
    pub(super) device_ms: Option<f64>,
    /// Device time of each of its passes.
    pub(super) passes: Vec<PassTime>,
    /// Text of the value under the mouse.
    pub(super) value: Option<String>,
    /// Title over the picture.
    pub(super) title: Option<String>,
}

/// Shows all panels. Returns the rectangle that is left for the picture.
pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, readings: &Readings, commands: &mut Vec<Command>) -> egui::Rect {
    let whole = ui.max_rect();
    let frame = egui::Frame::new().fill(PANEL).inner_margin(Margin::symmetric(8, 6));
    // In a narrow window the picture has priority.
    if viewer.panels.visible && whole.width() > 460.0 {
        if whole.width() > 760.0 {
            let panel = egui::Panel::left("modes").frame(frame).default_size(170.0).min_size(120.0).max_size(320.0);
            let (session, state) = (&mut viewer.session, &mut viewer.panels);
            let mode = &mut session.settings.mode;
            panel.show(ui, |ui| modes::show(ui, session.shaders.as_deref(), mode, state));
        }
        let panel =
            egui::Panel::right("settings").frame(frame).default_size(SETTINGS + 16.0).min_size(220.0).max_size(480.0);
        panel.show(ui, |ui| {
            ui.spacing_mut().slider_width += (ui.max_rect().width() - SETTINGS_WITH_ROOM).max(0.0);
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| settings(ui, viewer, readings, commands));
        });
    }
    let picture = ui.available_rect_before_wrap();
    overlay::show(ui.ctx(), viewer, readings, picture);
    keys::show(ui.ctx(), &mut viewer.panels.show_keys);
    picture
}

/// The panels on the right.
fn settings(ui: &mut Ui, viewer: &mut Viewer, readings: &Readings, commands: &mut Vec<Command>) {
    let shaders = viewer.session.shaders.clone().unwrap_or_default();
    let model = viewer.session.model().cloned().unwrap_or_default();
    let (cut_short, is_animated) = (viewer.is_cut_short(), viewer.is_animated());
    let (session, info) = (&mut viewer.session, viewer.gpu.info());
    let device = format!("{} · Vulkan {}", info.name, info.api);
    shaders::show(ui, &viewer.shader, shaders.generation, &session.diagnostics, cut_short, commands);
    timing::show(ui, &mut viewer.panels.timing, readings, &device);
    let settings = &mut session.settings;
    environment::show(ui, settings, viewer.threads.baker.progress(), &viewer.resources.environment().report);
    parameters::show(ui, &shaders, &mut settings.shader);
    lights::show(ui, &mut settings.lights, model.lights.len());
    output::show(ui, settings, commands);
    passes::show(ui, &shaders, settings, &mut viewer.playback, is_animated);
    camera::show(ui, &mut settings.camera, &model, commands);
    model::show(ui, settings, &model, &viewer.model);
}

/// A collapsible section.
fn section(ui: &mut Ui, title: &str, open: bool, body: impl FnOnce(&mut Ui)) {
    let heading = egui::RichText::new(title).strong().size(14.0);
    egui::CollapsingHeader::new(heading).id_salt(title).default_open(open).show_unindented(ui, body);
    ui.add_space(4.0);
}

/// Width of the settings at first, in points.
const SETTINGS: f32 = 302.0;
/// Width from which sliders are longer. Less would let the longest row widen its own panel.
const SETTINGS_WITH_ROOM: f32 = 340.0;

/// Size of the names at the left of rows, in points.
const NAME: egui::Vec2 = egui::vec2(120.0, 18.0);

/// A row with its name on the left and its control on the right. `doc` is the hover text of the name.
fn row<R>(ui: &mut Ui, name: &str, doc: &str, control: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let label = |ui: &mut Ui| {
            ui.set_min_size(NAME);
            ui.add(egui::Label::new(name).truncate())
        };
        let response = ui.allocate_ui_with_layout(NAME, layout, label).inner;
        if !doc.is_empty() {
            response.on_hover_text(doc);
        }
        control(ui)
    })
    .inner
}

/// A row with a slider in degrees.
fn angle(ui: &mut Ui, name: &str, doc: &str, degrees: &mut f32, range: RangeInclusive<f32>) {
    row(ui, name, doc, |ui| ui.add(Slider::new(degrees, range).suffix("°").max_decimals(0)));
}

/// A count with its noun, such as "1 draw" or "2 draws".
fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// A color picker for linear RGB.
fn color(ui: &mut Ui, linear: &mut [f32; 3]) -> egui::Response {
    egui::widgets::color_picker::color_edit_button_rgb(ui, linear)
}
