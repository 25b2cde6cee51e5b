//! Scales a picture to fit a rectangle, with its aspect and in the middle.

use image::{Rgba32FImage, RgbaImage};
use rayon::prelude::*;

use super::Picture;
use crate::gpu::Rect;

/// The color around a display-encoded picture: opaque black.
const BAR: [u8; 4] = [0, 0, 0, 255];

type Pixel = [f32; 4];

/// A picture that fits a size.
pub(super) struct Fitted {
    /// The scaled picture on a ground of the whole size.
    pub(super) picture: Picture,
    /// The part that the picture covers.
    pub(super) covered: Rect,
}

/// Scales `picture` to fit `size`. A picture of that size is returned unchanged, bit for bit.
pub(super) fn fit(picture: &Picture, size: (u32, u32)) -> Fitted {
    let from = picture.size();
    let covered = covered(from, size);
    let to = (covered.width, covered.height);
    let picture = match picture {
        Picture::Display(image) => {
            let scaled = if to == from { image.clone() } else { scaled_display(image, to) };
            let mut ground = RgbaImage::from_pixel(size.0, size.1, image::Rgba(BAR));
            image::imageops::replace(&mut ground, &scaled, covered.x.into(), covered.y.into());
            Picture::Display(ground)
        }
        Picture::Raw(image) => {
            let scaled = if to == from { image.clone() } else { scaled_raw(image, to) };
            // Nothing covers the ground, like the area behind a model.
            let mut ground = Rgba32FImage::new(size.0, size.1);
            image::imageops::replace(&mut ground, &scaled, covered.x.into(), covered.y.into());
            Picture::Raw(ground)
        }
    };
    Fitted { picture, covered }
}

/// The largest rectangle with the aspect of `from` in the middle of `size`.
fn covered(from: (u32, u32), size: (u32, u32)) -> Rect {
    let scale = (f64::from(size.0) / f64::from(from.0.max(1))).min(f64::from(size.1) / f64::from(from.1.max(1)));
    let side = |from: u32, most: u32| ((f64::from(from) * scale).round() as u32).clamp(1, most.max(1));
    let (width, height) = (side(from.0, size.0), side(from.1, size.1));
    Rect { x: size.0.saturating_sub(width) / 2, y: size.1.saturating_sub(height) / 2, width, height }
}

/// Filters in linear light, weighted by coverage.
fn scaled_display(image: &RgbaImage, to: (u32, u32)) -> RgbaImage {
    let linear: Vec<f32> = (0..=255_u8).map(|code| linear_of(f32::from(code) / 255.0)).collect();
    let pixel = |x: u32, y: u32| {
        let [r, g, b, a] = image.get_pixel(x, y).0;
        let alpha = f32::from(a) / 255.0;
        let [r, g, b] = [r, g, b].map(|code| linear[usize::from(code)] * alpha);
        [r, g, b, alpha]
    };
    let pixels = resampled(image.dimensions(), to, pixel);
    let code = |value: f32| (value * 255.0).round().clamp(0.0, 255.0) as u8;
    RgbaImage::from_fn(to.0, to.1, |x, y| {
        let [r, g, b, alpha] = pixels[(y * to.0 + x) as usize];
        let [r, g, b] = [r, g, b].map(|light| code(encoded(light / alpha.max(1e-6))));
        image::Rgba([r, g, b, code(alpha)])
    })
}

fn scaled_raw(image: &Rgba32FImage, to: (u32, u32)) -> Rgba32FImage {
    let pixels = resampled(image.dimensions(), to, |x, y| image.get_pixel(x, y).0);
    Rgba32FImage::from_fn(to.0, to.1, |x, y| image::Rgba(pixels[(y * to.0 + x) as usize]))
}

/// Samples along one axis: the first one, and the weight of each.
struct Taps {
    first: u32,
    weights: Vec<f32>,
}

/// A tent filter at least as wide as one pixel of either picture on each side.
fn taps(from: u32, to: u32) -> Vec<Taps> {
    let scale = from as f32 / to as f32;
    let radius = scale.max(1.0);
    let of = |index: u32| {
        let center = (index as f32 + 0.5) * scale - 0.5;
        let first = (center - radius).ceil().max(0.0) as u32;
        let last = ((center + radius).floor().max(0.0) as u32).min(from - 1);
        let first = first.min(last);
        let weight = |at: u32| (1.0 - (at as f32 - center).abs() / radius).max(0.0);
        let weights: Vec<f32> = (first..=last).map(weight).collect();
        let sum: f32 = weights.iter().sum();
        Taps { first, weights: weights.iter().map(|weight| weight / sum.max(1e-6)).collect() }
    };
    (0..to).map(of).collect()
}

/// The pixels of a picture at another size, row by row.
fn resampled(from: (u32, u32), to: (u32, u32), pixel: impl Fn(u32, u32) -> Pixel + Sync) -> Vec<Pixel> {
    let (columns, rows) = (taps(from.0, to.0), taps(from.1, to.1));
    let sum = |taps: &Taps, sample: &dyn Fn(u32) -> Pixel| {
        let mut all = [0.0; 4];
        for (at, weight) in (taps.first..).zip(&taps.weights) {
            let value = sample(at);
            (0..4).for_each(|channel| all[channel] += weight * value[channel]);
        }
        all
    };
    let narrow = |y: u32| columns.iter().map(|taps| sum(taps, &|x| pixel(x, y))).collect::<Vec<_>>();
    let wide: Vec<Vec<Pixel>> = (0..from.1).into_par_iter().map(narrow).collect();
    let row = |taps: &Taps| (0..to.0 as usize).map(|x| sum(taps, &|y| wide[y as usize][x])).collect::<Vec<_>>();
    rows.par_iter().flat_map_iter(row).collect()
}

/// The sRGB curve (IEC 61966-2-1).
fn linear_of(code: f32) -> f32 {
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

fn encoded(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_keeps_its_aspect_and_lies_in_the_middle() {
        assert_eq!(covered((100, 50), (200, 200)), Rect { x: 0, y: 50, width: 200, height: 100 });
        assert_eq!(covered((4000, 4000), (640, 480)), Rect { x: 80, y: 0, width: 480, height: 480 });
        assert_eq!(covered((10_000, 1), (100, 100)), Rect { x: 0, y: 49, width: 100, height: 1 });
    }

    #[test]
    fn the_same_size_changes_no_bit() {
        let image = RgbaImage::from_fn(7, 5, |x, y| image::Rgba([x as u8 * 30, y as u8 * 50, 3, 128]));
        let fitted = fit(&Picture::Display(image.clone()), (7, 5));
        assert!(matches!(fitted.picture, Picture::Display(fitted) if fitted == image));
    }

    #[test]
    fn scaling_keeps_the_mean_of_light_and_the_colors_of_edges() {
        // A checkerboard of black and white emits half of the light of white.
        let board = RgbaImage::from_fn(64, 64, |x, y| image::Rgba([[0, 0, 0, 255], [255; 4]][((x + y) % 2) as usize]));
        let small = scaled_display(&board, (8, 8));
        let center = small.get_pixel(4, 4).0[0];
        assert!((186..=189).contains(&center), "{center}");
        // Transparent pixels have no color.
        let half = RgbaImage::from_fn(2, 1, |x, _| image::Rgba([[200, 0, 0, 255], [0, 255, 0, 0]][x as usize]));
        let large = scaled_display(&half, (8, 4));
        assert!(large.pixels().all(|pixel| pixel[1] == 0 && (pixel[3] == 0 || pixel[0].abs_diff(200) <= 1)));
    }

    #[test]
    fn light_above_one_stays() {
        let bright = Rgba32FImage::from_pixel(9, 3, image::Rgba([40.0, 2.0, 0.0, 1.0]));
        let scaled = scaled_raw(&bright, (4, 2));
        assert!(scaled.pixels().all(|pixel| (pixel[0] - 40.0).abs() < 1e-3 && (pixel[3] - 1.0).abs() < 1e-5));
    }
}
