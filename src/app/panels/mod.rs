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
pub(super) mod readings;
pub(super) mod scene;
mod shaders;
mod status_bar;
#[cfg(test)]
mod tests;
pub(super) mod texture;
pub(super) mod timeline;
mod timing;
mod top_bar;

use std::time::Duration;

use egui::{Ui, Vec2};

use super::command::Command;
use super::gallery::GalleryState;
use super::layout::Layout;
use super::palette::{self, Palette};
use super::state::arrangement::{Panel, Preset};
use super::state::recent::Kind;
use super::state::workspace::{PanelRequest, Sight};
use super::viewer::Viewer;
use super::widgets::theme;
use readings::Readings;

/// A window smaller than this, in points, shows only the picture.
const SMALLEST_WITH_PANELS: Vec2 = Vec2::new(460.0, 240.0);

/// The user interface between frames.
pub(super) struct Panels {
    /// Whether the panels are shown (H).
    pub(super) visible: bool,
    layout: Layout,
    pub(super) docked: Docked,
    pub(super) palette: Palette,
    /// Whether the list of keys is shown (F1).
    pub(super) show_keys: bool,
    key_list: keys::KeyList,
    pub(super) open_gallery: open_gallery::OpenGallery,
    pub(super) defaults: parameters::defaults::Asked,
    pub(super) overlay: overlay::Overlay,
}

/// The states of the panels in tiles.
#[derive(Default)]
pub(super) struct Docked {
    modes: modes::ModesState,
    pub(super) gallery: GalleryState,
    inspector: inspector::InspectorState,
    timing: timing::TimingState,
    shaders: shaders::ShadersState,
    scene: scene::SceneState,
    pub(super) texture: texture::TextureState,
    timeline: timeline::TimelineState,
    expression: expression::ExpressionState,
    capture: capture::CaptureState,
}

impl Panels {
    /// The panels as they were arranged in the last run.
    pub(super) fn restored() -> Self {
        Self {
            visible: true,
            layout: Layout::restored(),
            docked: Docked::default(),
            palette: Palette::default(),
            show_keys: false,
            key_list: keys::KeyList::default(),
            open_gallery: open_gallery::OpenGallery::default(),
            defaults: parameters::defaults::Asked::default(),
            overlay: overlay::Overlay::default(),
        }
    }

    /// Does what the rest of the window has asked for since the last frame.
    fn carry_out(&mut self, request: PanelRequest) {
        match request {
            PanelRequest::Toggle => self.visible ^= true,
            PanelRequest::Unhide => self.visible = true,
            PanelRequest::Open(panel) => self.layout.open(panel),
            PanelRequest::Arrange(preset) => self.layout.arrange(preset),
            PanelRequest::ArrangeTemporarily(preset) => self.layout.arrange_temporarily(preset),
            PanelRequest::ArrangeAsBefore => self.layout.arrange_as_before(),
            PanelRequest::ArrangeOwn => self.layout.arrange_own(),
            PanelRequest::ResetArrangement => self.layout.reset(),
            PanelRequest::ShowExercise if self.layout.is_in_sight(Panel::Learn) => {}
            PanelRequest::ShowExercise => self.layout.arrange_temporarily(Preset::Learn),
            PanelRequest::ToggleTheme => self.layout.set_light(!self.layout.is_light()),
            PanelRequest::ToggleHistogram => self.overlay.legend.shows_histogram ^= true,
            PanelRequest::ShowKeys => self.show_keys = true,
            PanelRequest::ShowGallery => self.open_gallery.is_open = true,
            PanelRequest::AskVersion(number) => self.docked.timeline.ask(number),
            PanelRequest::AskDefaults => self.defaults.ask(None),
            PanelRequest::FocusExpression => self.docked.expression.focus(),
            PanelRequest::FollowSelection => self.docked.scene.follow(),
        }
    }
}

/// Where the picture is, in points.
#[derive(Clone, Copy)]
pub(super) struct PictureArea {
    pub(super) rect: egui::Rect,
    /// The part of it that no handle between it and a panel covers.
    pub(super) free: egui::Rect,
}

/// Shows bars, panels and messages. Returns what is left for the picture.
pub(super) fn show(
    ui: &mut Ui,
    viewer: &mut Viewer,
    panels: &mut Panels,
    readings: &Readings,
    commands: &mut Vec<Command>,
) -> PictureArea {
    viewer.workspace.take_requests().into_iter().for_each(|request| panels.carry_out(request));
    let whole = ui.max_rect();
    theme::choose(ui.ctx(), panels.layout.is_light());
    let has_room = whole.width() >= SMALLEST_WITH_PANELS.x && whole.height() >= SMALLEST_WITH_PANELS.y;
    viewer.update_stages();
    let mut sight = Sight::default();
    viewer.inspection.is_visible = false;
    panels.docked.texture.request = None;
    panels.docked.gallery.begin_frame();
    let picture = if panels.visible && has_room {
        bars(ui, viewer, panels, commands);
        let Panels { layout, docked, overlay, .. } = &mut *panels;
        let shows_histogram = &mut overlay.legend.shows_histogram;
        let picture = layout
            .show(ui, &mut |ui, shown| panel(ui, shown, (&mut *viewer, &mut sight), docked, shows_histogram, commands));
        PictureArea { rect: picture, free: layout.free_of_handles() }
    } else {
        PictureArea { rect: whole, free: whole }
    };
    let beside = (&panels.docked.gallery, panels.visible);
    let asked = overlay::show(ui.ctx(), (&mut *viewer, &mut panels.overlay), beside, readings, picture.rect, commands);
    asked.into_iter().for_each(|number| panels.docked.timeline.ask(number));
    keys::show(ui.ctx(), &mut panels.key_list, &mut panels.show_keys, !panels.palette.is_open());
    open_gallery::show(ui.ctx(), viewer, &mut panels.open_gallery, commands);
    palette::show(ui.ctx(), viewer, &mut panels.palette, whole, commands);
    parameters::defaults::show(ui.ctx(), viewer, &mut panels.defaults, commands);
    panels.docked.gallery.end_frame(ui.ctx());
    viewer.grid.follow(&viewer.session.settings.mode);
    sight.preview = panels.docked.gallery.preview().map(str::to_owned);
    sight.learn = panels.layout.is_in_sight(Panel::Learn);
    sight.has_own_arrangement = panels.layout.has_own();
    viewer.workspace.sight = sight;
    picture
}

/// The status bar says what the picture waits for after this long.
const LONG: Duration = Duration::from_millis(250);

/// The bars above and below the tiles.
fn bars(ui: &mut Ui, viewer: &Viewer, panels: &mut Panels, commands: &mut Vec<Command>) {
    let Panels { layout, palette, show_keys, .. } = panels;
    top_bar::show(ui, (layout, palette, show_keys), (&viewer.recent, &viewer.last_sessions), commands);
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

/// Shows the panel in a tile, and notes that it is in sight.
fn panel(
    ui: &mut Ui,
    panel: Panel,
    (viewer, sight): (&mut Viewer, &mut Sight),
    docked: &mut Docked,
    shows_histogram: &mut bool,
    commands: &mut Vec<Command>,
) {
    let shaders = viewer.session.shaders.clone();
    let model = viewer.session.placed_model().unwrap_or_default();
    let settings = &mut viewer.session.settings;
    match panel {
        Panel::Viewport => {}
        Panel::Modes => {
            let features = viewer.session.features();
            let (current, grid) = (&mut viewer.session.settings.mode, &mut viewer.grid);
            let Docked { modes, gallery, .. } = docked;
            if modes::show(ui, shaders.as_deref(), features, current, grid, (modes, gallery)) {
                let text = "At most nine modes fit side by side. Modes of random paths can only be shown alone";
                commands.push(Command::Say(text.into()));
            }
        }
        Panel::Scene => scene::show(ui, viewer, &mut docked.scene, commands),
        Panel::Model => {
            let recent = viewer.recent.of(Kind::Model);
            model::show(ui, settings, &model, &viewer.model, recent, commands);
        }
        Panel::Texture => texture::show(ui, viewer, &mut docked.texture),
        Panel::Learn => learn::show(ui, &viewer.learning, &viewer.session.diagnostics, commands),
        Panel::Shaders => shaders::show(ui, viewer, &mut docked.shaders, commands),
        Panel::Timeline => {
            sight.timeline = true;
            timeline::show(ui, viewer, &mut docked.timeline, commands);
        }
        Panel::Timing => {
            sight.timing = true;
            timing::show(ui, viewer, &mut docked.timing, &device(viewer));
        }
        Panel::Expression => expression::show(ui, viewer, &mut docked.expression, commands),
        Panel::Parameters => {
            let is_of_file = viewer.shader.is_single_file;
            parameters::show(ui, &shaders.unwrap_or_default(), &mut settings.shader, is_of_file);
        }
        Panel::Passes => {
            let is_animated = viewer.is_animated();
            let (settings, playback) = (&mut viewer.session.settings, &mut viewer.playback);
            passes::show(ui, &shaders.unwrap_or_default(), settings, playback, is_animated);
        }
        Panel::Inspector => {
            viewer.inspection.is_visible = true;
            inspector::show(ui, viewer, &mut docked.inspector, commands);
        }
        Panel::Environment => {
            let (progress, report) = (viewer.threads.baker.progress(), &viewer.resources.environment().report);
            environment::show(ui, settings, viewer.recent.of(Kind::Environment), progress, report);
        }
        Panel::Lights => lights::show(ui, settings, model.lights.len(), commands),
        Panel::Output => output::show(ui, settings, shows_histogram, commands),
        Panel::Camera => {
            let view = viewer.shown().map(|state| state.camera);
            camera::show(ui, &mut viewer.session.settings, view.as_ref(), &model, commands);
        }
        Panel::Capture => {
            let size = viewer.shown().map_or((0, 0), |state| state.size);
            let versions = viewer.versions.iter().count();
            capture::show(ui, &mut docked.capture, &viewer.controlled.captures, (size, versions), commands);
        }
    }
}
