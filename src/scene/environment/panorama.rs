//! An environment as an equirectangular image, and integrals over all of its texels.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::direction::{TexelDirections, texel_solid_angle};

/// Radiance from every direction, linear RGB times cd/m^2, as an equirectangular image. [`super::direction_from_uv`] maps texels to
/// directions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Environment {
    /// The built-in name, or the file's name without its extension.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Radiance, linear RGB with Rec. 709 primaries; alpha is 1. Rows from top (+Y) to bottom, `width * height` in all;
    /// every value is finite and not negative.
    pub pixels: Vec<[f32; 4]>,
    /// Largest value of any channel.
    pub peak: f32,
    /// Warnings for the user, such as an unusual aspect ratio or an all-black image.
    pub warnings: Vec<String>,
}

impl Environment {
    /// Evaluates `radiance` at the center of each texel of an image with `width` columns and half as many rows.
    pub fn render(width: u32, radiance: impl Fn(Vec3) -> Vec3 + Sync) -> Self {
        let (columns, rows) = (width as usize, width as usize / 2);
        let mut pixels = vec![[0.0; 4]; columns * rows];
        let directions = TexelDirections::new(columns, rows);
        pixels.par_chunks_exact_mut(columns).enumerate().for_each(|(y, row)| {
            for (pixel, direction) in row.iter_mut().zip(directions.row(y)) {
                *pixel = radiance(direction).extend(1.0).to_array();
            }
        });
        let peak = peak(&pixels);
        Self { name: String::new(), width, height: width / 2, pixels, peak, warnings: Vec::new() }
    }

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

/// Largest value of red, green and blue.
pub fn peak(pixels: &[[f32; 4]]) -> f32 {
    pixels.par_iter().map(|&[r, g, b, _]| r.max(g).max(b)).reduce(|| 0.0, f32::max)
}
