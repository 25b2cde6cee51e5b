//! Values that replace factors of single materials of the model.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::told;
use crate::message::did_you_mean;

/// Factors of one material that are replaced; the others are those of the file.
pub type MaterialValues = BTreeMap<Factor, FactorValue>;

/// A number or a color.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum FactorValue {
    /// One number.
    Number(f32),
    /// Linear RGB.
    Color([f32; 3]),
}

/// How a factor is shown and what it can be.
#[derive(Clone, Debug)]
pub struct FactorInfo {
    /// Name in its row.
    pub label: &'static str,
    /// Unit, with the space before it where it needs one; empty for pure numbers.
    pub unit: &'static str,
    /// Smallest and largest valid value, of each channel for a color.
    pub limits: RangeInclusive<f32>,
    /// Ends of its slider.
    pub slider: RangeInclusive<f32>,
    /// Whether it is a color.
    pub is_color: bool,
    /// Its meaning.
    pub doc: &'static str,
}

/// Declares [`Factor`] with the name of each variant in settings, and [`Factor::info`].
macro_rules! factors {
    ($($variant:ident $name:literal $label:literal $kind:ident $limits:expr, $slider:expr, $unit:literal, $doc:literal;)+) => {
        /// A factor of glTF's materials or of one of their extensions. Textures multiply it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Factor {
            $(#[doc = $doc] $variant,)+
        }

        impl Factor {
            /// All factors, in the order of their rows.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Its name in settings.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }

            /// How it is shown and what it can be.
            pub fn info(self) -> FactorInfo {
                match self {
                    $(Self::$variant => FactorInfo {
                        label: $label,
                        unit: $unit,
                        limits: $limits,
                        slider: $slider,
                        is_color: stringify!($kind) == "color",
                        doc: $doc,
                    },)+
                }
            }
        }
    };
}

factors! {
    BaseColor "base_color" "Base color" color 0.0..=1.0, 0.0..=1.0, "", "Reflectance of the diffuse lobe, or of a metal";
    Alpha "alpha" "Alpha" number 0.0..=1.0, 0.0..=1.0, "", "Coverage, for materials that are masked or blended";
    AlphaCutoff "alpha_cutoff" "Alpha cutoff" number 0.0..=1.0, 0.0..=1.0, "", "A masked surface is drawn where its alpha is at least this";
    Metallic "metallic" "Metallic" number 0.0..=1.0, 0.0..=1.0, "", "0 is a dielectric, 1 a metal";
    Roughness "roughness" "Roughness" number 0.0..=1.0, 0.0..=1.0, "", "Perceptual roughness; alpha is its square";
    NormalScale "normal_scale" "Normal scale" number -100.0..=100.0, 0.0..=4.0, "", "Factor on x and y of the normal texture";
    Occlusion "occlusion" "Occlusion" number 0.0..=1.0, 0.0..=1.0, "", "Strength of the occlusion texture";
    Emissive "emissive" "Emissive" color 0.0..=1.0, 0.0..=1.0, "", "Color of the emitted light";
    EmissiveStrength "emissive_strength" "Emission" number 0.0..=1e6, 0.0..=20.0, " cd/m²", "Factor on the emissive color (KHR_materials_emissive_strength)";
    Ior "ior" "IOR" number 1.0..=100.0, 1.0..=3.0, "", "Index of refraction of the dielectric (KHR_materials_ior): F0 = ((n - 1) / (n + 1))²";
    Specular "specular" "Specular" number 0.0..=1.0, 0.0..=1.0, "", "Weight of the dielectric's reflection (KHR_materials_specular)";
    SpecularColor "specular_color" "Specular color" color 0.0..=100.0, 0.0..=1.0, "", "Tint of the dielectric's F0 (KHR_materials_specular)";
    Clearcoat "clearcoat" "Clear coat" number 0.0..=1.0, 0.0..=1.0, "", "Weight of the clear coat (KHR_materials_clearcoat)";
    ClearcoatRoughness "clearcoat_roughness" "Coat roughness" number 0.0..=1.0, 0.0..=1.0, "", "Perceptual roughness of the clear coat";
    SheenColor "sheen_color" "Sheen color" color 0.0..=1.0, 0.0..=1.0, "", "Color of the layer of fibers (KHR_materials_sheen)";
    SheenRoughness "sheen_roughness" "Sheen roughness" number 0.0..=1.0, 0.0..=1.0, "", "Perceptual roughness of the sheen";
    Anisotropy "anisotropy" "Anisotropy" number 0.0..=1.0, 0.0..=1.0, "", "Strength of the anisotropy (KHR_materials_anisotropy)";
    AnisotropyRotation "anisotropy_rotation" "Direction" number -1e6..=1e6, -90.0..=90.0, "°", "Angle of the anisotropy from the tangent towards the bitangent";
    Iridescence "iridescence" "Iridescence" number 0.0..=1.0, 0.0..=1.0, "", "Weight of the thin film (KHR_materials_iridescence)";
    IridescenceIor "iridescence_ior" "Film IOR" number 1.0..=100.0, 1.0..=3.0, "", "Index of refraction of the thin film";
    IridescenceThickness "iridescence_thickness" "Film thickness" number 0.0..=1e5, 0.0..=1200.0, " nm", "Thickness of the film where its texture is 1, or missing";
    Transmission "transmission" "Transmission" number 0.0..=1.0, 0.0..=1.0, "", "Part of the light that passes through the surface (KHR_materials_transmission)";
    Thickness "thickness" "Thickness" number 0.0..=1e6, 0.0..=1.0, " m", "Thickness of the volume, in object space; 0 is a thin wall (KHR_materials_volume)";
    AttenuationColor "attenuation_color" "Attenuation" color 0.0..=1.0, 0.0..=1.0, "", "Color of white light after the attenuation distance";
    AttenuationDistance "attenuation_distance" "Att. distance" number 1e-6..=1e30, 0.01..=10.0, " m", "Distance after which white light has the attenuation color";
    Dispersion "dispersion" "Dispersion" number 0.0..=100.0, 0.0..=1.0, "", "20 / Abbe number (KHR_materials_dispersion)";
    DiffuseTransmission "diffuse_transmission" "Diffuse trans." number 0.0..=1.0, 0.0..=1.0, "", "Part of the light that leaves diffusely at the other side (KHR_materials_diffuse_transmission)";
    DiffuseTransmissionColor "diffuse_transmission_color" "Trans. color" color 0.0..=1.0, 0.0..=1.0, "", "Color of the diffusely transmitted light";
}

/// Checks the values of all materials.
///
/// # Errors
/// A number where a color belongs or the reverse, or a value beyond its limits.
pub(super) fn check(materials: &BTreeMap<String, MaterialValues>) -> Result<(), String> {
    for (material, values) in materials {
        for (factor, value) in values {
            let (path, info) = (path(material, *factor), factor.info());
            let range = told(&info.limits);
            let is_valid = |number: &f32| info.limits.contains(number);
            match value {
                FactorValue::Number(number) if info.is_color => {
                    return Err(format!("{path} is {number}; it takes 3 numbers, {range}"));
                }
                FactorValue::Color(_) if !info.is_color => return Err(format!("{path} takes one number, {range}")),
                FactorValue::Number(number) if !is_valid(number) => {
                    return Err(format!("{path} is {number}; it can be {range}"));
                }
                FactorValue::Color(color) if !color.iter().all(is_valid) => {
                    return Err(format!("{path} is {color:?}; each of its numbers can be {range}"));
                }
                _ => {}
            }
        }
    }
    Ok(())
}

/// The path of a factor for `--set`. The name of the material needs quotes only in a look file.
pub fn path(material: &str, factor: Factor) -> String {
    format!("materials.{material}.{}", factor.name())
}

/// The factor with this name.
///
/// # Errors
/// A message with the nearest name and all names.
pub(super) fn named(name: &str) -> Result<Factor, String> {
    Factor::ALL.iter().copied().find(|factor| factor.name() == name).ok_or_else(|| {
        let names = || Factor::ALL.iter().map(|factor| factor.name());
        let hint = did_you_mean(name, names());
        format!("a material has no factor `{name}`.{hint} It has {}", names().collect::<Vec<_>>().join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_files_are_those_of_the_enum() {
        for factor in Factor::ALL {
            let text = toml::Value::try_from(factor).unwrap();
            assert_eq!(text.as_str(), Some(factor.name()));
            assert_eq!(named(factor.name()), Ok(*factor));
            let info = factor.info();
            assert!(info.limits.contains(info.slider.start()) && info.limits.contains(info.slider.end()), "{factor:?}");
        }
    }
}
