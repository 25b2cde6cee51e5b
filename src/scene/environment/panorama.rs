//! An environment as an equirectangular image.

use glam::Vec3;
use rayon::prelude::*;

use super::direction::TexelDirections;

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
}

/// Largest value of red, green and blue.
pub fn peak(pixels: &[[f32; 4]]) -> f32 {
    pixels.par_iter().map(|&[r, g, b, _]| r.max(g).max(b)).reduce(|| 0.0, f32::max)
}
