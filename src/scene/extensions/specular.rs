//! KHR_materials_specular: weight and tint of the dielectric's reflection.

use super::descriptor::{Extension, bit_if, factor};
use super::specular_glossiness;
use crate::interface::{FEATURE_SPECULAR, TEXTURE_SPECULAR, TEXTURE_SPECULAR_COLOR};
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_specular",
    read: |reader| {
        if reader.material.specular_glossiness {
            let (place, other) = (&reader.fields.place, specular_glossiness::EXTENSION.name);
            let warning = format!("{place} is ignored: the material has {other}, which gives F0 itself.");
            reader.collector.warnings.push(warning);
            return Ok(());
        }
        reader.material.numbers.specular_factor = reader.unit("specularFactor", 1.0)?;
        reader.material.numbers.specular_color = reader.all_at_least_0("specularColorFactor", [1.0; 3])?;
        reader.texture("specularTexture", TEXTURE_SPECULAR);
        reader.texture("specularColorTexture", TEXTURE_SPECULAR_COLOR);
        Ok(())
    },
    features: |material, _| {
        let has_texture = material.has(TEXTURE_SPECULAR) || material.has(TEXTURE_SPECULAR_COLOR);
        bit_if(FEATURE_SPECULAR, !material.specular_glossiness && (has_texture || is_used(material)))
    },
    factors: &[
        factor!(Specular, specular_factor).applies(|material| !material.specular_glossiness).used(is_used),
        factor!(SpecularColor, specular_color).used(is_used),
    ],
};

fn is_used(material: &Material) -> bool {
    material.numbers.specular_factor != 1.0 || material.numbers.specular_color != [1.0; 3]
}
