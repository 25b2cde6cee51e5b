//! Maps texels of an equirectangular image to directions and solid angles.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};

/// World direction (unit, +Y up) of a point of an equirectangular image. `u` runs from the left edge, `v` from the top,
/// both 0..1. The center column (u = 0.5) looks down -Z, u = 0.75 looks down +X, v = 0 is +Y.
pub fn direction_from_uv(u: f32, v: f32) -> Vec3 {
    direction(f64::from(u), f64::from(v)).as_vec3()
}

/// Inverse of [`direction_from_uv`] for any non-zero direction: u = 0.5 + atan2(x, -z) / 2 pi, v = acos(y) / pi.
pub fn uv_from_direction(direction: Vec3) -> Vec2 {
    let d = direction.as_dvec3().normalize_or(DVec3::Y);
    // atan2 instead of acos, which loses half of its digits near the poles.
    let v = d.x.hypot(d.z).atan2(d.y) / PI;
    Vec2::new((0.5 + d.x.atan2(-d.z) / TAU) as f32, v as f32)
}

fn direction(u: f64, v: f64) -> DVec3 {
    from_angles((v * PI).sin_cos(), ((u - 0.5) * TAU).sin_cos())
}

/// Takes both angles as (sine, cosine): theta from +Y, phi from -Z towards +X.
fn from_angles((sin_theta, cos_theta): (f64, f64), (sin_phi, cos_phi): (f64, f64)) -> DVec3 {
    DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
}

/// World directions of all texel centers. Caches sine and cosine of the columns, which would dominate the cost.
pub(super) struct TexelDirections {
    columns: Vec<(f64, f64)>,
    height: usize,
}

impl TexelDirections {
    pub fn new(width: usize, height: usize) -> Self {
        let columns = (0..width).map(|x| (((x as f64 + 0.5) / width as f64 - 0.5) * TAU).sin_cos()).collect();
        Self { columns, height }
    }

    /// The directions of one row, from left to right.
    pub fn row(&self, y: usize) -> impl Iterator<Item = Vec3> {
        let theta = ((y as f64 + 0.5) / self.height as f64 * PI).sin_cos();
        self.columns.iter().map(move |phi| from_angles(theta, *phi).as_vec3())
    }
}

/// Solid angle of each texel of row `y`, steradians. It is exact: the band's height cos(theta0) - cos(theta1) times
/// 2 pi / width.
pub(super) fn texel_solid_angle(y: usize, width: usize, height: usize) -> f64 {
    let cos_theta = |edge: usize| (edge as f64 / height as f64 * PI).cos();
    (cos_theta(y) - cos_theta(y + 1)) * TAU / width as f64
}
