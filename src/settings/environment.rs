//! Light from all around.

use serde::{Deserialize, Serialize};

use super::ViewSettings;

/// The environment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentSettings {
    /// A built-in name, a `.hdr` or `.exr` file, or `none`: then the flat ambient light of `lights.ambient_*` shines.
    pub name: String,
    /// Degrees around +Y; a positive angle turns what lay ahead (-Z) to the left (-X).
    pub rotation: f32,
    /// Factor on its radiance.
    pub intensity: f32,
    /// Blur where it is seen behind the model: 0 sharp .. 1, as a roughness.
    pub blur: f32,
}

impl Default for EnvironmentSettings {
    fn default() -> Self {
        Self { name: "studio".into(), rotation: 0.0, intensity: 1.0, blur: 0.0 }
    }
}

impl EnvironmentSettings {
    /// Whether there is one.
    pub fn is_lit(&self) -> bool {
        self.name != "none"
    }

    /// Whether it is seen behind the model.
    pub fn is_shown(&self, view: &ViewSettings) -> bool {
        self.is_lit() && view.background == "env"
    }

    /// Name, value, and what the value can be.
    pub(super) fn numbers(&self) -> [(&'static str, f32, f32, f32); 3] {
        [
            ("environment.rotation", self.rotation, -1e6, 1e6),
            ("environment.intensity", self.intensity, 0.0, 1e6),
            ("environment.blur", self.blur, 0.0, 1.0),
        ]
    }
}
