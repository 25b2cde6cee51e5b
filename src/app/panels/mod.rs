//! Bars, panels and messages around and over the picture. Each panel has a file of its own and receives only
//! what it shows and sets. `crate::app::layout` arranges them.

mod camera;
mod compare;
mod environment;
mod grid;
mod keys;
mod labels;
mod lights;
mod mode_tile;
mod model;
mod modes;
mod output;
mod overlay;
pub(super) mod parameters;
pub(super) mod passes;
mod range;
pub(super) mod rows;
mod shaders;
mod status_bar;
#[cfg(test)]
mod tests;
pub(super) mod theme;
pub(super) mod timeline;
mod timing;
mod top_bar;

use std::sync::Arc;

use egui::{Ui, Vec2};

use super::command::Command;
use super::gallery::GalleryState;
use super::grid::Grid;
use super::layout::{Layout, Panel};
use super::palette::{self, Palette};
use super::recent::{Kind, Recent};
use super::viewer::Viewer;
use crate::frame::Limits;
use crate::gpu::PassTime;
use crate::render::Survey;
use crate::settings::Colormap;
use crate::shader::Mode;
use theme::{ACCENT, EDGE, ERROR, QUIET, WARNING};

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
    key_list: keys::KeyList,
    /// Files that were open, in this run and before.
    pub(super) recent: Recent,
    /// The search in the list of modes.
    search: String,
    /// Whether the warnings of the model are shown over the picture.
    pub(super) show_model_warnings: bool,
    /// Slug of the mode that the list was last scrolled to.
    scrolled_to: String,
    pub(super) gallery: GalleryState,
    timing: timing::Timing,
    pub(super) timeline: timeline::TimelineState,
    files: overlay::diagnostics::Files,
    pub(super) legend: overlay::legend::LegendState,
    labels: labels::Labels,
    /// The modes that the picture shows side by side.
    pub(super) grid: Grid,
}

impl PanelState {
    /// The panels as they were arranged in the last run.
    pub(super) fn restored() -> Self {
        Self {
            visible: true,
            layout: Layout::restored(),
            palette: Palette::default(),
            show_keys: false,
            key_list: keys::KeyList::default(),
            recent: Recent::restored(),
            search: String::new(),
            show_model_warnings: true,
            scrolled_to: String::new(),
            gallery: GalleryState::default(),
            timing: timing::Timing::default(),
            timeline: timeline::TimelineState::default(),
            files: overlay::diagnostics::Files::default(),
            legend: overlay::legend::LegendState::default(),
            labels: labels::Labels::default(),
            grid: Grid::default(),
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
    /// What the legend says; `None` before the first picture.
    pub(super) legend: Option<LegendOf>,
}

/// The picture of which the legend speaks.
pub(super) struct LegendOf {
    pub(super) mode: Mode,
    /// The values that the display shows as black and white; `None` for those of the mode.
    pub(super) limits: Option<Limits>,
    /// Samples of the picture's values.
    pub(super) survey: Option<Arc<Survey>>,
    pub(super) colormap: Colormap,
    /// Factor from luminance to the display's 0..1.
    pub(super) exposure: f32,
}

/// Where the picture is, in points.
#[derive(Clone, Copy)]
pub(super) struct PictureArea {
    pub(super) rect: egui::Rect,
    /// The part of it that no handle between it and a panel covers.
    pub(super) free: egui::Rect,
}

/// Shows bars, panels and messages. Returns what is left for the picture.
pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, readings: &Readings, commands: &mut Vec<Command>) -> PictureArea {
    let whole = ui.max_rect();
    theme::choose(ui.ctx(), viewer.panels.layout.is_light());
    let has_room = whole.width() >= SMALLEST_WITH_PANELS.x && whole.height() >= SMALLEST_WITH_PANELS.y;
    viewer.panels.timing.record(readings);
    viewer.panels.timeline.is_visible = false;
    viewer.panels.gallery.begin_frame();
    let picture = if viewer.panels.visible && has_room {
        bars(ui, viewer, commands);
        let mut layout = std::mem::take(&mut viewer.panels.layout);
        let picture = layout.show(ui, &mut |ui, shown| panel(ui, shown, viewer, commands));
        let free = layout.free_of_handles();
        viewer.panels.layout = layout;
        PictureArea { rect: picture, free }
    } else {
        PictureArea { rect: whole, free: whole }
    };
    compare::show(ui.ctx(), viewer, picture.rect);
    grid::show(ui.ctx(), &viewer.session, &viewer.panels, picture.rect);
    if viewer.panels.visible
        && readings.legend.is_some()
        && !viewer.panels.grid.is_on()
        && let Some(model) = viewer.session.model()
    {
        let (labels, camera) = (&mut viewer.panels.labels, &viewer.session.settings.camera);
        labels::show(ui.ctx(), labels, model, camera, picture.rect);
    }
    overlay::show(ui.ctx(), viewer, readings, picture.rect, commands);
    let PanelState { key_list, show_keys, palette, .. } = &mut viewer.panels;
    keys::show(ui.ctx(), key_list, show_keys, !palette.is_open());
    palette::show(ui.ctx(), viewer, whole, commands);
    viewer.panels.gallery.end_frame(ui.ctx());
    viewer.panels.grid.follow(&viewer.session.settings.mode);
    picture
}

/// The bars above and below the tiles.
fn bars(ui: &mut Ui, viewer: &mut Viewer, commands: &mut Vec<Command>) {
    top_bar::show(ui, &mut viewer.panels, commands);
    let generation = viewer.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    let (shader, device) = (&viewer.shader, device(viewer));
    let diagnostics = &viewer.session.diagnostics;
    let frame_ms = viewer.panels.timing.frame_ms;
    status_bar::show(ui, &status_bar::Status { shader, generation, diagnostics, frame_ms, device: &device });
}

/// The name of the device and its version of Vulkan.
fn device(viewer: &Viewer) -> String {
    let info = viewer.gpu.info();
    format!("{} · Vulkan {}", info.name, info.api)
}

/// Shows the panel in a tile.
fn panel(ui: &mut Ui, panel: Panel, viewer: &mut Viewer, commands: &mut Vec<Command>) {
    if panel == Panel::Timeline {
        let mut state = std::mem::take(&mut viewer.panels.timeline);
        timeline::show(ui, viewer, &mut state, commands);
        viewer.panels.timeline = state;
        return;
    }
    let shaders = viewer.session.shaders.clone();
    let model = viewer.session.model().cloned().unwrap_or_default();
    let (cut_short, is_animated, device) = (viewer.is_cut_short(), viewer.is_animated(), device(viewer));
    let features = viewer.session.features();
    let session = &mut viewer.session;
    let settings = &mut session.settings;
    let declared = shaders.clone().unwrap_or_default();
    match panel {
        Panel::Viewport | Panel::Timeline => {}
        Panel::Modes => {
            if modes::show(ui, shaders.as_deref(), features, &mut settings.mode, &mut viewer.panels) {
                let text = "Nine modes fit side by side, and modes of random paths are shown alone";
                commands.push(Command::Say(text.into()));
            }
        }
        Panel::Model => {
            let recent = viewer.panels.recent.of(Kind::Model);
            model::show(ui, settings, &model, &viewer.model, recent, commands);
        }
        Panel::Shaders => {
            shaders::show(ui, &viewer.shader, declared.generation, &session.diagnostics, cut_short, commands);
        }
        Panel::Timing => timing::show(ui, &viewer.panels.timing, &device),
        Panel::Parameters => parameters::show(ui, &declared, &mut settings.shader),
        Panel::Passes => passes::show(ui, &declared, settings, &mut viewer.playback, is_animated),
        Panel::Environment => {
            let (progress, report) = (viewer.threads.baker.progress(), &viewer.resources.environment().report);
            environment::show(ui, settings, viewer.panels.recent.of(Kind::Environment), progress, report);
        }
        Panel::Lights => lights::show(ui, settings, model.lights.len()),
        Panel::Output => output::show(ui, settings, commands),
        Panel::Camera => camera::show(ui, settings, &model, commands),
    }
}

/// A count with its noun, such as "1 draw" or "2 draws".
fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
