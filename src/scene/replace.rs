//! Materials with other values than those of the file: the material override, and factors of single materials.

use super::extensions::{EXTENSIONS, Field as _, MaterialFactor, factor};
use super::material::{AlphaMode, Material};
use crate::interface::{TEXTURE_ANISOTROPY, TEXTURE_NORMAL, TEXTURE_OCCLUSION};
use crate::settings::{Factor, FactorValue, MaterialChannel, MaterialOverride, MaterialValues};

/// The material of the override: opaque, single-sided, without textures.
pub fn override_material(settings: &MaterialOverride) -> Material {
    let mut material = Material { name: "override".into(), ..Material::default() };
    let [r, g, b] = settings.base_color;
    material.numbers.base_color_factor = [r, g, b, 1.0];
    material.numbers.metallic_factor = settings.metallic;
    material.numbers.roughness_factor = settings.roughness;
    set_anisotropy(&mut material, settings);
    material
}

fn set_anisotropy(material: &mut Material, settings: &MaterialOverride) {
    let (sin, cos) = settings.anisotropy_rotation.to_radians().sin_cos();
    material.numbers.anisotropy_strength = settings.anisotropy;
    material.numbers.anisotropy_rotation = [cos, sin];
}

/// Replaces single channels of a material. The textures of these channels then read as 1.
pub fn replace_channels(material: &mut Material, settings: &MaterialOverride) {
    let is_replaced = |channel| settings.channels.has(channel);
    material.constant = settings.channels;
    if is_replaced(MaterialChannel::BaseColor) {
        material.numbers.base_color_factor[..3].copy_from_slice(&settings.base_color);
    }
    // Specular-glossiness has neither: its metals are materials with a bright specular color.
    if is_replaced(MaterialChannel::Metallic) && !material.specular_glossiness {
        material.numbers.metallic_factor = settings.metallic;
    }
    if is_replaced(MaterialChannel::Roughness) {
        material.numbers.roughness_factor = roughness(material, settings.roughness);
    }
    if is_replaced(MaterialChannel::Anisotropy) {
        set_anisotropy(material, settings);
        // The texture also holds the direction.
        material.textures[TEXTURE_ANISOTROPY as usize] = None;
    }
}

/// Replaces factors of a material.
pub fn replace_factors(material: &mut Material, values: &MaterialValues) {
    // The file has the product of both.
    let mut strength = emissive_strength(material);
    let mut color = emissive_color(material);
    for factor in material_factors() {
        match (factor.factor, values.get(&factor.factor)) {
            (Factor::Emissive, Some(value)) => color.store(*value),
            (Factor::EmissiveStrength, Some(value)) => strength.store(*value),
            (_, Some(value)) => (factor.set)(material, *value),
            (_, None) => {}
        }
    }
    material.numbers.emissive_factor = color.map(|channel| channel * strength);
}

/// All factors that a material can have, in the order of their rows.
pub fn material_factors() -> impl Iterator<Item = &'static MaterialFactor> {
    let all = || CORE.iter().chain(EXTENSIONS.iter().flat_map(|extension| extension.factors));
    Factor::ALL.iter().filter_map(move |factor| all().find(|known| known.factor == *factor))
}

/// The factors of glTF's own material, with the strength of its emission.
const CORE: &[MaterialFactor] = &[
    MaterialFactor::new(
        Factor::BaseColor,
        |material| FactorValue::Color(*material.numbers.base_color_factor.first_chunk().unwrap_or(&[0.0; 3])),
        |material, value| {
            if let FactorValue::Color(color) = value {
                material.numbers.base_color_factor[..3].copy_from_slice(&color);
            }
        },
    ),
    factor!(Alpha, base_color_factor[3]).applies(|material| material.alpha_mode != AlphaMode::Opaque),
    factor!(AlphaCutoff, alpha_cutoff).applies(|material| material.alpha_mode == AlphaMode::Mask),
    factor!(Metallic, metallic_factor).applies(|material| !material.specular_glossiness),
    MaterialFactor::new(
        Factor::Roughness,
        |material| roughness(material, material.numbers.roughness_factor).value(),
        |material, value| {
            if let FactorValue::Number(number) = value {
                material.numbers.roughness_factor = roughness(material, number);
            }
        },
    ),
    factor!(NormalScale, normal_scale).applies(|material| material.has(TEXTURE_NORMAL)),
    factor!(Occlusion, occlusion_strength).applies(|material| material.has(TEXTURE_OCCLUSION)),
    // `replace_factors` sets the product of both.
    MaterialFactor::new(Factor::Emissive, |material| emissive_color(material).value(), |_, _| {}),
    MaterialFactor::new(Factor::EmissiveStrength, |material| emissive_strength(material).value(), |_, _| {})
        .used(|material| material.numbers.emissive_factor != [0.0; 3]),
];

/// Roughness from what a material stores, and the reverse: with specular-glossiness, that is 1 - roughness.
fn roughness(material: &Material, stored: f32) -> f32 {
    if material.specular_glossiness { 1.0 - stored } else { stored }
}

/// The part of the emissive factor that is not its color, 0..1: KHR_materials_emissive_strength, where it is above 1.
fn emissive_strength(material: &Material) -> f32 {
    material.numbers.emissive_factor.into_iter().fold(1.0, f32::max)
}

fn emissive_color(material: &Material) -> [f32; 3] {
    material.numbers.emissive_factor.map(|channel| channel / emissive_strength(material))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_factor_is_in_the_material() {
        assert!(material_factors().map(|known| &known.factor).eq(Factor::ALL));
    }

    #[test]
    fn every_factor_can_be_replaced_and_is_read_back() {
        for glossy in [false, true] {
            for wanted in Factor::ALL {
                let mut material = Material { specular_glossiness: glossy, ..Material::default() };
                material.numbers.emissive_factor = [0.0, 4.0, 2.0];
                let before = material.clone();
                let value = match wanted.is_color() {
                    true => FactorValue::Color([0.25, 1.0, 0.75]),
                    false => FactorValue::Number(if *wanted == Factor::AnisotropyRotation { 90.0 } else { 2.5 }),
                };
                replace_factors(&mut material, &MaterialValues::from([(*wanted, value)]));
                for known in material_factors() {
                    let expected = if known.factor == *wanted { value } else { (known.get)(&before) };
                    assert_eq!((known.get)(&material), expected, "{:?} after {wanted:?}", known.factor);
                }
            }
        }
    }

    #[test]
    fn a_replaced_channel_has_no_texture() {
        let mut settings = MaterialOverride { roughness: 0.25, metallic: 0.5, ..MaterialOverride::default() };
        settings.channels.set(MaterialChannel::Roughness, true);
        let mut material = Material::default();
        replace_channels(&mut material, &settings);
        let numbers = &material.numbers;
        assert_eq!((numbers.roughness_factor, numbers.metallic_factor), (0.25, 1.0));
        assert!(material.constant.has(MaterialChannel::Roughness) && !material.constant.has(MaterialChannel::Metallic));
        let mut glossy = Material { specular_glossiness: true, ..Material::default() };
        replace_channels(&mut glossy, &settings);
        assert_eq!(glossy.numbers.roughness_factor, 0.75);
    }
}
