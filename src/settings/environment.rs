//! Settings of the environment.

use serde::{Deserialize, Serialize};

use super::declare::settings;
use super::entry::When;
use super::view::ViewSettings;

settings! {
    /// Settings of the environment.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct EnvironmentSettings {
        /// Environment map: studio, furnace, sky, an .hdr or .exr file, model (the environment that the model's file brings along), or none,
        /// which leaves the ambient light. A file may be dropped on the window.
        name: String = "studio".into(), row("Map");
        /// Rotation of the environment around +Y (Alt+drag in the window): a positive angle turns what is ahead (-Z) to the left (-X).
        rotation: f32 = 0.0, limits(-1e6, 1e6) unit(DEGREES) row("Rotation") slider(-180.0, 180.0, 0) when(LIT);
        /// Factor on the map, whose values are in cd/m².
        intensity: f32 = 1.0, limits(0.0, 1e6) unit(FACTOR) row("Intensity") slider(0.0, 8.0, 2) when(LIT);
        /// Suns of the map light the model as lamps do. Otherwise they are a part of the prefiltered light, which blurs their highlights.
        suns: bool = true, row("Suns") title("Suns of the map") when(LIT);
        /// Blur of the map behind the model, as a roughness: 0 is sharp.
        blur: f32 = 0.0, limits(0.0, 1.0) row("Blur") squared(0.0, 1.0, 2) when(All(&[LIT, Is("view.background", "env")]));
    }
}

/// An environment is selected.
const LIT: When = When::Not("environment.name", "none");

impl EnvironmentSettings {
    /// Whether an environment is selected.
    pub fn is_lit(&self) -> bool {
        self.name != "none"
    }

    /// Whether the environment is visible behind the model.
    pub fn is_shown(&self, view: &ViewSettings) -> bool {
        self.is_lit() && view.background == "env"
    }
}
