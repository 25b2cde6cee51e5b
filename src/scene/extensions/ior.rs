//! KHR_materials_ior: the index of refraction of the dielectric.

use super::descriptor::{Extension, LARGEST_IOR, factor};
use super::{specular, specular_glossiness, transmission};
use crate::scene::error::Problem;
use crate::scene::gltf::materials::reader::Reader;
use crate::scene::gltf::values;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_ior",
    read,
    features: |_, _| 0,
    factors: &[factor!(Ior, ior)
        .applies(|material| !material.specular_glossiness)
        .used(|material| material.numbers.ior != 1.5 || transmission::is_used(material))],
};

/// In KHR_materials_ior, 0 stands for an infinite index, whose Fresnel factor is 1. With a specular color, that color is the
/// whole reflectance, as in materials converted from specular-glossiness. Without, the material is a white mirror, as its file
/// says; that is rarely meant, so the warning says how to get another reflectance.
fn read(reader: &mut Reader<'_, '_>) -> Result<(), Problem> {
    let mut value = reader.fields.number("ior", 1.5)?;
    let place = reader.fields.at("ior");
    if value == 0.0 {
        let reflects = [specular::EXTENSION, specular_glossiness::EXTENSION].iter().any(|other| reader.has(other.name));
        let warning = if reflects {
            format!("{place} is 0, for infinity: the reflectance is 1 times the specular color.")
        } else {
            format!(
                "{place} is 0, for infinity: the material reflects all light. Glass has 1.5; {} gives another color.",
                specular::EXTENSION.name
            )
        };
        reader.collector.warnings.push(warning);
    } else {
        value = values::clamp(value, 1.0..=LARGEST_IOR, &place, &mut reader.collector.warnings);
    }
    reader.material.numbers.ior = value;
    Ok(())
}
