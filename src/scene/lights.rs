//! From settings and model to the lights that shine.

use glam::Vec3;

use super::camera::direction;
use super::model::{LightKind, Model};
use crate::interface::{self, Light};
use crate::settings::{LightSettings, LightSource, OrbitLight};

/// The lights of a frame in world space. `time_s` turns the orbiting ones by `spin` degrees a second.
pub fn lights(settings: &LightSettings, model: &Model, time_s: f32) -> Vec<Light> {
    match settings.source {
        LightSource::None => Vec::new(),
        LightSource::Orbit => settings.orbit.iter().map(|light| orbit(light, settings.spin * time_s, model)).collect(),
        LightSource::Model => model.lights.iter().map(punctual).collect(),
    }
}

/// Distances and intensities grow with the model, so that every model is lit alike.
fn orbit(light: &OrbitLight, turned_deg: f32, model: &Model) -> Light {
    let (center, radius) = (model.bounds.center(), model.bounds.radius());
    let azimuth_rad = (light.azimuth + turned_deg).to_radians();
    let outward = direction(azimuth_rad, (90.0 - light.polar).to_radians());
    Light {
        position_ws: (center + outward * radius * light.distance).to_array(),
        kind: interface::LIGHT_POINT,
        direction_ws: (-outward).to_array(),
        intensity: (Vec3::from(light.color) * light.strength * radius * radius).to_array(),
        ..Light::default()
    }
}

fn punctual(light: &super::model::Light) -> Light {
    let (kind, cos_inner, cos_outer) = match light.kind {
        LightKind::Directional => (interface::LIGHT_DIRECTIONAL, 0.0, 0.0),
        LightKind::Point => (interface::LIGHT_POINT, 0.0, 0.0),
        LightKind::Spot { inner, outer } => (interface::LIGHT_SPOT, inner.cos(), outer.cos()),
    };
    Light {
        position_ws: light.position.to_array(),
        kind,
        direction_ws: light.direction.to_array(),
        range: light.range.unwrap_or(0.0),
        intensity: light.intensity.to_array(),
        cos_inner,
        cos_outer,
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::{self, Bounds};
    use super::*;

    fn model() -> Model {
        // Half the diagonal is 3.
        Model { bounds: Bounds { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(2.0, 4.0, 4.0) }, ..Model::default() }
    }

    fn light(azimuth: f32, polar: f32) -> OrbitLight {
        OrbitLight { color: [1.0, 0.5, 0.0], strength: 2.0, distance: 4.0, azimuth, polar }
    }

    #[test]
    fn orbiting_lights_scale_with_the_model() {
        let settings = LightSettings {
            orbit: [light(0.0, 90.0), light(90.0, 90.0), light(77.0, 0.0)],
            ..LightSettings::default()
        };
        let lights = lights(&settings, &model(), 0.0);
        let center = Vec3::new(1.0, 2.0, 2.0);
        for (light, side) in lights.iter().zip([Vec3::Z, Vec3::X, Vec3::Y]) {
            assert!(Vec3::from(light.position_ws).distance(center + side * 12.0) < 1e-4, "{light:?}");
            assert!(Vec3::from(light.direction_ws).distance(-side) < 1e-5);
            assert_eq!((light.intensity, light.kind), ([18.0, 9.0, 0.0], interface::LIGHT_POINT));
        }
    }

    #[test]
    fn spin_adds_azimuth() {
        let settings = LightSettings { spin: 45.0, orbit: [light(0.0, 90.0); 3], ..LightSettings::default() };
        let position = Vec3::from(lights(&settings, &model(), 2.0)[0].position_ws);
        assert!(position.distance(Vec3::new(13.0, 2.0, 2.0)) < 1e-4, "{position}");
    }

    #[test]
    fn the_models_own_or_none() {
        let mut model = model();
        model.lights.push(model::Light {
            name: String::new(),
            kind: LightKind::Spot { inner: 0.0, outer: std::f32::consts::FRAC_PI_3 },
            position: Vec3::ONE,
            direction: Vec3::NEG_Y,
            intensity: Vec3::splat(5.0),
            range: Some(7.0),
        });
        let from = |source| lights(&LightSettings { source, ..LightSettings::default() }, &model, 0.0);
        let spot = from(LightSource::Model)[0];
        assert_eq!((spot.kind, spot.range, spot.cos_inner), (interface::LIGHT_SPOT, 7.0, 1.0));
        assert!((spot.cos_outer - 0.5).abs() < 1e-6);
        assert!(from(LightSource::None).is_empty());
    }
}
