//! KHR_materials_anisotropy: highlights stretched along the tangent.

use super::descriptor::{Extension, MaterialFactor, bit_if, factor};
use crate::interface::{FEATURE_ANISOTROPY, TEXTURE_ANISOTROPY};
use crate::scene::material::Material;
use crate::settings::{Factor, FactorValue};

/// Its descriptor.
pub const EXTENSION: Extension = Extension {
    name: "KHR_materials_anisotropy",
    read: |reader| {
        let (sin, cos) = reader.fields.number("anisotropyRotation", 0.0)?.sin_cos();
        reader.material.numbers.anisotropy_strength = reader.unit("anisotropyStrength", 0.0)?;
        reader.material.numbers.anisotropy_rotation = [cos, sin];
        reader.texture("anisotropyTexture", TEXTURE_ANISOTROPY);
        Ok(())
    },
    features: |material, _| bit_if(FEATURE_ANISOTROPY, is_used(material)),
    factors: &[
        factor!(Anisotropy, anisotropy_strength).used(is_used),
        MaterialFactor::new(
            Factor::AnisotropyRotation,
            |material| {
                let [cos, sin] = material.numbers.anisotropy_rotation;
                FactorValue::Number(sin.atan2(cos).to_degrees())
            },
            |material, value| {
                if let FactorValue::Number(degrees) = value {
                    let (sin, cos) = degrees.to_radians().sin_cos();
                    material.numbers.anisotropy_rotation = [cos, sin];
                }
            },
        )
        .used(is_used),
    ],
};

fn is_used(material: &Material) -> bool {
    material.numbers.anisotropy_strength > 0.0
}
