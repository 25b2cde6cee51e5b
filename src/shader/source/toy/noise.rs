//! The images of samplers without one. For a channel, these are 256 x 256 random colors, as many shaders expect there.

use std::io::Cursor;

use image::{ImageFormat, Rgba, RgbaImage};

const SIDE: u32 = 256;

/// The image as a PNG file, the same at each call.
pub(super) fn png() -> Result<Vec<u8>, String> {
    let mut image = RgbaImage::new(SIDE, SIDE);
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        pixel.0 = hash(x + SIDE * y).to_le_bytes();
    }
    encoded(&image)
}

/// A black image as a PNG file, which WebGL reads from a sampler without one. It is twice as wide as high, so that it can be a cube map, or two layers.
pub(super) fn black() -> Result<Vec<u8>, String> {
    encoded(&RgbaImage::from_pixel(2, 1, Rgba([0, 0, 0, 255])))
}

fn encoded(image: &RgbaImage) -> Result<Vec<u8>, String> {
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, ImageFormat::Png).map_err(|error| error.to_string())?;
    Ok(out.into_inner())
}

/// PCG hash (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
