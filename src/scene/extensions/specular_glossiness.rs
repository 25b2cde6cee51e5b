//! KHR_materials_pbrSpecularGlossiness: diffuse color, F0 and glossiness in place of metallic-roughness, whose fields they use.

use super::descriptor::{Extension, bit_if};
use crate::interface::{FEATURE_SPECULAR_GLOSSINESS, TEXTURE_BASE_COLOR, TEXTURE_METALLIC_ROUGHNESS};

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_pbrSpecularGlossiness",
    read: |reader| {
        reader.material.specular_glossiness = true;
        reader.material.numbers.base_color_factor = reader.unit_all("diffuseFactor", [1.0; 4])?;
        reader.material.numbers.specular_color = reader.unit_all("specularFactor", [1.0; 3])?;
        reader.material.numbers.roughness_factor = reader.unit("glossinessFactor", 1.0)?;
        reader.material.numbers.metallic_factor = 0.0;
        reader.texture("diffuseTexture", TEXTURE_BASE_COLOR);
        reader.texture("specularGlossinessTexture", TEXTURE_METALLIC_ROUGHNESS);
        Ok(())
    },
    features: |material, _| bit_if(FEATURE_SPECULAR_GLOSSINESS, material.specular_glossiness),
    factors: &[],
};
