//! Maps texels of an equirectangular image to directions, and integrates over all texels.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::Environment;

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

impl Environment {
    /// Mean radiance over the sphere, linear RGB, weighted by solid angle.
    pub fn mean_radiance(&self) -> Vec3 {
        (self.integrate(|_| 1.0) / (4.0 * PI)).as_vec3()
    }

    /// Irradiance of a surface with the unit normal `n`, linear RGB: the integral of radiance times cos(theta) over the
    /// hemisphere. Sums over every texel, as a reference for faster methods.
    pub fn irradiance(&self, n: Vec3) -> Vec3 {
        self.integrate(|direction| f64::from(direction.dot(n).max(0.0))).as_vec3()
    }

    /// Integral of radiance times `weight` over the sphere.
    fn integrate(&self, weight: impl Fn(Vec3) -> f64 + Sync) -> DVec3 {
        let (width, height) = (self.width as usize, self.height as usize);
        let directions = TexelDirections::new(width, height);
        let sums = self.pixels.par_chunks_exact(width.max(1)).enumerate().map(|(y, row)| {
            let texels = row.iter().zip(directions.row(y));
            let sum: DVec3 = texels.map(|(&[r, g, b, _], at)| Vec3::new(r, g, b).as_dvec3() * weight(at)).sum();
            sum * texel_solid_angle(y, width, height)
        });
        // Collecting the rows before summing gives the same bits for any number of threads.
        sums.collect::<Vec<_>>().into_iter().sum()
    }
}
