//! The form of a panel.

use egui::Ui;

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::state::workspace::PanelRequest;

/// A panel in a tile. It owns what it needs between frames, and changes nothing else but by commands.
pub(in crate::app) trait PanelUi {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands);

    /// Takes what the rest of the window asks panels for.
    fn on_request(&mut self, _: &PanelRequest) {}
}

/// A panel that keeps nothing between frames.
impl<F: FnMut(&mut Ui, &Context<'_>, &mut Commands)> PanelUi for F {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        self(ui, context, commands);
    }
}
