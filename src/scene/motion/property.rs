//! The properties that animations move beside nodes: numbers of materials, lights, cameras and the environment (KHR_animation_pointer).

use glam::{DQuat, Vec3};

use super::curve::Curve;
use super::transform::slerp;
use crate::settings::Factor;

/// Numbers that belong together, of a material, light or camera of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Color and alpha of a material.
    BaseColor(usize),
    /// Color and strength of a material's emission.
    Emission(usize),
    /// Strength and angle in radians of a material's anisotropy.
    Anisotropy(usize),
    /// Glossiness of a material that has it in place of roughness.
    Glossiness(usize),
    /// Scale of the clear coat's normal texture.
    CoatNormalScale(usize),
    /// Thickness of the thin film where its texture is 0, nanometers.
    ThinnestFilm(usize),
    /// Another factor of a material.
    Factor(usize, Factor),
    /// The transform of a material's texture, `interface::TEXTURE_*`: offset, rotation in radians, scale.
    Texture(usize, u32),
    /// Color and intensity of a light.
    Light(usize),
    /// Range of a light.
    Range(usize),
    /// Inner and outer angle of a spot light.
    Cone(usize),
    /// Vertical field of view of a camera, radians.
    Fovy(usize),
    /// Half the height of what a parallel camera sees.
    Height(usize),
    /// Intensity of a model's environment. Index 0 is the environment that is shown.
    EnvironmentIntensity(usize),
    /// Rotation of a model's environment, a quaternion; indices as for its intensity.
    EnvironmentRotation(usize),
}

impl Property {
    /// The material that has it.
    pub fn material(self) -> Option<usize> {
        match self {
            Self::BaseColor(index)
            | Self::Emission(index)
            | Self::Anisotropy(index)
            | Self::Glossiness(index)
            | Self::CoatNormalScale(index)
            | Self::ThinnestFilm(index)
            | Self::Factor(index, _)
            | Self::Texture(index, _) => Some(index),
            Self::Light(_)
            | Self::Range(_)
            | Self::Cone(_)
            | Self::Fovy(_)
            | Self::Height(_)
            | Self::EnvironmentIntensity(_)
            | Self::EnvironmentRotation(_) => None,
        }
    }
}

/// Numbers of a property: those of the file, or those of a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// Which numbers these are.
    pub property: Property,
    /// Finite.
    pub numbers: Vec<f64>,
}

impl Values {
    /// Mixes numbers, from `first` on, with those of a curve.
    pub fn follow(&mut self, first: usize, curve: &Curve, time_s: f64, weight: f64) {
        if let Some(from) = self.rotation() {
            let to = curve.rotation(time_s).unwrap_or(from);
            self.numbers = slerp(from, to, weight).to_array().into();
            return;
        }
        for (number, to) in self.numbers.iter_mut().skip(first).zip(curve.numbers(time_s)) {
            *number += (to - *number) * weight;
        }
    }

    /// The rotation, of a property that is one.
    pub fn rotation(&self) -> Option<DQuat> {
        let rotation = DQuat::from_slice(self.numbers.get(..4)?);
        let is_one = matches!(self.property, Property::EnvironmentRotation(_));
        is_one.then(|| if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY })
    }

    /// A number; 0 beyond the last.
    pub fn at(&self, index: usize) -> f32 {
        self.numbers.get(index).map_or(0.0, |number| *number as f32)
    }

    /// The first three numbers as a color.
    pub fn color(&self) -> Vec3 {
        Vec3::new(self.at(0), self.at(1), self.at(2)).max(Vec3::ZERO)
    }
}
