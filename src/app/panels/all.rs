//! All panels in a frame: the bars, the tiles, and the messages over the picture.

#[cfg(test)]
mod tests;

use egui::{Ui, Vec2};

use super::panel_ui::PanelUi;
use super::{PANELS, baking, keys, open_gallery, overlay, parameters, status_bar, top_bar};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::layout::Layout;
use crate::app::palette::{self, Palette};
use crate::app::state::arrangement::{Panel, Preset};
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::theme;
use crate::recovery::TypedText;

/// A window smaller than this, in points, shows only the picture.
const SMALLEST_WITH_PANELS: Vec2 = Vec2::new(460.0, 240.0);

/// The user interface between frames.
pub(in crate::app) struct Panels {
    /// Whether the panels are shown (H).
    pub(in crate::app) visible: bool,
    layout: Layout,
    docked: Vec<(Panel, Box<dyn PanelUi>)>,
    pub(in crate::app) palette: Palette,
    /// Whether the list of keys is shown (F1).
    pub(in crate::app) show_keys: bool,
    key_list: keys::KeyList,
    pub(in crate::app) open_gallery: open_gallery::OpenGallery,
    pub(in crate::app) defaults: parameters::defaults::AskedDefaults,
    overlay: overlay::Overlay,
}

impl Panels {
    /// The panels as they were arranged in the last run.
    pub(in crate::app) fn restored() -> Self {
        Self::of_layout(Layout::restored())
    }

    fn of_layout(layout: Layout) -> Self {
        Self {
            visible: true,
            layout,
            docked: PANELS.iter().map(|spec| (spec.panel, (spec.make)())).collect(),
            palette: Palette::default(),
            show_keys: false,
            key_list: keys::KeyList::default(),
            open_gallery: open_gallery::OpenGallery::default(),
            defaults: parameters::defaults::AskedDefaults::default(),
            overlay: overlay::Overlay::default(),
        }
    }

    /// The texts that were typed and not saved, also of panels that are closed.
    pub(in crate::app) fn unsaved(&self) -> Vec<TypedText> {
        self.docked.iter().flat_map(|(_, panel)| panel.unsaved()).collect()
    }

    /// Closes the list of keys or the gallery. Returns whether one was open.
    pub(in crate::app) fn close_list(&mut self) -> bool {
        std::mem::take(&mut self.show_keys) || std::mem::take(&mut self.open_gallery.is_open)
    }

    /// Does what the rest of the window has asked for since the last frame.
    pub(in crate::app) fn carry_out(&mut self, request: &PanelRequest) {
        match *request {
            PanelRequest::Toggle => self.visible ^= true,
            PanelRequest::Unhide => self.visible = true,
            PanelRequest::Open(panel) => self.layout.open(panel),
            PanelRequest::Arrange(preset) => self.layout.arrange(preset),
            PanelRequest::ArrangeTemporarily(preset) => self.layout.arrange_temporarily(preset),
            PanelRequest::ArrangeAsBefore => self.layout.arrange_as_before(),
            PanelRequest::ArrangeOwn => self.layout.arrange_own(),
            PanelRequest::ResetArrangement => self.layout.reset(),
            PanelRequest::ShowExercise if self.layout.is_in_sight(Panel::LEARN) => {}
            PanelRequest::ShowExercise => self.layout.arrange_temporarily(Preset::Learn),
            PanelRequest::ToggleTheme => self.layout.set_light(!self.layout.is_light()),
            PanelRequest::ToggleKeys => {
                // The palette would lie half over the list.
                self.palette = Palette::default();
                self.show_keys ^= true;
            }
            PanelRequest::TogglePalette => self.palette.toggle(),
            PanelRequest::ChooseFile(dialog) => self.palette.choose_file(dialog),
            PanelRequest::ShowGallery => self.open_gallery.is_open = true,
            PanelRequest::AskDefaults => self.defaults.ask(None),
            _ => self.docked.iter_mut().for_each(|(_, panel)| panel.on_request(request)),
        }
    }
}

/// Where the picture is, in points.
#[derive(Clone, Copy)]
pub(in crate::app) struct PictureArea {
    pub(in crate::app) rect: egui::Rect,
    /// The part of it that no handle between it and a panel covers.
    pub(in crate::app) free: egui::Rect,
}

/// Shows bars, panels and messages. Returns what is left for the picture.
pub(in crate::app) fn show(
    ui: &mut Ui,
    context: &Context<'_>,
    panels: &mut Panels,
    commands: &mut Commands,
) -> PictureArea {
    let whole = ui.max_rect();
    theme::choose(ui.ctx(), panels.layout.is_light());
    let has_room = whole.width() >= SMALLEST_WITH_PANELS.x && whole.height() >= SMALLEST_WITH_PANELS.y;
    let picture = if panels.visible && has_room {
        bars(ui, context, panels, &mut commands.list);
        let Panels { layout, docked, .. } = &mut *panels;
        let picture = layout.show(ui, &mut |ui, shown| {
            if let Some((_, panel)) = docked.iter_mut().find(|(panel, _)| *panel == shown) {
                panel.ui(ui, context, commands);
            }
        });
        PictureArea { rect: picture, free: layout.free_of_handles() }
    } else {
        PictureArea { rect: whole, free: whole }
    };
    let egui = ui.ctx();
    overlay::show(egui, context, &mut panels.overlay, panels.visible, picture.rect, commands);
    keys::show(egui, &mut panels.key_list, &mut panels.show_keys, !panels.palette.is_open());
    open_gallery::show(egui, context.state, &mut panels.open_gallery, &mut commands.list);
    palette::show(egui, context.state, &mut panels.palette, whole, &mut commands.list);
    parameters::defaults::show(egui, context.state, &mut panels.defaults, &mut commands.list);
    commands.sight.learn = panels.layout.is_in_sight(Panel::LEARN);
    commands.sight.has_own_arrangement = panels.layout.has_own();
    picture
}

/// The bars above and below the tiles.
fn bars(ui: &mut Ui, context: &Context<'_>, panels: &mut Panels, commands: &mut Vec<Command>) {
    let state = context.state;
    let Panels { layout, palette, show_keys, .. } = panels;
    top_bar::show(ui, (layout, palette, show_keys), state, commands);
    let status = status_bar::Status {
        shader: &state.shader,
        missing_textures: state.missing_textures(),
        waits: baking::long_wait(ui.ctx(), context),
        not_finite: state.shown_not_finite(),
        captures: &state.captures,
        checked: state.checks.newest().and_then(|result| result.as_ref().ok()).map(|checked| &**checked),
        progress: context.readings.baking.map(|(done, _)| *done),
        generation: context.shaders.generation,
        diagnostics: &state.session.diagnostics,
        frame_ms: state.timing.frame_ms(),
        stage: state.stages.main(),
        device: &state.device,
    };
    status_bar::show(ui, &status, commands);
}
