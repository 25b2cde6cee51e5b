//! Builds the lights of a frame from the settings and the model.
//!
//! All kinds of lights use one formula without a branch (`lighting/punctual.glsl`). Up to four are a specialization
//! constant, `LIGHT_COUNT`, so that the loop over them is unrolled where a mode looks at all of them: on lavapipe that
//! is a tenth of the frame. Few lights (`FEW_LIGHTS`) and four suns are a uniform block, which a software device reads
//! faster than a buffer; more are a buffer, which shaders read by the grid of `light_grid.rs`. `frame.light_clip_from_world` has the views of the first 16 lights, suns of the
//! environment after the others. Rust computes them, since a software device would do so in each pixel. A light that
//! `user_light` moves gets its view in GLSL (`lighting/shadows/light_view.glsl`); the pass `light_views` writes the
//! views to an image for the vertex stage of the shadow map, which cannot include `user.glsl`.
//!
//! As long as the user has not chosen which lights shine, a window shows a model with lights in its own, because a file
//! with lights was lit by its author. Commands without a window do not.

use glam::{Mat4, Vec3, Vec4};

use super::camera::direction;
use super::model::{Bounds, LightKind, Model};
use crate::interface::{self, Light};
use crate::settings::{LightSettings, LightSource, OrbitLight, RectLight};

/// The lights of a frame in world space, the rectangle last. The orbiting lights have turned by `spin` (degrees a
/// second) times `time_s`; the rectangle does not turn.
pub fn lights(settings: &LightSettings, model: &Model, time_s: f32) -> Vec<Light> {
    let mut lights: Vec<Light> = match settings.source {
        LightSource::None => return Vec::new(),
        LightSource::Orbit => settings.orbit.iter().map(|light| orbit(light, settings.spin * time_s, model)).collect(),
        LightSource::Model => of_model(model, settings.cutoff),
    };
    if settings.rect.enabled {
        lights.push(rectangle(&settings.rect, model));
    }
    lights
}

/// The names of the lights that [`lights`] returns: those in the model's file, which may be empty, or the settings that have the lights.
pub fn light_names(settings: &LightSettings, model: &Model) -> Vec<String> {
    let mut names: Vec<String> = match settings.source {
        LightSource::None => return Vec::new(),
        LightSource::Orbit => (0..settings.orbit.len()).map(|index| format!("lights.orbit.{index}")).collect(),
        LightSource::Model => model.lights.iter().map(|light| light.name.to_string()).collect(),
    };
    if settings.rect.enabled {
        names.push("lights.rect".to_owned());
    }
    names
}

/// The lights of a model. Those that are hidden stay in their place, and are dark.
fn of_model(model: &Model, cutoff: f32) -> Vec<Light> {
    let light = |(index, light)| match model.pose.hidden.light(index) {
        true => Light { intensity: [0.0; 3], ..punctual(light, cutoff) },
        false => punctual(light, cutoff),
    };
    model.lights.iter().enumerate().map(light).collect()
}

/// The number of lights that [`lights`] returns for a model with `in_model` lights of its own.
pub fn light_count(settings: &LightSettings, in_model: usize) -> usize {
    let punctual = match settings.source {
        LightSource::None => return 0,
        LightSource::Orbit => settings.orbit.len(),
        LightSource::Model => in_model,
    };
    punctual + usize::from(settings.rect.enabled)
}

/// World to the clip space of a light that sees the sphere around the model: two axes across, and reversed depth, 1 at the near end of
/// the sphere and 0 at its far end. Directional lights see it by a parallel projection, others by a perspective one towards its
/// center. A light inside the sphere sees at most 143 degrees of it, from a hundredth of its width on.
pub fn view_of_light(light: &Light, bounds: &Bounds) -> Mat4 {
    let radius = (1.02 * bounds.radius()).max(1e-6 * (1.0 + bounds.center().length()));
    let place = Vec4::from(light.position_ws);
    if place.w == 0.0 {
        let axis = (-place.truncate()).normalize_or(Vec3::NEG_Y);
        let view = look_along(axis, bounds.center());
        let size = Vec3::new(radius, radius, 2.0 * radius);
        return Mat4::from_translation(Vec3::new(0.0, 0.0, 0.5)) * Mat4::from_scale(size.recip() * NEARER) * view;
    }
    let offset = bounds.center() - place.truncate();
    let distance = offset.length();
    let near = (distance - radius).max(0.02 * radius);
    let far = (distance + radius).max(1.000_01 * near);
    let tangent = (radius / (distance * distance - radius * radius).max(0.0).sqrt()).min(3.0);
    let view = look_along(offset.normalize_or(Vec3::NEG_Y), place.truncate());
    let across = Vec4::new(tangent.recip(), 0.0, 0.0, 0.0);
    let depth = Vec4::new(0.0, 0.0, -near / (far - near), 1.0);
    let shift = Vec4::new(0.0, 0.0, near * far / (far - near), 0.0);
    Mat4::from_cols(across, Vec4::new(0.0, tangent.recip(), 0.0, 0.0), depth, shift) * view
}

/// Reversed depth: what is farther along the axis has less.
const NEARER: Vec3 = Vec3::new(1.0, 1.0, -1.0);

/// World space to two axes across, and the distance along an axis, from a point.
fn look_along(axis: Vec3, from: Vec3) -> Mat4 {
    let (right, up) = axis.any_orthonormal_pair();
    Mat4::from_cols(right.extend(0.0), up.extend(0.0), axis.extend(0.0), Vec4::W).transpose()
        * Mat4::from_translation(-from)
}

/// Scales distance and intensity with the model, so that every model has the same lighting.
fn orbit(light: &OrbitLight, turned_deg: f32, model: &Model) -> Light {
    let (center, radius) = (model.bounds.center(), model.bounds.radius());
    let azimuth_rad = (light.azimuth + turned_deg).to_radians();
    let outward = direction(azimuth_rad, (90.0 - light.polar).to_radians());
    Light {
        position_ws: (center + outward * radius * light.distance).extend(1.0).to_array(),
        direction_ws: (-outward).to_array(),
        kind: interface::LIGHT_POINT,
        intensity: (Vec3::from(light.color) * light.strength * radius * radius).to_array(),
        angle_offset: 1.0,
        ..Light::default()
    }
}

/// Scales lengths with the model; radiance needs no scaling. `half_x_ws` x `half_y_ws` is the direction of emission.
fn rectangle(light: &RectLight, model: &Model) -> Light {
    let (center, radius) = (model.bounds.center(), model.bounds.radius());
    let azimuth_rad = light.azimuth.to_radians();
    let outward = direction(azimuth_rad, (90.0 - light.polar).to_radians());
    // A cross product with +Y would be zero directly above and below the model.
    let x = Vec3::new(azimuth_rad.cos(), 0.0, -azimuth_rad.sin());
    let y = (-outward).cross(x);
    Light {
        position_ws: (center + outward * radius * light.distance).extend(1.0).to_array(),
        direction_ws: (-outward).to_array(),
        kind: interface::LIGHT_RECT,
        intensity: (Vec3::from(light.color) * light.strength).to_array(),
        half_x_ws: (x * radius * light.width * 0.5).to_array(),
        half_y_ws: (y * radius * light.height * 0.5).to_array(),
        angle_offset: 1.0,
        ..Light::default()
    }
}

/// The unit vector from the model's center to a light, by its azimuth and polar angle in degrees.
pub fn light_direction(azimuth: f32, polar: f32) -> Vec3 {
    direction(azimuth.to_radians(), (90.0 - polar).to_radians())
}

/// The corners of the rectangular light around a model with these bounds, world space.
pub fn rectangle_corners(light: &RectLight, bounds: &Bounds) -> [Vec3; 4] {
    let model = Model { bounds: *bounds, ..Model::default() };
    let light = rectangle(light, &model);
    let [x, y] = [light.half_x_ws, light.half_y_ws].map(Vec3::from);
    let center = Vec4::from(light.position_ws).truncate();
    [center - x - y, center + x - y, center + x + y, center - x + y]
}

/// `cutoff`: illuminance at which a light without a range ends, lux; 0: it has no end.
fn punctual(light: &super::model::Light, cutoff: f32) -> Light {
    let (kind, position_ws) = match light.kind {
        LightKind::Directional => (interface::LIGHT_DIRECTIONAL, (-light.direction).extend(0.0)),
        LightKind::Point => (interface::LIGHT_POINT, light.position.extend(1.0)),
        LightKind::Spot { .. } => (interface::LIGHT_SPOT, light.position.extend(1.0)),
    };
    let (angle_scale, angle_offset) = match light.kind {
        LightKind::Spot { inner, outer } => cone(inner, outer),
        _ => (0.0, 1.0),
    };
    let own = light.range.filter(|range| *range > 0.0);
    let range = own.or_else(|| (cutoff > 0.0).then(|| (light.intensity.max_element() / cutoff).sqrt()));
    let range = range.filter(|range| *range > 0.0 && light.kind != LightKind::Directional);
    Light {
        position_ws: position_ws.to_array(),
        direction_ws: light.direction.to_array(),
        kind,
        intensity: light.intensity.to_array(),
        inverse_range: range.map_or(0.0, f32::recip),
        angle_scale,
        angle_offset,
        ..Light::default()
    }
}

/// Scale and offset of a ramp in the cosine of the angle to the axis: 0 at `outer`, 1 at `inner`, radians
/// (KHR_lights_punctual). With equal angles the ramp is a step; 1e-3, also from the extension, keeps the scale finite.
fn cone(inner: f32, outer: f32) -> (f32, f32) {
    let scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
    (scale, -outer.cos() * scale)
}

#[cfg(test)]
mod tests {
    use super::super::model;
    use super::*;

    fn model() -> Model {
        // The bounding sphere's radius is 3.
        Model { bounds: Bounds { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(2.0, 4.0, 4.0) }, ..Model::default() }
    }

    fn own(kind: LightKind) -> model::Light {
        let (position, direction, intensity) = (Vec3::ONE, Vec3::NEG_Y, Vec3::splat(5.0));
        model::Light { name: "".into(), kind, position, direction, intensity, range: Some(7.0) }
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
            assert!(Vec4::from(light.position_ws).distance((center + side * 12.0).extend(1.0)) < 1e-4, "{light:?}");
            assert!(Vec3::from(light.direction_ws).distance(-side) < 1e-5);
            assert_eq!((light.intensity, light.kind), ([18.0, 9.0, 0.0], interface::LIGHT_POINT));
        }
    }

    #[test]
    fn a_light_sees_the_sphere_around_the_model() {
        let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let radius = bounds.radius();
        for position_ws in [[0.0, 1.0, 0.0, 0.0], [0.6, 0.0, 0.8, 0.0], [3.0, 4.0, -2.0, 1.0], [0.0, 90.0, 0.0, 1.0]] {
            let light = Light { position_ws, ..Light::default() };
            let view = view_of_light(&light, &bounds);
            let place = Vec4::from(position_ws);
            let towards = if place.w == 0.0 { place.truncate() } else { place.truncate().normalize() };
            let depth = |point: Vec3| view.project_point3(point).z;
            assert!((0.98..1.0).contains(&depth(towards * radius)), "{light:?}: {}", depth(towards * radius));
            assert!((0.0..0.02).contains(&depth(-towards * radius)), "{light:?}: {}", depth(-towards * radius));
            let middle = view.project_point3(Vec3::ZERO);
            assert!(middle.truncate().length() < 1e-5, "{middle}");
            for point in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::ONE.normalize()] {
                let seen = view.project_point3(point * radius);
                assert!(seen.abs().max_element() <= 1.0 + 1e-5, "{light:?}: {seen}");
            }
        }
        // Inside
        let light = Light { position_ws: [0.1, 0.0, 0.0, 1.0], ..Light::default() };
        let seen = view_of_light(&light, &bounds).project_point3(Vec3::ZERO);
        assert!(seen.is_finite() && (0.0..=1.0).contains(&seen.z), "{seen}");
        assert!(view_of_light(&Light::default(), &Bounds::default()).is_finite());
    }

    #[test]
    fn spin_adds_azimuth() {
        let settings = LightSettings { spin: 45.0, orbit: [light(0.0, 90.0); 3], ..LightSettings::default() };
        let position = Vec4::from(lights(&settings, &model(), 2.0)[0].position_ws).truncate();
        assert!(position.distance(Vec3::new(13.0, 2.0, 2.0)) < 1e-4, "{position}");
    }

    #[test]
    fn the_rectangle_faces_the_center_from_everywhere() {
        // Directly above and below, the horizontal edge needs a choice.
        for (azimuth, polar) in [(-40.0, 50.0), (0.0, 90.0), (77.0, 0.0), (200.0, 180.0), (0.0, 0.0)] {
            let rect = RectLight {
                enabled: true,
                azimuth,
                polar,
                distance: 2.0,
                width: 1.0,
                height: 0.5,
                ..RectLight::default()
            };
            let settings = LightSettings { rect, spin: 45.0, ..LightSettings::default() };
            let lights = lights(&settings, &model(), 3.0);
            let light = lights[3];
            let position = Vec4::from(light.position_ws).truncate();
            let [direction, x, y] = [light.direction_ws, light.half_x_ws, light.half_y_ws].map(Vec3::from);
            assert_eq!((lights.len(), light.kind, light.intensity), (4, interface::LIGHT_RECT, [6.0; 3]));
            assert!((position + direction * 6.0).distance(Vec3::new(1.0, 2.0, 2.0)) < 1e-4, "{light:?}");
            assert!((x.length() - 1.5).abs() < 1e-5 && (y.length() - 0.75).abs() < 1e-5 && x.y == 0.0, "{light:?}");
            assert!(x.cross(y).normalize().distance(direction) < 1e-5, "{light:?}");
        }
    }

    #[test]
    fn the_count_is_known_without_the_lights() {
        let mut model = model();
        model.lights = vec![own(LightKind::Point), own(LightKind::Directional)];
        let count = |source, enabled| {
            let rect = RectLight { enabled, ..RectLight::default() };
            let settings = LightSettings { source, rect, ..LightSettings::default() };
            let count = lights(&settings, &model, 0.0).len();
            assert_eq!(light_count(&settings, model.lights.len()), count, "{source:?} {enabled}");
            count
        };
        let all = [LightSource::Orbit, LightSource::Model, LightSource::None];
        assert_eq!(
            (all.map(|source| count(source, false)), all.map(|source| count(source, true))),
            ([3, 2, 0], [4, 3, 0])
        );
    }

    #[test]
    fn the_models_own_or_none() {
        let mut model = model();
        let outer = std::f32::consts::FRAC_PI_3;
        model.lights = vec![own(LightKind::Spot { inner: 0.3, outer }), own(LightKind::Directional)];
        let from = |source| lights(&LightSettings { source, ..LightSettings::default() }, &model, 0.0);
        let (spot, sun) = (from(LightSource::Model)[0], from(LightSource::Model)[1]);
        assert_eq!((spot.kind, spot.inverse_range, spot.position_ws), (interface::LIGHT_SPOT, 1.0 / 7.0, [1.0; 4]));
        let ramp = |cosine: f32| cosine * spot.angle_scale + spot.angle_offset;
        assert!(ramp(outer.cos()).abs() < 1e-6 && (ramp(0.3_f32.cos()) - 1.0).abs() < 1e-6, "{spot:?}");
        // Directly above, infinitely far away, with unlimited range, and no cone.
        assert_eq!((sun.position_ws, sun.inverse_range), ([0.0, 1.0, 0.0, 0.0], 0.0));
        assert_eq!((sun.angle_scale, sun.angle_offset), (0.0, 1.0));
        assert!(from(LightSource::None).is_empty());
    }

    #[test]
    fn a_cutoff_ends_lights_without_a_range() {
        let mut model = model();
        model.lights = [LightKind::Point, LightKind::Point, LightKind::Directional].map(own).to_vec();
        model.lights[1].range = None;
        model.lights[2].range = None;
        let settings = LightSettings { source: LightSource::Model, cutoff: 0.2, ..LightSettings::default() };
        // 5 cd are 0.2 lux at a distance of 5 m.
        let inverse = lights(&settings, &model, 0.0).iter().map(|light| light.inverse_range).collect::<Vec<_>>();
        assert!((inverse[1] - 0.2).abs() < 1e-6, "{inverse:?}");
        assert_eq!((inverse[0], inverse[2]), (1.0 / 7.0, 0.0));
    }
}
