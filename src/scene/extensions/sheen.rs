//! KHR_materials_sheen: a layer of fibers.

use super::descriptor::{Extension, bit_if, factor};
use crate::interface::{FEATURE_SHEEN, TEXTURE_SHEEN_COLOR, TEXTURE_SHEEN_ROUGHNESS};
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_sheen",
    read: |reader| {
        reader.material.numbers.sheen_color = reader.unit_all("sheenColorFactor", [0.0; 3])?;
        reader.material.numbers.sheen_roughness = reader.unit("sheenRoughnessFactor", 0.0)?;
        reader.texture("sheenColorTexture", TEXTURE_SHEEN_COLOR);
        reader.texture("sheenRoughnessTexture", TEXTURE_SHEEN_ROUGHNESS);
        Ok(())
    },
    features: |material, _| bit_if(FEATURE_SHEEN, is_used(material)),
    factors: &[factor!(SheenColor, sheen_color).used(is_used), factor!(SheenRoughness, sheen_roughness).used(is_used)],
};

fn is_used(material: &Material) -> bool {
    material.numbers.sheen_color != [0.0; 3]
}
