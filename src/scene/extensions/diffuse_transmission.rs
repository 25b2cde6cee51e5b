//! KHR_materials_diffuse_transmission: light that passes through and leaves diffusely.

use super::descriptor::{Extension, bit_if, factor};
use crate::interface::{
    FEATURE_DIFFUSE_TRANSMISSION, TEXTURE_DIFFUSE_TRANSMISSION, TEXTURE_DIFFUSE_TRANSMISSION_COLOR,
};
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_diffuse_transmission",
    read: |reader| {
        reader.material.numbers.diffuse_transmission_factor = reader.unit("diffuseTransmissionFactor", 0.0)?;
        reader.material.numbers.diffuse_transmission_color =
            reader.unit_all("diffuseTransmissionColorFactor", [1.0; 3])?;
        reader.texture("diffuseTransmissionTexture", TEXTURE_DIFFUSE_TRANSMISSION);
        reader.texture("diffuseTransmissionColorTexture", TEXTURE_DIFFUSE_TRANSMISSION_COLOR);
        Ok(())
    },
    features: |material, _| bit_if(FEATURE_DIFFUSE_TRANSMISSION, is_used(material)),
    factors: &[
        factor!(DiffuseTransmission, diffuse_transmission_factor).used(is_used),
        factor!(DiffuseTransmissionColor, diffuse_transmission_color).used(is_used),
    ],
};

pub(super) fn is_used(material: &Material) -> bool {
    material.numbers.diffuse_transmission_factor > 0.0
}
