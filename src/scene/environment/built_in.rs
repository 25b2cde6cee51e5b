//! The environments that are part of the program, made by code.

use rayon::prelude::*;

use super::direction::TexelDirections;
use super::float_image::peak;
use super::{Environment, sky, studio};

/// Names of the built-in environments; the first is the default.
///
/// | name | what | radiance |
/// |---|---|---|
/// | `studio` | soft boxes in a dark, neutral room; 1024x512 | see `studio.rs` |
/// | `furnace` | white everywhere, for energy tests; 64x32 | 1 |
/// | `sky` | sun and clear sky over gray ground; 1024x512 | see `sky.rs` |
pub const BUILT_IN: [&str; 3] = ["studio", "furnace", "sky"];

/// Columns of the built-in images with structure; half as many rows.
const WIDTH: u32 = 1024;
const FURNACE_WIDTH: u32 = 64;

/// Name and version. Raise the version when the pixels change, so that caches of the old ones are not used.
pub fn identity(name: &str) -> String {
    format!("built-in environment {name}, version 1")
}

/// Makes one of [`BUILT_IN`].
pub fn make(name: &str) -> Environment {
    match name {
        "furnace" => render(FURNACE_WIDTH, |_| glam::Vec3::ONE),
        "sky" => sky::make(WIDTH),
        _ => studio::make(WIDTH),
    }
}

/// Fills an image with the radiance from each texel's center, `width` columns and half as many rows.
pub fn render(width: u32, radiance: impl Fn(glam::Vec3) -> glam::Vec3 + Sync) -> Environment {
    let (columns, rows) = (width as usize, width as usize / 2);
    let mut pixels = vec![[0.0; 4]; columns * rows];
    let directions = TexelDirections::new(columns, rows);
    pixels.par_chunks_exact_mut(columns).enumerate().for_each(|(y, row)| {
        for (pixel, direction) in row.iter_mut().zip(directions.row(y)) {
            *pixel = radiance(direction).extend(1.0).to_array();
        }
    });
    let peak = peak(&pixels);
    Environment { name: String::new(), width, height: width / 2, pixels, peak, warnings: Vec::new() }
}
