//! Settings of the environment.

use serde::{Deserialize, Serialize};

use super::ViewSettings;

/// Settings of the environment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentSettings {
    /// A built-in name, a `.hdr` or `.exr` file, or `none`, which selects the uniform ambient light of
    /// `lights.ambient_*`.
    pub name: String,
    /// Degrees around +Y; a positive angle turns what is ahead (-Z) to the left (-X).
    pub rotation: f32,
    /// Factor on the environment's values, which are in cd/m^2.
    pub intensity: f32,
    /// Blur of the background: 0 sharp .. 1, as a roughness.
    pub blur: f32,
    /// Whether suns of the map light the model as lamps do. Otherwise they are a part of the prefiltered light.
    pub suns: bool,
}

impl Default for EnvironmentSettings {
    fn default() -> Self {
        Self { name: "studio".into(), rotation: 0.0, intensity: 1.0, blur: 0.0, suns: true }
    }
}

impl EnvironmentSettings {
    /// Whether an environment is selected.
    pub fn is_lit(&self) -> bool {
        self.name != "none"
    }

    /// Whether the environment is visible behind the model.
    pub fn is_shown(&self, view: &ViewSettings) -> bool {
        self.is_lit() && view.background == "env"
    }

    /// Path, value, smallest and largest value.
    pub(super) fn numbers(&self) -> [(&'static str, f32, f32, f32); 3] {
        [
            ("environment.rotation", self.rotation, -1e6, 1e6),
            ("environment.intensity", self.intensity, 0.0, 1e6),
            ("environment.blur", self.blur, 0.0, 1.0),
        ]
    }
}
