//! Materials with other values than those of the file: the material override, and factors of single materials.

use glam::Vec3;

use super::material::{Anisotropy, Material};
use crate::interface::TEXTURE_ANISOTROPY;
use crate::settings::{Factor, FactorValue, MaterialChannel, MaterialOverride, MaterialValues};

/// The material of the override: opaque, single-sided, without textures.
pub fn override_material(settings: &MaterialOverride) -> Material {
    Material {
        name: "override".into(),
        base_color_factor: Vec3::from(settings.base_color).extend(1.0),
        metallic_factor: settings.metallic,
        roughness_factor: settings.roughness,
        anisotropy: Anisotropy { strength: settings.anisotropy, rotation: settings.anisotropy_rotation.to_radians() },
        ..Material::default()
    }
}

/// Replaces single channels of a material. The textures of these channels then read as 1.
pub fn replace_channels(material: &mut Material, settings: &MaterialOverride) {
    let is_replaced = |channel| settings.channels.has(channel);
    material.constant = settings.channels;
    if is_replaced(MaterialChannel::BaseColor) {
        material.base_color_factor = Vec3::from(settings.base_color).extend(material.base_color_factor.w);
    }
    // Specular-glossiness has neither: its metals are materials with a bright specular color.
    if is_replaced(MaterialChannel::Metallic) && !material.specular_glossiness {
        material.metallic_factor = settings.metallic;
    }
    if is_replaced(MaterialChannel::Roughness) {
        let glossiness = 1.0 - settings.roughness;
        material.roughness_factor = if material.specular_glossiness { glossiness } else { settings.roughness };
    }
    if is_replaced(MaterialChannel::Anisotropy) {
        let rotation = settings.anisotropy_rotation.to_radians();
        material.anisotropy = Anisotropy { strength: settings.anisotropy, rotation };
        // The texture also holds the direction.
        material.textures[TEXTURE_ANISOTROPY as usize] = None;
    }
}

/// Replaces factors of a material.
pub fn replace_factors(material: &mut Material, values: &MaterialValues) {
    let strength = emissive_strength(material);
    let color = material.emissive_factor / strength;
    for (factor, value) in values {
        match value {
            FactorValue::Number(number) => set_number(material, *factor, *number),
            FactorValue::Color(color) => set_color(material, *factor, Vec3::from(*color)),
        }
    }
    // The file has the product of both.
    let color = match values.get(&Factor::Emissive) {
        Some(FactorValue::Color(color)) => Vec3::from(*color),
        _ => color,
    };
    let strength = match values.get(&Factor::EmissiveStrength) {
        Some(FactorValue::Number(strength)) => *strength,
        _ => strength,
    };
    material.emissive_factor = color * strength;
}

/// The value of a factor.
pub fn factor(material: &Material, factor: Factor) -> FactorValue {
    use FactorValue::{Color, Number};
    let color = |color: Vec3| Color(color.to_array());
    match factor {
        Factor::BaseColor => color(material.base_color_factor.truncate()),
        Factor::Alpha => Number(material.base_color_factor.w),
        Factor::AlphaCutoff => Number(material.alpha_cutoff),
        Factor::Metallic => Number(material.metallic_factor),
        Factor::Roughness if material.specular_glossiness => Number(1.0 - material.roughness_factor),
        Factor::Roughness => Number(material.roughness_factor),
        Factor::NormalScale => Number(material.normal_scale),
        Factor::Occlusion => Number(material.occlusion_strength),
        Factor::Emissive => color(material.emissive_factor / emissive_strength(material)),
        Factor::EmissiveStrength => Number(emissive_strength(material)),
        Factor::Ior => Number(material.ior),
        Factor::Specular => Number(material.specular.factor),
        Factor::SpecularColor => color(material.specular.color),
        Factor::Clearcoat => Number(material.clearcoat.factor),
        Factor::ClearcoatRoughness => Number(material.clearcoat.roughness),
        Factor::SheenColor => color(material.sheen.color),
        Factor::SheenRoughness => Number(material.sheen.roughness),
        Factor::Anisotropy => Number(material.anisotropy.strength),
        Factor::AnisotropyRotation => Number(material.anisotropy.rotation.to_degrees()),
        Factor::Iridescence => Number(material.iridescence.factor),
        Factor::IridescenceIor => Number(material.iridescence.ior),
        Factor::IridescenceThickness => Number(material.iridescence.thickness_max_nm),
        Factor::Transmission => Number(material.transmission_factor),
        Factor::Thickness => Number(material.volume.thickness),
        Factor::AttenuationColor => color(material.volume.attenuation_color),
        Factor::AttenuationDistance => Number(material.volume.attenuation_distance),
        Factor::Dispersion => Number(material.dispersion),
        Factor::DiffuseTransmission => Number(material.diffuse_transmission.factor),
        Factor::DiffuseTransmissionColor => color(material.diffuse_transmission.color),
    }
}

fn set_number(material: &mut Material, factor: Factor, number: f32) {
    let place = match factor {
        Factor::Alpha => &mut material.base_color_factor.w,
        Factor::AlphaCutoff => &mut material.alpha_cutoff,
        Factor::Metallic => &mut material.metallic_factor,
        Factor::Roughness if material.specular_glossiness => {
            material.roughness_factor = 1.0 - number;
            return;
        }
        Factor::Roughness => &mut material.roughness_factor,
        Factor::NormalScale => &mut material.normal_scale,
        Factor::Occlusion => &mut material.occlusion_strength,
        Factor::Ior => &mut material.ior,
        Factor::Specular => &mut material.specular.factor,
        Factor::Clearcoat => &mut material.clearcoat.factor,
        Factor::ClearcoatRoughness => &mut material.clearcoat.roughness,
        Factor::SheenRoughness => &mut material.sheen.roughness,
        Factor::Anisotropy => &mut material.anisotropy.strength,
        Factor::AnisotropyRotation => {
            material.anisotropy.rotation = number.to_radians();
            return;
        }
        Factor::Iridescence => &mut material.iridescence.factor,
        Factor::IridescenceIor => &mut material.iridescence.ior,
        Factor::IridescenceThickness => &mut material.iridescence.thickness_max_nm,
        Factor::Transmission => &mut material.transmission_factor,
        Factor::Thickness => &mut material.volume.thickness,
        Factor::AttenuationDistance => &mut material.volume.attenuation_distance,
        Factor::Dispersion => &mut material.dispersion,
        Factor::DiffuseTransmission => &mut material.diffuse_transmission.factor,
        Factor::BaseColor
        | Factor::Emissive
        | Factor::EmissiveStrength
        | Factor::SpecularColor
        | Factor::SheenColor
        | Factor::AttenuationColor
        | Factor::DiffuseTransmissionColor => return,
    };
    *place = number;
}

fn set_color(material: &mut Material, factor: Factor, color: Vec3) {
    match factor {
        Factor::BaseColor => material.base_color_factor = color.extend(material.base_color_factor.w),
        Factor::SpecularColor => material.specular.color = color,
        Factor::SheenColor => material.sheen.color = color,
        Factor::AttenuationColor => material.volume.attenuation_color = color,
        Factor::DiffuseTransmissionColor => material.diffuse_transmission.color = color,
        _ => {}
    }
}

/// The part of the emissive factor that is not its color, 0..1: KHR_materials_emissive_strength, where it is above 1.
fn emissive_strength(material: &Material) -> f32 {
    material.emissive_factor.max_element().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_factor_can_be_replaced_and_is_read_back() {
        for glossy in [false, true] {
            for wanted in Factor::ALL {
                let mut material = Material {
                    specular_glossiness: glossy,
                    emissive_factor: Vec3::new(0.0, 4.0, 2.0),
                    ..Material::default()
                };
                let before = material.clone();
                let value = match wanted.is_color() {
                    true => FactorValue::Color([0.25, 1.0, 0.75]),
                    false => FactorValue::Number(if *wanted == Factor::AnisotropyRotation { 90.0 } else { 2.5 }),
                };
                replace_factors(&mut material, &MaterialValues::from([(*wanted, value)]));
                assert_eq!(factor(&material, *wanted), value, "{wanted:?}");
                for other in Factor::ALL.iter().filter(|other| *other != wanted) {
                    assert_eq!(factor(&material, *other), factor(&before, *other), "{wanted:?} changes {other:?}");
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
        assert_eq!((material.roughness_factor, material.metallic_factor), (0.25, 1.0));
        assert!(material.constant.has(MaterialChannel::Roughness) && !material.constant.has(MaterialChannel::Metallic));
        let mut glossy = Material { specular_glossiness: true, ..Material::default() };
        replace_channels(&mut glossy, &settings);
        assert_eq!(glossy.roughness_factor, 0.75);
    }
}
