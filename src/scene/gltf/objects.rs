//! Reads lights and cameras.

use glam::{DMat4, Vec3};
use gltf::json;
use json::extensions::scene::khr_lights_punctual as punctual;
use json::validation::Checked;

use super::place::place;
use crate::scene::error::Problem;
use crate::scene::model::{Lens, Light, LightKind};

/// The light of a node.
pub fn read_light(
    light: &punctual::Light,
    index: usize,
    world: &DMat4,
    warnings: &mut Vec<String>,
) -> Result<Light, Problem> {
    let place = place("KHR_lights_punctual.lights", index, light.name.as_deref());
    let color = Vec3::from(light.color);
    // Check both factors, since the product of two negative numbers is positive.
    if !(light.intensity >= 0.0 && light.intensity.is_finite()) {
        let (place, found) = (format!("{place}.intensity"), light.intensity.to_string());
        return Err(Problem::invalid(place, "a finite number of at least 0", found));
    }
    if !(color.is_finite() && color.min_element() >= 0.0) {
        return Err(Problem::invalid(format!("{place}.color"), "finite numbers of at least 0", color.to_string()));
    }
    let intensity = color * light.intensity;
    if !intensity.is_finite() {
        return Err(Problem::invalid(place, "a finite color times intensity", intensity.to_string()));
    }
    let kind = match light.type_ {
        Checked::Valid(punctual::Type::Directional) => LightKind::Directional,
        Checked::Valid(punctual::Type::Point) => LightKind::Point,
        Checked::Valid(punctual::Type::Spot) => {
            let spot = light
                .spot
                .clone()
                .unwrap_or(punctual::Spot { inner_cone_angle: 0.0, outer_cone_angle: std::f32::consts::FRAC_PI_4 });
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(0.0 <= inner && inner < outer && outer <= std::f32::consts::FRAC_PI_2 + 1e-6) {
                let expected = "cone angles with 0 <= inner < outer <= pi/2";
                return Err(Problem::invalid(place, expected, format!("{inner} and {outer}")));
            }
            LightKind::Spot { inner, outer }
        }
        Checked::Invalid => return Err(Problem::invalid(place, "the type directional, point or spot", "another")),
    };
    let range = light.range.filter(|range| *range > 0.0 && range.is_finite());
    if range != light.range {
        warnings.push(format!("{place} has a range that is not above 0: it is taken as endless."));
    }
    let name = light.name.as_deref().unwrap_or_default().into();
    let light = Light { name, kind, position: Vec3::ZERO, direction: Vec3::NEG_Z, intensity, range };
    Ok(light.at(world))
}

/// The projection of a camera.
pub fn read_lens(camera: &json::Camera, index: usize) -> Result<Lens, Problem> {
    let place = place("cameras", index, camera.name.as_deref());
    let between = |value: f32, least: f32, most: f32| value > least && value < most;
    if let Some(perspective) = &camera.perspective {
        if between(perspective.yfov, 0.0, std::f32::consts::PI) {
            return Ok(Lens::Perspective { fovy: perspective.yfov });
        }
        return Err(Problem::invalid(place, "a yfov above 0 and below pi", perspective.yfov.to_string()));
    }
    let Some(orthographic) = &camera.orthographic else {
        return Err(Problem::invalid(place, "a perspective or an orthographic projection", "neither"));
    };
    let height = 2.0 * orthographic.ymag.abs();
    if between(height, 0.0, f32::INFINITY) {
        return Ok(Lens::Orthographic { height });
    }
    Err(Problem::invalid(place, "a finite ymag that is not 0", orthographic.ymag.to_string()))
}
