//! The form of a panel.

use egui::Ui;

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::recovery::TypedText;

/// A panel in a tile. It owns what it needs between frames, and changes nothing else but by commands.
pub(in crate::app) trait PanelUi {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands);

    /// Takes what the rest of the window asks panels for.
    fn on_request(&mut self, _: &PanelRequest) {}

    /// The texts that were typed and not saved, which closing the window would lose.
    fn unsaved(&self) -> Vec<TypedText> {
        Vec::new()
    }
}

/// A panel that keeps nothing between frames.
impl<F: FnMut(&mut Ui, &Context<'_>, &mut Commands)> PanelUi for F {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        self(ui, context, commands);
    }
}

/// Panels of a group share a tile at first.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::app) enum Group {
    /// Modes and the parts of the model.
    Modes,
    /// The shaders, their versions and times.
    Shaders,
    /// Parameters, passes and values of a pixel.
    Parameters,
    /// Light, output and camera.
    Settings,
}

/// All that menu, palette, arrangements and tiles know of a panel.
pub(super) struct PanelSpec {
    pub(super) panel: Panel,
    pub(super) group: Group,
    pub(super) words: &'static str,
    pub(super) make: fn() -> Box<dyn PanelUi>,
    pub(super) is_in_presets: bool,
    pub(super) scrolls_itself: bool,
    pub(super) is_below_picture: bool,
}

impl PanelSpec {
    /// `words` are keywords for the search, and `make` makes the panel for a new window.
    pub(super) const fn new(
        title: &'static str,
        group: Group,
        words: &'static str,
        make: fn() -> Box<dyn PanelUi>,
    ) -> Self {
        Self {
            panel: Panel(title),
            group,
            words,
            make,
            is_in_presets: true,
            scrolls_itself: false,
            is_below_picture: false,
        }
    }

    /// No preset opens the panel.
    pub(super) const fn opens_on_request(mut self) -> Self {
        self.is_in_presets = false;
        self
    }

    /// The panel opens below the picture instead of beside panels of its group.
    pub(super) const fn below_picture(mut self) -> Self {
        self.is_below_picture = true;
        self
    }

    /// The panel has rows above its list, or may run from left to right, so its tile does not scroll it.
    pub(super) const fn scrolls_itself(mut self) -> Self {
        self.scrolls_itself = true;
        self
    }
}
