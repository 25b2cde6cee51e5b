//! The material override.

use serde::{Deserialize, Serialize};

use super::Range;

/// A material without textures that replaces all materials of the model while it is enabled, to inspect shapes and the
/// BRDF itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialOverride {
    /// Whether it replaces the model's materials.
    pub enabled: bool,
    /// Linear RGB.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0..1.
    pub roughness: f32,
    /// Anisotropy strength, 0..1. Needs meshes with tangents or texture coordinates.
    pub anisotropy: f32,
    /// Degrees from the tangent towards the bitangent.
    pub anisotropy_rotation: f32,
}

impl Default for MaterialOverride {
    fn default() -> Self {
        Self {
            enabled: false,
            base_color: [0.8; 3],
            metallic: 0.0,
            roughness: 0.5,
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
        }
    }
}

impl MaterialOverride {
    /// All numbers with their paths and limits.
    pub(super) fn ranges(&self) -> Vec<Range> {
        let mut ranges = Range::all("material.base_color", &self.base_color, 0.0..=1.0);
        ranges.extend([
            Range::new("material.metallic", self.metallic, 0.0..=1.0),
            Range::new("material.roughness", self.roughness, 0.0..=1.0),
            Range::new("material.anisotropy", self.anisotropy, 0.0..=1.0),
            Range::new("material.anisotropy_rotation", self.anisotropy_rotation, -1e6..=1e6),
        ]);
        ranges
    }
}
