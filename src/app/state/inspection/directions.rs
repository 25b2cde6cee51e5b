//! The directions at a pixel: normal, eye and light, and the angles between them.

use glam::Vec3;

use crate::interface::{LIGHT_DIRECTIONAL, Light};

/// Directions at a point of a surface. Unit vectors in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) struct Directions {
    /// Angle from the normal to the light, degrees, 0..180.
    pub(in crate::app) light_deg: f32,
    /// Angle from the normal to the eye, degrees, 0..180.
    pub(in crate::app) eye_deg: f32,
    /// Azimuth of the eye around the normal, degrees, -180..180: 0 on the side where a mirror would reflect the light, 180 on the side
    /// of the light.
    pub(in crate::app) azimuth_deg: f32,
}

impl Directions {
    /// The directions at a point of a surface. `None` if the light is at the point itself, or the normal is zero.
    pub(in crate::app) fn new(position: Vec3, normal: Vec3, eye: Vec3, light: &Light) -> Option<Self> {
        let [x, y, z, _] = light.position_ws;
        let to_light = match light.kind {
            LIGHT_DIRECTIONAL => -Vec3::from(light.direction_ws),
            _ => Vec3::new(x, y, z) - position,
        };
        let (n, l, v) = (normal.try_normalize()?, to_light.try_normalize()?, (eye - position).try_normalize()?);
        let angle = |direction: Vec3| n.dot(direction).clamp(-1.0, 1.0).acos().to_degrees();
        // In the tangent plane. Where the light is at the normal, every azimuth is that of the mirror direction.
        let [away, towards_eye] = [-l, v].map(|direction| direction.reject_from_normalized(n).normalize_or_zero());
        let azimuth = n.dot(away.cross(towards_eye)).atan2(away.dot(towards_eye)).to_degrees();
        Some(Self { light_deg: angle(l), eye_deg: angle(v), azimuth_deg: azimuth })
    }

    /// Angle of the eye in the plane of incidence, degrees: positive on the side of the mirror direction. The eye itself may be beside
    /// this plane.
    pub(in crate::app) fn in_plane_deg(&self) -> f32 {
        if self.azimuth_deg.abs() <= 90.0 { self.eye_deg } else { -self.eye_deg }
    }

    /// Whether the eye is in the plane of incidence, within a degree.
    pub(in crate::app) fn is_in_plane(&self) -> bool {
        let apart = self.azimuth_deg.abs();
        apart.min(180.0 - apart) * self.eye_deg.to_radians().sin() < 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::LIGHT_POINT;

    fn point(at: [f32; 3]) -> Light {
        Light { kind: LIGHT_POINT, position_ws: [at[0], at[1], at[2], 0.0], ..Light::default() }
    }

    #[test]
    fn an_eye_in_the_mirror_direction_has_azimuth_0() {
        let found = Directions::new(Vec3::ZERO, Vec3::Y, Vec3::new(2.0, 2.0, 0.0), &point([-3.0, 3.0, 0.0])).unwrap();
        assert!((found.light_deg - 45.0).abs() < 1e-3 && (found.eye_deg - 45.0).abs() < 1e-3, "{found:?}");
        assert!(found.azimuth_deg.abs() < 1e-3 && found.is_in_plane(), "{found:?}");
        assert!((found.in_plane_deg() - 45.0).abs() < 1e-3);
    }

    #[test]
    fn an_eye_beside_the_light_is_on_the_negative_side() {
        let found = Directions::new(Vec3::ZERO, Vec3::Y, Vec3::new(-1.0, 2.0, 0.0), &point([-3.0, 3.0, 0.0])).unwrap();
        assert!(found.in_plane_deg() < 0.0 && found.is_in_plane(), "{found:?}");
        let aside = Directions::new(Vec3::ZERO, Vec3::Y, Vec3::new(0.0, 1.0, 1.0), &point([-3.0, 3.0, 0.0])).unwrap();
        assert!(!aside.is_in_plane() && (aside.azimuth_deg.abs() - 90.0).abs() < 1e-3, "{aside:?}");
    }

    #[test]
    fn a_sun_has_no_position_and_a_light_at_the_point_no_direction() {
        let sun = Light { kind: LIGHT_DIRECTIONAL, direction_ws: [0.0, -1.0, 0.0], ..Light::default() };
        let found = Directions::new(Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 1.0), &sun).unwrap();
        assert!(found.light_deg < 1e-3, "{found:?}");
        assert_eq!(Directions::new(Vec3::X, Vec3::Y, Vec3::Y, &point([1.0, 0.0, 0.0])), None);
        assert_eq!(Directions::new(Vec3::X, Vec3::ZERO, Vec3::Y, &sun), None);
    }
}
