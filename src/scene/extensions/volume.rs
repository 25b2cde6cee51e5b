//! KHR_materials_volume: the medium beneath the surface.

use super::descriptor::{Extension, bit_if, factor};
use super::{diffuse_transmission, transmission};
use crate::interface::{FEATURE_VOLUME, TEXTURE_THICKNESS};
use crate::scene::error::Problem;
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_volume",
    read: |reader| {
        let key = "attenuationDistance";
        let distance = match reader.fields.number(key, f32::INFINITY)? {
            distance if distance > 0.0 => Ok(distance),
            other => Err(Problem::invalid(reader.fields.at(key), "a distance above 0, in meters", other.to_string())),
        };
        reader.material.numbers.attenuation_distance = reader.or_default(key, distance, f32::INFINITY);
        reader.material.numbers.thickness = reader.at_least_0("thicknessFactor", 0.0)?;
        reader.material.numbers.attenuation_color = reader.unit_all("attenuationColor", [1.0; 3])?;
        reader.texture("thicknessTexture", TEXTURE_THICKNESS);
        Ok(())
    },
    features: |material, _| bit_if(FEATURE_VOLUME, is_seen(material)),
    factors: &[
        factor!(Thickness, thickness).used(is_used),
        factor!(AttenuationColor, attenuation_color).used(is_used),
        factor!(AttenuationDistance, attenuation_distance).used(is_used),
    ],
};

fn is_used(material: &Material) -> bool {
    material.numbers.thickness > 0.0
}

/// Whether the volume changes the picture: light enters it only by transmission.
pub(super) fn is_seen(material: &Material) -> bool {
    is_used(material) && (transmission::is_used(material) || diffuse_transmission::is_used(material))
}
