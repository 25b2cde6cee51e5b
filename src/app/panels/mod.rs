//! Bars, panels and messages around and over the picture. Each panel has a file of its own and receives only
//! what it shows and sets. `crate::app::layout` arranges them; `all` shows them.

pub(super) mod all;
mod animation;
mod baking;
mod beside;
mod camera;
mod capture;
mod clock;
mod draft;
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
mod panel_ui;
pub(super) mod parameters;
pub(super) mod passes;
pub(super) mod scene;
mod shaders;
mod source;
mod status_bar;
#[cfg(test)]
mod tests;
pub(super) mod texture;
pub(super) mod timeline;
mod timing;
mod top_bar;

use serde::{Deserialize, Deserializer, de::Error};

use super::state::arrangement::Panel;
use panel_ui::{Group, PanelSpec};

/// All panels that can be closed, in the order of the menu. Those of a group share a tile at first.
static PANELS: &[&PanelSpec] = &[
    &modes::PANEL,
    &scene::PANEL,
    &model::PANEL,
    &texture::PANEL,
    &learn::PANEL,
    &shaders::PANEL,
    &source::PANEL,
    &timeline::PANEL,
    &timing::PANEL,
    &expression::PANEL,
    &parameters::PANEL,
    &passes::PANEL,
    &inspector::PANEL,
    &environment::PANEL,
    &lights::PANEL,
    &output::PANEL,
    &camera::PANEL,
    &capture::PANEL,
];

impl Panel {
    /// All panels that can be closed, by their groups.
    pub(in crate::app) fn groups() -> [Vec<Self>; 4] {
        [Group::Modes, Group::Shaders, Group::Parameters, Group::Settings]
            .map(|group| PANELS.iter().filter(|spec| spec.group == group).map(|spec| spec.panel).collect())
    }

    fn spec(self) -> Option<&'static PanelSpec> {
        PANELS.iter().find(|spec| spec.panel == self).copied()
    }

    /// Whether a preset opens the panel. The others open on request.
    pub(in crate::app) fn is_in_presets(self) -> bool {
        self.spec().is_some_and(|spec| spec.is_in_presets)
    }

    /// Whether its tile leaves scrolling to the panel.
    pub(in crate::app) fn scrolls_itself(self) -> bool {
        self.spec().is_some_and(|spec| spec.scrolls_itself)
    }

    /// Whether it opens below the picture, where there is room for long lines.
    pub(in crate::app) fn is_below_picture(self) -> bool {
        self.spec().is_some_and(|spec| spec.is_below_picture)
    }

    /// Keywords for the search.
    pub(in crate::app) fn words(self) -> &'static str {
        self.spec().map_or("", |spec| spec.words)
    }
}

/// A stored arrangement that names an unknown panel is of another version.
impl<'de> Deserialize<'de> for Panel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let title = String::deserialize(deserializer)?;
        let mut all = PANELS.iter().map(|spec| spec.panel).chain([Self::VIEWPORT]);
        all.find(|panel| panel.0 == title).ok_or_else(|| D::Error::custom(format!("there is no panel {title}")))
    }
}
