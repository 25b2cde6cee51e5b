//! KHR_materials_clearcoat: a thin dielectric layer over the material.

use super::descriptor::{Extension, bit_if, factor};
use crate::interface::{
    FEATURE_CLEARCOAT, FEATURE_CLEARCOAT_NORMAL, TEXTURE_CLEARCOAT, TEXTURE_CLEARCOAT_NORMAL,
    TEXTURE_CLEARCOAT_ROUGHNESS,
};
use crate::scene::material::Material;

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_clearcoat",
    read: |reader| {
        reader.material.numbers.clearcoat_factor = reader.unit("clearcoatFactor", 0.0)?;
        reader.material.numbers.clearcoat_roughness = reader.unit("clearcoatRoughnessFactor", 0.0)?;
        if let Ok(Some(normal)) = reader.fields.open_member("clearcoatNormalTexture") {
            reader.material.numbers.clearcoat_normal_scale = normal.number("scale", 1.0)?;
        }
        reader.texture("clearcoatTexture", TEXTURE_CLEARCOAT);
        reader.texture("clearcoatRoughnessTexture", TEXTURE_CLEARCOAT_ROUGHNESS);
        reader.texture("clearcoatNormalTexture", TEXTURE_CLEARCOAT_NORMAL);
        Ok(())
    },
    features: |material, has_frame| {
        let has_normals = has_frame && material.has(TEXTURE_CLEARCOAT_NORMAL);
        let normals = bit_if(FEATURE_CLEARCOAT_NORMAL, has_normals && is_used(material));
        bit_if(FEATURE_CLEARCOAT, is_used(material)) | normals
    },
    factors: &[
        factor!(Clearcoat, clearcoat_factor).used(is_used),
        factor!(ClearcoatRoughness, clearcoat_roughness).used(is_used),
    ],
};

fn is_used(material: &Material) -> bool {
    material.numbers.clearcoat_factor > 0.0
}
