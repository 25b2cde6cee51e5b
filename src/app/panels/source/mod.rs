//! The panel Source: a file of the shader tree with the values that its statements have at the pinned pixel, now and before the last edit.

mod code;
mod find;
mod head;
mod hover;
mod model;
mod row;
mod scroll;
#[cfg(test)]
mod tests;

use egui::{RichText, Ui};

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::arrangement::Panel;
use crate::app::widgets::theme::QUIET;
use find::Find;
use model::CodeModel;
use scroll::Scroll;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new(Panel::SOURCE.0, Group::Shaders, "code values trace statements debugger editor lines", || {
        Box::<SourceState>::default()
    })
    .opens_on_request()
    .below_picture()
    .scrolls_itself();

/// State of the panel between frames.
#[derive(Default)]
struct SourceState {
    model: CodeModel,
    find: Find,
    scroll: Scroll,
}

impl PanelUi for SourceState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        commands.sight.source = true;
        let state = context.state;
        let Some(shaders) = &state.session.shaders else {
            ui.label(RichText::new("Compiling shaders…").small().color(QUIET));
            return;
        };
        self.model.update(state, shaders);
        self.find.take_keys(ui);
        head::show(ui, state, shaders, &self.model, &mut self.scroll, commands);
        self.find.show(ui, &self.model, &mut self.scroll);
        code::show(ui, state, &self.model, &self.find, &mut self.scroll, commands);
    }
}
