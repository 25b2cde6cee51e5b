//! The view that just fits a model.

use glam::Vec3;

use super::view::{CameraView, sane_fovy};
use crate::scene::model::Bounds;
use crate::settings::CameraSettings;

/// The framed model fills this fraction of the picture's width or height.
pub(super) const FILL: f32 = 1.0 / 1.08;

/// The view without a camera of the model. Without `eye`, this fits the model's outline (or its bounding box) into the
/// picture with a margin, seen from `azimuth` (degrees from +Z towards +X) and `elevation`.
pub(super) fn frame(bounds: &Bounds, outline: &[Vec3], settings: &CameraSettings, aspect: f32) -> CameraView {
    let corners = bounds.corners();
    let outline = if outline.is_empty() { &corners } else { outline };
    let aspect = if aspect.is_finite() && aspect > 0.0 { aspect } else { 1.0 };
    let fovy_rad = sane_fovy(settings.fovy.to_radians());
    let number = |degrees: f32| if degrees.is_finite() { degrees.to_radians() } else { 0.0 };
    let (framed_eye, framed_target) =
        fit(bounds, outline, number(settings.azimuth), number(settings.elevation), fovy_rad, aspect);
    let (eye, target) = match (settings.eye.map(Vec3::from), settings.target.map(Vec3::from)) {
        (None, None) => (framed_eye, framed_target),
        (None, Some(target)) => (target + (framed_eye - framed_target), target),
        (Some(eye), None) => (eye, bounds.center()),
        (Some(eye), Some(target)) => (eye, target),
    };
    let mut view = CameraView::new(eye, target, fovy_rad, aspect, bounds);
    if settings.eye.is_none() {
        // When looking straight down, the azimuth still determines which direction is up.
        let (_, _, up) = basis(number(settings.azimuth), number(settings.elevation));
        view.up = up.reject_from_normalized(view.forward()).normalize_or(view.up);
    }
    view
}

/// Unit vectors back (towards the eye), right and up.
fn basis(azimuth_rad: f32, elevation_rad: f32) -> (Vec3, Vec3, Vec3) {
    let (sin_a, cos_a) = azimuth_rad.sin_cos();
    let back = direction(azimuth_rad, elevation_rad);
    let right = Vec3::new(cos_a, 0.0, -sin_a);
    (back, right, back.cross(right))
}

/// Unit vector at an azimuth (from +Z towards +X) and an elevation above the horizon.
pub(crate) fn direction(azimuth_rad: f32, elevation_rad: f32) -> Vec3 {
    let (sin_a, cos_a) = azimuth_rad.sin_cos();
    let (sin_e, cos_e) = elevation_rad.sin_cos();
    Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}

/// Eye and target at which the points just fit. In camera space, with t the tangent of half the usable angle, a point
/// (x, z) is inside if |x - eye.x| <= t (eye.z - z). These are two linear bounds per axis; the closest eye meets both
/// with equality.
fn fit(
    bounds: &Bounds,
    points: &[Vec3],
    azimuth_rad: f32,
    elevation_rad: f32,
    fovy_rad: f32,
    aspect: f32,
) -> (Vec3, Vec3) {
    let (back, right, up) = basis(azimuth_rad, elevation_rad);
    let center = bounds.center();
    let tan_y = (fovy_rad * 0.5).tan() * FILL;
    let tan_x = tan_y * aspect;
    // If there is nothing to fit, or a single point, this fits a sphere of radius 1.
    let solid = !bounds.is_empty() && (bounds.max - bounds.min).max_element() > 0.0;
    if !solid {
        return (center + back * (bounds.radius() / tan_y.min(tan_x)).max(1.0), center);
    }
    let axis = |side: Vec3, tan: f32| {
        let most = |sign: f32| {
            let reach = |point: &Vec3| sign * (*point - center).dot(side) + tan * (*point - center).dot(back);
            points.iter().map(reach).fold(f32::NEG_INFINITY, f32::max)
        };
        let (high, low) = (most(1.0), most(-1.0));
        ((high - low) * 0.5, (high + low) / (2.0 * tan))
    };
    let (x, distance_x) = axis(right, tan_x);
    let (y, distance_y) = axis(up, tan_y);
    let target = center + right * x + up * y;
    (target + back * distance_x.max(distance_y), target)
}
