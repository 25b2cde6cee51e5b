//! Gives materials, lights, cameras and the environment the values of a moment (KHR_animation_pointer).

use std::collections::BTreeMap;

use glam::{Affine2, Vec2, Vec3};

use crate::scene::environment::ModelEnvironment;
use crate::scene::material::Material;
use crate::scene::motion::{Property, Values};
use crate::scene::objects::{Camera, Lens, Light, LightKind};
use crate::scene::replace::replace_factors;
use crate::settings::{Factor, FactorValue, MaterialValues, Valid};

/// The materials that these values change, by their indices. `materials` are those of the file.
pub fn moved_materials(materials: &[Material], values: &[Values]) -> Vec<(usize, Material)> {
    let mut moved: BTreeMap<usize, Material> = BTreeMap::new();
    for value in values {
        let of_file = value.property.material().and_then(|index| Some((index, materials.get(index)?)));
        if let Some((index, of_file)) = of_file {
            move_material(moved.entry(index).or_insert_with(|| of_file.clone()), value);
        }
    }
    moved.into_iter().collect()
}

/// Applies a value of a material.
fn move_material(material: &mut Material, value: &Values) {
    match value.property {
        Property::BaseColor(_) => {
            material.numbers.base_color_factor = [0, 1, 2, 3].map(|channel| value.at(channel).clamp(0.0, 1.0));
        }
        Property::Emission(_) => {
            let emission = value.color().min(Vec3::ONE) * value.at(3).max(0.0);
            if emission.is_finite() {
                material.numbers.emissive_factor = emission.to_array();
            }
        }
        Property::Anisotropy(_) => {
            let (sin, cos) = value.at(1).sin_cos();
            material.numbers.anisotropy_strength = value.at(0).clamp(0.0, 1.0);
            material.numbers.anisotropy_rotation = [cos, sin];
        }
        Property::Glossiness(_) if material.specular_glossiness => {
            material.numbers.roughness_factor = value.at(0).clamp(0.0, 1.0);
        }
        Property::Glossiness(_) => {}
        Property::CoatNormalScale(_) => material.numbers.clearcoat_normal_scale = value.at(0),
        Property::ThinnestFilm(_) => material.numbers.iridescence_thickness_nm[0] = value.at(0).max(0.0),
        Property::Factor(_, factor) => set_factor(material, factor, value),
        Property::Texture(_, slot) => {
            let [u, v, angle, width, height] = [0, 1, 2, 3, 4].map(|number| value.at(number));
            let affine = Affine2::from_scale_angle_translation(Vec2::new(width, height), -angle, Vec2::new(u, v));
            if let Some(used) = material.textures[slot as usize].as_mut().filter(|_| affine.is_finite()) {
                used.uv_from_mesh = affine;
            }
        }
        Property::Light(_)
        | Property::Range(_)
        | Property::Cone(_)
        | Property::Fovy(_)
        | Property::Height(_)
        | Property::EnvironmentIntensity(_)
        | Property::EnvironmentRotation(_) => {}
    }
}

/// Sets a factor within its limits.
fn set_factor(material: &mut Material, factor: Factor, value: &Values) {
    let within = |number: f32| match factor.entry().valid {
        Valid::Limits(low, high) => number.clamp(low, high),
        _ => number,
    };
    let to = match factor.is_color() {
        true => FactorValue::Color(value.color().to_array().map(within)),
        false => FactorValue::Number(within(value.at(0))),
    };
    replace_factors(material, &MaterialValues::from([(factor, to)]));
}

/// Applies values of the light with this index.
pub fn move_light(light: &mut Light, index: usize, values: &[Values]) {
    for value in values {
        match value.property {
            Property::Light(of) if of == index => {
                let intensity = value.color() * value.at(3).max(0.0);
                if intensity.is_finite() {
                    light.intensity = intensity;
                }
            }
            Property::Range(of) if of == index => light.range = Some(value.at(0)).filter(|range| *range > 0.0),
            Property::Cone(of) if of == index => {
                let outer = value.at(1).clamp(1e-3, std::f32::consts::FRAC_PI_2);
                let inner = value.at(0).clamp(0.0, outer);
                light.kind = LightKind::Spot { inner, outer };
            }
            _ => {}
        }
    }
}

/// Applies values of the camera with this index.
pub fn move_camera(camera: &mut Camera, index: usize, values: &[Values]) {
    for value in values {
        let number = value.at(0);
        match value.property {
            Property::Fovy(of) if of == index && number > 0.0 && number < std::f32::consts::PI => {
                camera.lens = Lens::Perspective { fovy: number };
            }
            Property::Height(of) if of == index && number != 0.0 => {
                camera.lens = Lens::Orthographic { height: 2.0 * number.abs() };
            }
            _ => {}
        }
    }
}

/// The intensity of the model's environment, and the angle around +Y from its rotation in the file to that of the moment, radians.
pub fn moved_environment(environment: &ModelEnvironment, values: &[Values]) -> (f32, f32) {
    let (mut intensity, mut angle) = (environment.intensity, 0.0);
    for value in values {
        match value.property {
            Property::EnvironmentIntensity(0) => intensity = value.at(0).clamp(0.0, ModelEnvironment::MAX_INTENSITY),
            Property::EnvironmentRotation(0) => {
                let from_file = value.rotation().unwrap_or_default() * environment.rotation.as_dquat().inverse();
                angle = 2.0 * from_file.y.atan2(from_file.w) as f32;
            }
            _ => {}
        }
    }
    (intensity, angle)
}
