//! Values that replace factors of single materials of the model.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::entry::Entry;
use super::entry::unit::{DEGREES, LINEAR_RGB, LUMINANCE, METERS, NANOMETERS};
use super::value::Value;
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

/// Declares [`Factor`] with the name of each variant in settings, and [`Factor::entry`].
macro_rules! factors {
    ($($(#[doc = $doc:literal])+ $variant:ident $name:ident: $kind:ident, $($option:ident($($argument:tt)*))+;)+) => {
        /// A factor of glTF's materials or of one of their extensions. Textures multiply it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Factor {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Factor {
            /// All factors, in the order of their rows.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Its name in settings.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($name),)+
                }
            }

            /// Whether it is a color.
            pub fn is_color(self) -> bool {
                match self {
                    $(Self::$variant => stringify!($kind) == "color",)+
                }
            }

            /// How it is shown and what it can be.
            pub fn entry(self) -> &'static Entry {
                match self {
                    $(Self::$variant => {
                        static ENTRY: Entry = Entry::new(concat!($($doc),+))$(.$option($($argument)*))+;
                        &ENTRY
                    })+
                }
            }
        }
    };
}

factors! {
    /// Reflectance of the diffuse lobe, or of a metal.
    BaseColor base_color: color, limits(0.0, 1.0) unit(LINEAR_RGB) row("Base color");
    /// Coverage, for materials that are masked or blended.
    Alpha alpha: number, limits(0.0, 1.0) row("Alpha") slider(0.0, 1.0, 2);
    /// A masked surface is drawn where its alpha is at least this.
    AlphaCutoff alpha_cutoff: number, limits(0.0, 1.0) row("Alpha cutoff") slider(0.0, 1.0, 2);
    /// 0 is a dielectric, 1 a metal.
    Metallic metallic: number, limits(0.0, 1.0) row("Metallic") slider(0.0, 1.0, 2);
    /// Perceptual roughness; alpha is its square.
    Roughness roughness: number, limits(0.0, 1.0) row("Roughness") slider(0.0, 1.0, 2);
    /// Factor on x and y of the normal texture.
    NormalScale normal_scale: number, limits(-100.0, 100.0) row("Normal scale") slider(0.0, 4.0, 2);
    /// Strength of the occlusion texture.
    Occlusion occlusion: number, limits(0.0, 1.0) row("Occlusion") slider(0.0, 1.0, 2);
    /// Color of the emitted light.
    Emissive emissive: color, limits(0.0, 1.0) unit(LINEAR_RGB) row("Emissive");
    /// Factor on the emissive color (KHR_materials_emissive_strength).
    EmissiveStrength emissive_strength: number, limits(0.0, 1e6) unit(LUMINANCE) row("Emission") slider(0.0, 20.0, 2);
    /// Index of refraction of the dielectric (KHR_materials_ior): F0 = ((n - 1) / (n + 1))².
    Ior ior: number, limits(1.0, 100.0) row("IOR") slider(1.0, 3.0, 2);
    /// Weight of the dielectric's reflection (KHR_materials_specular).
    Specular specular: number, limits(0.0, 1.0) row("Specular") slider(0.0, 1.0, 2);
    /// Tint of the dielectric's F0 (KHR_materials_specular).
    SpecularColor specular_color: color, limits(0.0, 100.0) unit(LINEAR_RGB) row("Specular color");
    /// Weight of the clear coat (KHR_materials_clearcoat).
    Clearcoat clearcoat: number, limits(0.0, 1.0) row("Clear coat") slider(0.0, 1.0, 2);
    /// Perceptual roughness of the clear coat.
    ClearcoatRoughness clearcoat_roughness: number, limits(0.0, 1.0) row("Coat roughness") slider(0.0, 1.0, 2);
    /// Color of the layer of fibers (KHR_materials_sheen).
    SheenColor sheen_color: color, limits(0.0, 1.0) unit(LINEAR_RGB) row("Sheen color");
    /// Perceptual roughness of the sheen.
    SheenRoughness sheen_roughness: number, limits(0.0, 1.0) row("Sheen roughness") slider(0.0, 1.0, 2);
    /// Strength of the anisotropy (KHR_materials_anisotropy).
    Anisotropy anisotropy: number, limits(0.0, 1.0) row("Anisotropy") slider(0.0, 1.0, 2);
    /// Angle of the anisotropy from the tangent towards the bitangent.
    AnisotropyRotation anisotropy_rotation: number, limits(-1e6, 1e6) unit(DEGREES) row("Direction") slider(-90.0, 90.0, 0);
    /// Weight of the thin film (KHR_materials_iridescence).
    Iridescence iridescence: number, limits(0.0, 1.0) row("Iridescence") slider(0.0, 1.0, 2);
    /// Index of refraction of the thin film.
    IridescenceIor iridescence_ior: number, limits(1.0, 100.0) row("Film IOR") slider(1.0, 3.0, 2);
    /// Thickness of the film where its texture is 1, or missing.
    IridescenceThickness iridescence_thickness: number, limits(0.0, 1e5) unit(NANOMETERS) row("Film thickness") slider(0.0, 1200.0, 0);
    /// Part of the light that passes through the surface (KHR_materials_transmission).
    Transmission transmission: number, limits(0.0, 1.0) row("Transmission") slider(0.0, 1.0, 2);
    /// Thickness of the volume, in object space; 0 is a thin wall (KHR_materials_volume).
    Thickness thickness: number, limits(0.0, 1e6) unit(METERS) row("Thickness") slider(0.0, 1.0, 2);
    /// Color of white light after the attenuation distance.
    AttenuationColor attenuation_color: color, limits(0.0, 1.0) unit(LINEAR_RGB) row("Attenuation");
    /// Distance after which white light has the attenuation color.
    AttenuationDistance attenuation_distance: number, limits(1e-6, 1e30) unit(METERS) row("Att. distance") slider(0.01, 10.0, 2);
    /// 20 / Abbe number (KHR_materials_dispersion).
    Dispersion dispersion: number, limits(0.0, 100.0) row("Dispersion") slider(0.0, 1.0, 2);
    /// Part of the light that leaves diffusely at the other side (KHR_materials_diffuse_transmission).
    DiffuseTransmission diffuse_transmission: number, limits(0.0, 1.0) row("Diffuse trans.") slider(0.0, 1.0, 2);
    /// Color of the diffusely transmitted light.
    DiffuseTransmissionColor diffuse_transmission_color: color, limits(0.0, 1.0) unit(LINEAR_RGB) row("Trans. color");
}

/// Checks the values of all materials.
///
/// # Errors
/// A number where a color belongs or the reverse, or a value beyond its limits.
pub(super) fn check(materials: &BTreeMap<String, MaterialValues>) -> Result<(), String> {
    for (material, values) in materials {
        for (factor, value) in values {
            let (path, entry, is_color) = (path(material, *factor), factor.entry(), factor.is_color());
            let value = match value {
                FactorValue::Number(number) if is_color => {
                    return Err(format!("{path} is {number}; it takes 3 numbers, {}", entry.valid.text()));
                }
                FactorValue::Color(_) if !is_color => {
                    return Err(format!("{path} takes one number, {}", entry.valid.text()));
                }
                FactorValue::Number(number) => Value::Number(*number),
                FactorValue::Color(color) => Value::Numbers(*color),
            };
            entry.check(&path, &value)?;
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
    use super::super::Valid;
    use super::*;

    #[test]
    fn names_in_files_are_those_of_the_enum() {
        for factor in Factor::ALL {
            let text = toml::Value::try_from(factor).unwrap();
            assert_eq!(text.as_str(), Some(factor.name()));
            assert_eq!(named(factor.name()), Ok(*factor));
            let Valid::Limits(low, high) = factor.entry().valid else { panic!("{factor:?} has no limits") };
            let ends = factor.entry().slider.map_or((low, high), |slider| (slider.ends.0 as f32, slider.ends.1 as f32));
            assert!(
                low <= ends.0 && ends.1 <= high && factor.is_color() == factor.entry().slider.is_none(),
                "{factor:?}"
            );
        }
    }
}
