//! KHR_materials_dispersion: an index of refraction that depends on the wavelength.

use super::descriptor::{Extension, bit_if, factor};
use super::{transmission, volume};
use crate::interface::FEATURE_DISPERSION;
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_dispersion",
    read: |reader| {
        reader.material.numbers.dispersion = reader.at_least_0("dispersion", 0.0)?;
        Ok(())
    },
    features: |material, _| {
        // Diffusely transmitted light has no direction left, so dispersion is invisible in it.
        let is_seen = volume::is_seen(material) && transmission::is_used(material);
        bit_if(FEATURE_DISPERSION, is_seen && is_used(material))
    },
    factors: &[factor!(Dispersion, dispersion).used(is_used)],
};

fn is_used(material: &Material) -> bool {
    material.numbers.dispersion > 0.0
}
