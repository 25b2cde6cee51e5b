//! The properties of materials, and of all materials of a frame, that select pipelines.

use crate::gpu::PrimitiveClass;
use crate::interface;
use crate::settings::{LightSource, Settings};

/// The properties of a material and its primitive that select a pipeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialVariant {
    /// `interface::ALPHA_*`.
    pub alpha: u32,
    /// `interface::FEATURE_*` bits.
    pub features: u32,
    /// Kind of primitive.
    pub class: PrimitiveClass,
}

/// The placeholder for a material in the pipelines of quads.
pub(crate) const QUADS: MaterialVariant =
    MaterialVariant { alpha: interface::ALPHA_OPAQUE, features: 0, class: PrimitiveClass::Triangles };

/// The feature bits that all materials of a frame share.
pub(super) fn shared_features(settings: &Settings) -> u32 {
    let mut features = 0;
    if settings.environment.is_lit() {
        features |= interface::FEATURE_ENVIRONMENT;
    }
    if settings.lights.rect.enabled && settings.lights.source != LightSource::None {
        features |= interface::FEATURE_RECT_LIGHTS;
    }
    features
}
