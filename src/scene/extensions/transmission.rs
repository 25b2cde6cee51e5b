//! KHR_materials_transmission: light that passes through the surface.

use super::descriptor::{Extension, bit_if, factor};
use crate::interface::{FEATURE_TRANSMISSION, TEXTURE_TRANSMISSION};
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_transmission",
    read: |reader| {
        reader.material.numbers.transmission_factor = reader.unit("transmissionFactor", 0.0)?;
        reader.texture("transmissionTexture", TEXTURE_TRANSMISSION);
        Ok(())
    },
    features: |material, _| bit_if(FEATURE_TRANSMISSION, is_used(material)),
    factors: &[factor!(Transmission, transmission_factor).used(is_used)],
};

pub(super) fn is_used(material: &Material) -> bool {
    material.numbers.transmission_factor > 0.0
}
