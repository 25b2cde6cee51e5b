//! Features and limits that the author's hooks add to the pipelines of a picture.

use super::{MaterialVariant, PipelineRequest};
use crate::interface;

impl PipelineRequest {
    /// The `FEATURE_*` bits of a material in this frame, without those of the frame itself.
    pub(super) fn features(&self, material: MaterialVariant) -> u32 {
        let is_unlit = material.features & interface::FEATURE_UNLIT != 0;
        material.features | if is_unlit { 0 } else { self.hook_features }
    }

    /// Whether a material shows what lies behind it.
    pub(crate) fn is_transmissive(&self, material: MaterialVariant) -> bool {
        self.features(material) & interface::FEATURE_TRANSMISSION != 0
    }

    /// Whether any material does.
    pub(crate) fn has_transmission(&self) -> bool {
        self.materials.iter().any(|material| self.is_transmissive(*material))
    }

    /// A sentence about what the mode ignores; `None` if it ignores nothing.
    pub fn limit(&self) -> Option<&'static str> {
        let is_other_mesh = self.traces && self.moves_vertices;
        is_other_mesh
            .then_some("the paths trace the mesh as it was loaded: the shaders move its vertices in the picture only")
    }
}
