//! Bars, panels and messages around and over the picture. Each panel has a file of its own and receives only
//! what it shows and sets. `crate::app::layout` arranges them.

mod camera;
mod capture;
mod environment;
pub(super) mod expression;
mod inspector;
mod keys;
mod learn;
mod lights;
mod model;
mod modes;
pub(super) mod open_gallery;
mod output;
pub(super) mod overlay;
pub(super) mod parameters;
pub(super) mod passes;
pub(super) mod scene;
mod shaders;
mod status_bar;
#[cfg(test)]
mod tests;
pub(super) mod texture;
pub(super) mod timeline;
mod timing;
mod top_bar;

use std::sync::Arc;
use std::time::Duration;

use egui::{Ui, Vec2};

use super::command::Command;
use super::gallery::GalleryState;
use super::layout::{Layout, Panel};
use super::palette::{self, Palette};
use super::viewer::Viewer;
use super::widgets::theme::{self, ACCENT, EDGE, ERROR, QUIET, WARNING};
use crate::app::state::grid::Grid;
use crate::app::state::hint::Hint;
use crate::app::state::inspection::Inspector;
use crate::app::state::last_session::LastSessions;
use crate::app::state::recent::{Kind, Recent};
use crate::frame::Limits;
use crate::render::RangeSample;
use crate::settings::Colormap;
use crate::shader::Mode;

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
    pub(super) last_sessions: LastSessions,
    pub(super) open_gallery: open_gallery::OpenGallery,
    /// The search in the list of modes.
    search: String,
    /// Whether the warnings of the model are shown over the picture.
    pub(super) show_model_warnings: bool,
    /// Slug of the mode that the list was last scrolled to.
    scrolled_to: String,
    pub(super) gallery: GalleryState,
    pub(super) inspector: Inspector,
    timing: timing::TimingState,
    shaders: shaders::ShadersState,
    pub(super) scene: scene::SceneState,
    pub(super) texture: texture::TextureState,
    gizmo: overlay::Gizmo,
    pub(super) timeline: timeline::TimelineState,
    pub(super) expression: expression::ExpressionState,
    pub(super) defaults: parameters::defaults::Asked,
    capture: capture::CaptureState,
    files: overlay::diagnostics::Files,
    pub(super) hint: Hint,
    pub(super) legend: overlay::legend::LegendState,
    labels: overlay::Labels,
    /// The modes that the picture shows side by side.
    pub(super) grid: Grid,
}

impl PanelState {
    /// Whether the times of frames are in sight.
    pub(super) fn measures(&self) -> bool {
        self.visible && self.timing.is_visible
    }

    /// The panels as they were arranged in the last run.
    pub(super) fn restored() -> Self {
        Self {
            visible: true,
            layout: Layout::restored(),
            palette: Palette::default(),
            show_keys: false,
            key_list: keys::KeyList::default(),
            recent: Recent::restored(),
            last_sessions: LastSessions::restored(),
            open_gallery: open_gallery::OpenGallery::default(),
            search: String::new(),
            show_model_warnings: true,
            scrolled_to: String::new(),
            gallery: GalleryState::default(),
            inspector: Inspector::default(),
            timing: timing::TimingState::default(),
            shaders: shaders::ShadersState::default(),
            scene: scene::SceneState::default(),
            texture: texture::TextureState::default(),
            gizmo: overlay::Gizmo::default(),
            timeline: timeline::TimelineState::default(),
            expression: expression::ExpressionState::default(),
            defaults: parameters::defaults::Asked::default(),
            capture: capture::CaptureState::default(),
            files: overlay::diagnostics::Files::default(),
            hint: Hint::restored(),
            legend: overlay::legend::LegendState::default(),
            labels: overlay::Labels::default(),
            grid: Grid::default(),
        }
    }
}

/// Readings of the picture under the mouse.
pub(super) struct Readings {
    /// The value under the mouse.
    pub(super) value: Option<Readout>,
    /// Title over the picture.
    pub(super) title: Option<String>,
    /// Contents of the legend; `None` before the first picture.
    pub(super) legend: Option<LegendOf>,
}

/// The text of a value in the picture.
pub(super) struct Readout {
    /// Name of the side of a comparison that has the pixel; `None` without a comparison.
    pub(super) side: Option<String>,
    /// Its numbers, or what they mean.
    pub(super) value: String,
    /// Unit, and whether the value is before exposure.
    pub(super) unit: String,
    /// Pixels from the upper left corner of the picture.
    pub(super) at: (u32, u32),
}

/// The picture of which the legend speaks.
pub(super) struct LegendOf {
    pub(super) mode: Mode,
    /// The values that the display shows as black and white; `None` for those of the mode.
    pub(super) limits: Option<Limits>,
    /// Samples of the picture's values.
    pub(super) range_sample: Option<Arc<RangeSample>>,
    pub(super) colormap: Colormap,
    /// Factor from luminance to the display's 0..1.
    pub(super) exposure: f32,
    /// The colors that stand for single numbers.
    pub(super) swatches: Vec<overlay::swatches::Swatch>,
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
    viewer.update_stages();
    viewer.panels.timeline.is_visible = false;
    viewer.panels.inspector.is_visible = false;
    viewer.panels.timing.is_visible = false;
    viewer.panels.texture.request = None;
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
    overlay::show(ui.ctx(), viewer, readings, picture.rect, commands);
    let PanelState { key_list, show_keys, palette, .. } = &mut viewer.panels;
    keys::show(ui.ctx(), key_list, show_keys, !palette.is_open());
    open_gallery::show(ui.ctx(), viewer, commands);
    palette::show(ui.ctx(), viewer, whole, commands);
    parameters::defaults::show(ui.ctx(), viewer, commands);
    viewer.panels.gallery.end_frame(ui.ctx());
    viewer.panels.grid.follow(&viewer.session.settings.mode);
    picture
}

/// The status bar says what the picture waits for after this long.
const LONG: Duration = Duration::from_millis(250);

/// The bars above and below the tiles.
fn bars(ui: &mut Ui, viewer: &mut Viewer, commands: &mut Vec<Command>) {
    top_bar::show(ui, &mut viewer.panels, commands);
    let generation = viewer.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    let (shader, device) = (&viewer.shader, device(viewer));
    let diagnostics = &viewer.session.diagnostics;
    let frame_ms = viewer.timing.frame_ms();
    let stage = viewer.stages.main();
    let waits = viewer.waits_for().filter(|(_, time)| match LONG.checked_sub(*time) {
        Some(left) => {
            ui.ctx().request_repaint_after(left);
            false
        }
        None => true,
    });
    let waits = waits.map(|(waits, _)| waits);
    let status = status_bar::Status { shader, waits, generation, diagnostics, frame_ms, stage, device: &device };
    status_bar::show(ui, &status);
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
    if panel == Panel::Learn {
        return learn::show(ui, &viewer.learning, &viewer.session.diagnostics, commands);
    }
    if panel == Panel::Expression {
        let mut state = std::mem::take(&mut viewer.panels.expression);
        expression::show(ui, viewer, &mut state, commands);
        viewer.panels.expression = state;
        return;
    }
    if panel == Panel::Inspector {
        let mut state = std::mem::take(&mut viewer.panels.inspector);
        inspector::show(ui, viewer, &mut state, commands);
        viewer.panels.inspector = state;
        return;
    }
    if panel == Panel::Capture {
        let size = viewer.shown().map_or((0, 0), |state| state.size);
        let versions = viewer.versions.iter().count();
        capture::show(ui, &mut viewer.panels.capture, &viewer.controlled.captures, (size, versions), commands);
        return;
    }
    if panel == Panel::Shaders {
        let mut state = std::mem::take(&mut viewer.panels.shaders);
        shaders::show(ui, viewer, &mut state, commands);
        viewer.panels.shaders = state;
        return;
    }
    if panel == Panel::Timing {
        let mut state = std::mem::take(&mut viewer.panels.timing);
        timing::show(ui, viewer, &mut state, &device(viewer));
        viewer.panels.timing = state;
        return;
    }
    if panel == Panel::Scene {
        let mut state = std::mem::take(&mut viewer.panels.scene);
        scene::show(ui, viewer, &mut state, commands);
        viewer.panels.scene = state;
        return;
    }
    if panel == Panel::Texture {
        let mut state = std::mem::take(&mut viewer.panels.texture);
        texture::show(ui, viewer, &mut state);
        viewer.panels.texture = state;
        return;
    }
    let shaders = viewer.session.shaders.clone();
    let model = viewer.session.placed_model().unwrap_or_default();
    let is_animated = viewer.is_animated();
    let features = viewer.session.features();
    let view = viewer.shown().map(|state| state.camera);
    let session = &mut viewer.session;
    let settings = &mut session.settings;
    let declared = shaders.clone().unwrap_or_default();
    match panel {
        Panel::Viewport | Panel::Timeline | Panel::Learn | Panel::Shaders | Panel::Timing => {}
        Panel::Expression | Panel::Inspector | Panel::Capture | Panel::Scene | Panel::Texture => {}
        Panel::Modes => {
            if modes::show(ui, shaders.as_deref(), features, &mut settings.mode, &mut viewer.panels) {
                let text = "At most nine modes fit side by side. Modes of random paths can only be shown alone";
                commands.push(Command::Say(text.into()));
            }
        }
        Panel::Model => {
            let recent = viewer.panels.recent.of(Kind::Model);
            model::show(ui, settings, &model, &viewer.model, recent, commands);
        }
        Panel::Parameters => {
            let is_of_file = viewer.shader.is_single_file;
            parameters::show(ui, &declared, &mut settings.shader, is_of_file);
        }
        Panel::Passes => passes::show(ui, &declared, settings, &mut viewer.playback, is_animated),
        Panel::Environment => {
            let (progress, report) = (viewer.threads.baker.progress(), &viewer.resources.environment().report);
            environment::show(ui, settings, viewer.panels.recent.of(Kind::Environment), progress, report);
        }
        Panel::Lights => lights::show(ui, settings, model.lights.len(), commands),
        Panel::Output => output::show(ui, settings, &mut viewer.panels.legend.shows_histogram, commands),
        Panel::Camera => camera::show(ui, settings, view.as_ref(), &model, commands),
    }
}

/// A count with its noun, such as "1 draw" or "2 draws".
fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
