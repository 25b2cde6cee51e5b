//! What the window shows around and over the picture: bars, panels and messages. Each panel has a file of its own and receives only
//! what it shows and sets. `crate::app::layout` arranges them.

mod camera;
mod environment;
mod keys;
mod lights;
mod mode_tile;
mod model;
mod modes;
mod output;
mod overlay;
mod parameters;
mod passes;
mod shaders;
mod status_bar;
pub(super) mod theme;
mod timing;
mod top_bar;

use std::ops::RangeInclusive;

use egui::{Response, Slider, Ui, Vec2};

use super::command::Command;
use super::gallery::GalleryState;
use super::layout::{Layout, Panel};
use super::palette::{self, Palette};
use super::viewer::Viewer;
use crate::gpu::PassTime;
use crate::scene::environment::BUILT_IN;
use theme::{ACCENT, ERROR, QUIET, WARNING};

/// Files of environments that the list keeps.
const MOST_ENVIRONMENTS: usize = 8;
/// A window smaller than this, in points, shows only the picture.
const SMALLEST_WITH_PANELS: Vec2 = Vec2::new(460.0, 240.0);

/// State of the panels between frames.
pub(super) struct PanelState {
    /// Whether the panels are shown (H).
    pub(super) visible: bool,
    pub(super) layout: Layout,
    pub(super) palette: Palette,
    /// Whether the list of keys is shown (F1).
    pub(super) show_keys: bool,
    /// Files of environments that were shown, the newest last.
    pub(super) environments: Vec<String>,
    /// The search in the list of modes.
    search: String,
    /// Whether the warnings of the model are shown over the picture.
    pub(super) show_model_warnings: bool,
    /// Slug of the mode that the list was last scrolled to.
    scrolled_to: String,
    pub(super) gallery: GalleryState,
    timing: timing::Timing,
}

impl PanelState {
    /// The panels as they were arranged in the last run.
    pub(super) fn restored() -> Self {
        Self {
            visible: true,
            layout: Layout::restored(),
            palette: Palette::default(),
            show_keys: false,
            environments: Vec::new(),
            search: String::new(),
            show_model_warnings: true,
            scrolled_to: String::new(),
            gallery: GalleryState::default(),
            timing: timing::Timing::default(),
        }
    }
}

impl PanelState {
    /// Keeps an environment's file in the list.
    fn remember(&mut self, environment: &str) {
        let is_file = environment != "none" && !BUILT_IN.contains(&environment);
        if is_file && !self.environments.iter().any(|known| known == environment) {
            self.environments.push(environment.to_owned());
            self.environments.drain(..self.environments.len().saturating_sub(MOST_ENVIRONMENTS));
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

/// Shows bars, panels and messages. Returns the rectangle that is left for the picture.
pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, readings: &Readings, commands: &mut Vec<Command>) -> egui::Rect {
    let whole = ui.max_rect();
    let has_room = whole.width() >= SMALLEST_WITH_PANELS.x && whole.height() >= SMALLEST_WITH_PANELS.y;
    viewer.panels.timing.record(readings);
    viewer.panels.gallery.begin_frame();
    viewer.panels.remember(&viewer.session.settings.environment.name);
    let picture = if viewer.panels.visible && has_room {
        bars(ui, viewer, readings);
        let mut layout = std::mem::take(&mut viewer.panels.layout);
        let picture = layout.show(ui, &mut |ui, shown| panel(ui, shown, viewer, readings, commands));
        viewer.panels.layout = layout;
        picture
    } else {
        whole
    };
    overlay::show(ui.ctx(), viewer, readings, picture, commands);
    keys::show(ui.ctx(), &mut viewer.panels.show_keys);
    palette::show(ui.ctx(), viewer, whole, commands);
    viewer.panels.gallery.end_frame(ui.ctx());
    picture
}

/// The bars above and below the tiles.
fn bars(ui: &mut Ui, viewer: &mut Viewer, readings: &Readings) {
    top_bar::show(ui, &mut viewer.panels);
    let generation = viewer.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    let (shader, device) = (&viewer.shader, device(viewer));
    let diagnostics = &viewer.session.diagnostics;
    status_bar::show(ui, &status_bar::Status { shader, generation, diagnostics, readings, device: &device });
}

/// The name of the device and its version of Vulkan.
fn device(viewer: &Viewer) -> String {
    let info = viewer.gpu.info();
    format!("{} · Vulkan {}", info.name, info.api)
}

/// What is in a tile.
fn panel(ui: &mut Ui, panel: Panel, viewer: &mut Viewer, readings: &Readings, commands: &mut Vec<Command>) {
    let shaders = viewer.session.shaders.clone();
    let model = viewer.session.model().cloned().unwrap_or_default();
    let (cut_short, is_animated, device) = (viewer.is_cut_short(), viewer.is_animated(), device(viewer));
    let features = viewer.session.features();
    let session = &mut viewer.session;
    let settings = &mut session.settings;
    let declared = shaders.clone().unwrap_or_default();
    match panel {
        Panel::Viewport => {}
        Panel::Modes => modes::show(ui, shaders.as_deref(), features, &mut settings.mode, &mut viewer.panels),
        Panel::Model => model::show(ui, settings, &model, &viewer.model, commands),
        Panel::Shaders => {
            shaders::show(ui, &viewer.shader, declared.generation, &session.diagnostics, cut_short, commands);
        }
        Panel::Timing => timing::show(ui, &viewer.panels.timing, readings, &device),
        Panel::Parameters => parameters::show(ui, &declared, &mut settings.shader),
        Panel::Passes => passes::show(ui, &declared, settings, &mut viewer.playback, is_animated),
        Panel::Environment => {
            let (progress, report) = (viewer.threads.baker.progress(), &viewer.resources.environment().report);
            environment::show(ui, settings, &viewer.panels.environments, progress, report);
        }
        Panel::Lights => lights::show(ui, &mut settings.lights, model.lights.len(), settings.environment.is_lit()),
        Panel::Output => output::show(ui, settings, commands),
        Panel::Camera => camera::show(ui, &mut settings.camera, &model, commands),
    }
}

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
    row(ui, name, doc, |ui| slide(ui, Slider::new(degrees, range).suffix("°").max_decimals(0)));
}

/// Points that the number beside a slider takes, with its unit.
const VALUE: f32 = 72.0;

/// A slider as long as the rest of its row.
fn slide(ui: &mut Ui, slider: Slider<'_>) -> Response {
    ui.spacing_mut().slider_width = (ui.available_width() - VALUE).clamp(40.0, 400.0);
    ui.add(slider)
}

/// A count with its noun, such as "1 draw" or "2 draws".
fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// A color picker for linear RGB.
fn color(ui: &mut Ui, linear: &mut [f32; 3]) -> egui::Response {
    egui::widgets::color_picker::color_edit_button_rgb(ui, linear)
}
