//! Compares two pictures, for the goldens, for `specula diff` and for the window.

mod fit;
pub mod report;
mod still;

use std::io::BufReader;
use std::path::Path;

use image::{DynamicImage, Rgb32FImage, RgbImage, Rgba32FImage, RgbaImage};
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool, flip, magma_lut};
use serde_json::{Value, json};

pub use still::Still;

use crate::regular_file;

/// A picture as stored in a file.
pub enum Picture {
    /// Display-encoded, 8 bits a channel, straight alpha.
    Display(RgbaImage),
    /// Linear floats in any unit.
    Raw(Rgba32FImage),
}

impl Picture {
    /// Reads a file. Its content, not its extension, determines the format.
    ///
    /// # Errors
    /// A message if the file cannot be read or decoded.
    pub fn open(path: &Path) -> Result<Self, String> {
        let error = |e: &dyn std::fmt::Display| format!("cannot read {}: {e}", path.display());
        let file = BufReader::new(regular_file::open(path).map_err(|e| error(&e))?);
        let decoded = image::ImageReader::new(file)
            .with_guessed_format()
            .map_err(|e| error(&e))?
            .decode()
            .map_err(|e| error(&e))?;
        Ok(match decoded {
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => Self::Raw(decoded.into_rgba32f()),
            _ => Self::Display(decoded.into_rgba8()),
        })
    }

    /// Width and height.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Display(image) => image.dimensions(),
            Self::Raw(image) => image.dimensions(),
        }
    }

    /// RGBA; 0..1 for display-encoded pictures.
    fn pixels(&self) -> Vec<[f32; 4]> {
        match self {
            Self::Display(image) => image.pixels().map(|pixel| pixel.0.map(|c| f32::from(c) / 255.0)).collect(),
            Self::Raw(image) => image.pixels().map(|pixel| pixel.0).collect(),
        }
    }
}

/// The metric of [`Comparison::error`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// Mean FLIP (Andersson et al. 2020), 0..1: the perceived difference at 0.7 m from a 4K screen, over middle gray.
    Flip,
    /// Root mean square of the difference over all pixels and channels, in the pictures' unit.
    Rmse,
}

/// The largest differences that pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {
    /// Largest [`Comparison::error`].
    pub max: f64,
    /// Largest [`Comparison::largest`], if that has a limit.
    pub max_channel: Option<f64>,
}

/// The comparison of two pictures of the same size.
pub struct Comparison {
    /// The metric of `error`: FLIP for display-encoded pictures, RMSE for raw ones.
    pub measure: Measure,
    /// 0 only if all pixels are equal. Infinite if a pixel is NaN or infinite in only one picture.
    pub error: f64,
    /// Largest difference of a channel, including alpha; infinite in the same case.
    pub largest: f64,
    /// The first pixel with the largest difference, from the top left.
    pub largest_at: (u32, u32),
    /// Number of pixels that differ.
    pub differing: usize,
    /// Number of all pixels.
    pub pixels: usize,
    map: DynamicImage,
}

impl Comparison {
    /// Compares `b` with `a`.
    ///
    /// # Errors
    /// A message if the sizes differ, or if one picture is display-encoded and the other raw.
    pub fn new(a: &Picture, b: &Picture) -> Result<Self, String> {
        let (width, height) = a.size();
        if b.size() != a.size() {
            let (other_width, other_height) = b.size();
            return Err(format!("{width}x{height} and {other_width}x{other_height} pixels cannot be compared"));
        }
        let differences = differences(&a.pixels(), &b.pixels());
        let mut largest = (0.0, 0);
        for (index, pixel) in differences.iter().enumerate() {
            let most = pixel.iter().fold(0.0_f32, |most, d| most.max(d.abs()));
            if most > largest.0 {
                largest = (most, index);
            }
        }
        let differing = differences.iter().filter(|pixel| pixel.iter().any(|d| *d != 0.0)).count();
        let (measure, error, map) = match (a, b) {
            (Picture::Display(a), Picture::Display(b)) => {
                let (mean, map) = flip_of(a, b)?;
                (Measure::Flip, mean, map)
            }
            (Picture::Raw(_), Picture::Raw(_)) => {
                let squares: f64 = differences.iter().flatten().map(|d| f64::from(*d) * f64::from(*d)).sum();
                let rmse = (squares / (4 * differences.len()).max(1) as f64).sqrt();
                (Measure::Rmse, rmse, raw_map(&differences, width, height)?)
            }
            _ => return Err("a display-encoded picture (PNG) and a raw one (EXR) cannot be compared".to_owned()),
        };
        // FLIP rounds invisible differences to 0, but 0 means equal.
        let error = if differing == 0 { 0.0 } else { error.max(f64::MIN_POSITIVE) };
        let index = largest.1 as u32;
        Ok(Self {
            measure,
            error,
            largest: largest.0.into(),
            largest_at: (index % width.max(1), index / width.max(1)),
            differing,
            pixels: differences.len(),
            map,
        })
    }

    /// Whether no difference is above the limits.
    pub fn passes(&self, limits: Limits) -> bool {
        self.error <= limits.max && limits.max_channel.is_none_or(|most| self.largest <= most)
    }

    /// How bad the differences are at some limits: greater is worse. One that fails is worse than one that passes; then counts by which factor it
    /// exceeds its nearest limit, which compares FLIP with RMSE. Without such a factor, as at a limit of 0, all RMSE come after all FLIP.
    pub fn badness(&self, limits: Limits) -> [u64; 6] {
        let beyond = |value: f64, limit: f64| {
            if value == 0.0 || limit == f64::INFINITY { 0.0 } else { value / limit.abs() }
        };
        let of_channel = limits.max_channel.map_or(0.0, |most| beyond(self.largest, most));
        let flag = |is_set: bool| f64::from(u8::from(is_set));
        let parts = [
            flag(!self.passes(limits)),
            beyond(self.error, limits.max).max(of_channel),
            flag(self.error == f64::INFINITY),
            flag(self.measure == Measure::Flip),
            self.error,
            self.largest,
        ];
        // The bits of floats that are not negative are in the order of the floats.
        parts.map(f64::to_bits)
    }

    /// The difference per pixel: FLIP in magma colors for display-encoded pictures, |a - b| for raw ones.
    pub fn map(&self) -> &DynamicImage {
        &self.map
    }
}

/// A comparison, or why there is none, as `specula diff --json` lists it.
pub fn listed(name: &str, compared: &Result<Comparison, String>, limits: Limits) -> Value {
    match compared {
        Err(why) => json!({ "name": name, "passes": false, "why": why }),
        Ok(found) => json!({ "name": name, "passes": found.passes(limits), "measure": found.measure,
            "error": found.error, "largest": found.largest, "largest_at": found.largest_at,
            "differing": found.differing, "pixels": found.pixels }),
    }
}

/// All of `specula diff --json`: the [`listed`] pictures, and the limits.
pub fn listed_all(pictures: Vec<Value>, limits: Limits) -> Value {
    let passes = pictures.iter().all(|picture| picture["passes"] == true);
    let mut all = json!({ "pictures": pictures, "max": limits.max, "passes": passes });
    if let Some(most) = limits.max_channel {
        all["max_channel"] = most.into();
    }
    all
}

/// b - a. 0 if both are equal or both NaN; infinite if the difference is not finite.
fn differences(a: &[[f32; 4]], b: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let difference = |a: f32, b: f32| match b - a {
        _ if a == b || (a.is_nan() && b.is_nan()) => 0.0,
        finite if finite.is_finite() => finite,
        _ => f32::INFINITY,
    };
    let pair = |(a, b): (&[f32; 4], &[f32; 4])| std::array::from_fn(|c| difference(a[c], b[c]));
    a.iter().zip(b).map(pair).collect()
}

fn flip_of(a: &RgbaImage, b: &RgbaImage) -> Result<(f64, DynamicImage), String> {
    let (width, height) = a.dimensions();
    let image = |of: &RgbaImage| FlipImageRgb8::with_data(width, height, &over_gray(of));
    let error = flip(image(a), image(b), DEFAULT_PIXELS_PER_DEGREE);
    let colors = error.apply_color_lut(&magma_lut());
    let map = RgbImage::from_raw(width, height, colors.to_vec()).ok_or("FLIP's map has another size")?;
    Ok((f64::from(FlipPool::from_image(&error).mean()), map.into()))
}

/// Composites over middle gray in encoded values, as browsers do.
fn over_gray(image: &RgbaImage) -> Vec<u8> {
    let blend = |c: u8, alpha: u8| {
        let (c, alpha) = (u32::from(c), u32::from(alpha));
        ((c * alpha + 128 * (255 - alpha) + 127) / 255) as u8
    };
    image.pixels().flat_map(|p| [0, 1, 2].map(|channel| blend(p.0[channel], p.0[3]))).collect()
}

fn raw_map(differences: &[[f32; 4]], width: u32, height: u32) -> Result<DynamicImage, String> {
    let floats = differences.iter().flat_map(|pixel| [0, 1, 2].map(|channel| pixel[channel].abs())).collect();
    let map = Rgb32FImage::from_raw(width, height, floats).ok_or("the difference has another size")?;
    Ok(map.into())
}
