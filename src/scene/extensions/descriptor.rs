//! Describes a material extension of glTF to the rest of the program: one descriptor each.

use crate::scene::error::Problem;
use crate::scene::gltf::materials::reader::Reader;
use crate::scene::material::Material;
use crate::settings::{Factor, FactorValue};

/// A material extension.
pub struct Extension {
    /// Its name in glTF files.
    pub name: &'static str,
    /// Reads it into the material: numbers and textures.
    pub read: fn(&mut Reader<'_, '_>) -> Result<(), Problem>,
    /// The `interface::FEATURE_*` bits of a material, on a mesh that has a tangent frame or not. Those that change nothing in the picture
    /// are left out.
    pub features: fn(&Material, bool) -> u32,
    /// Its factors that the user can replace.
    pub factors: &'static [MaterialFactor],
}

/// Far above any real material. Its square is still finite in `f32`.
pub const LARGEST_IOR: f32 = 1e4;

/// `bit` if `is_used`.
pub fn bit_if(bit: u32, is_used: bool) -> u32 {
    if is_used { bit } else { 0 }
}

/// A factor of a material: where it is, and when it has an effect.
pub struct MaterialFactor {
    /// Which factor.
    pub factor: Factor,
    /// Its value.
    pub get: fn(&Material) -> FactorValue,
    /// Replaces its value. One of the other kind changes nothing.
    pub set: fn(&mut Material, FactorValue),
    /// Whether it can have an effect on a material of this kind.
    pub applies: fn(&Material) -> bool,
    /// Whether it has an effect on this material now.
    pub is_used: fn(&Material) -> bool,
}

impl MaterialFactor {
    /// A factor with an effect on all materials.
    pub const fn new(factor: Factor, get: fn(&Material) -> FactorValue, set: fn(&mut Material, FactorValue)) -> Self {
        Self { factor, get, set, applies: |_| true, is_used: |_| true }
    }

    /// Limits it to materials of a kind.
    pub const fn applies(self, applies: fn(&Material) -> bool) -> Self {
        Self { applies, ..self }
    }

    /// Says when it has an effect.
    pub const fn used(self, is_used: fn(&Material) -> bool) -> Self {
        Self { is_used, ..self }
    }
}

/// A field that holds a factor.
pub trait Field {
    /// Its value.
    fn value(&self) -> FactorValue;

    /// Takes a value. One of the other kind changes nothing.
    fn store(&mut self, value: FactorValue);
}

impl Field for f32 {
    fn value(&self) -> FactorValue {
        FactorValue::Number(*self)
    }

    fn store(&mut self, value: FactorValue) {
        if let FactorValue::Number(number) = value {
            *self = number;
        }
    }
}

impl Field for [f32; 3] {
    fn value(&self) -> FactorValue {
        FactorValue::Color(*self)
    }

    fn store(&mut self, value: FactorValue) {
        if let FactorValue::Color(color) = value {
            *self = color;
        }
    }
}

/// A factor that is a member of the material's numbers.
macro_rules! factor {
    ($factor:ident, $member:ident $([$index:literal])?) => {
        $crate::scene::extensions::MaterialFactor::new(
            $crate::settings::Factor::$factor,
            |material| $crate::scene::extensions::Field::value(&material.numbers.$member$([$index])?),
            |material, value| {
                $crate::scene::extensions::Field::store(&mut material.numbers.$member$([$index])?, value)
            },
        )
    };
}

pub(in crate::scene) use factor;
