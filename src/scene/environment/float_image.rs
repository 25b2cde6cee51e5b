//! Decodes the bytes of an image file into a validated [`Environment`].

use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;

use super::error::EnvironmentProblem as Problem;
use super::{Environment, MAX_HEIGHT, MAX_WIDTH, open_exr, radiance};

/// A decoded image, rows from top to bottom. Its values are not validated yet.
pub struct Decoded {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// RGB and an alpha of 1.
    pub pixels: Vec<[f32; 4]>,
    /// Conversions that the file's author may not expect.
    pub warnings: Vec<String>,
}

/// Decodes a file; its content determines the format. The caller sets the name.
pub fn decode(bytes: &[u8]) -> Result<Environment, Problem> {
    let reader = match bytes {
        [] => return Err(Problem::Empty),
        [b'#', b'?', ..] => radiance::decode,
        [0x76, 0x2f, 0x31, 0x01, ..] => open_exr::decode,
        _ => return Err(another_format(bytes)),
    };
    // A panic here is a bug of the decoder. It must not end the user's session, so it becomes an error.
    let decoded = catch_unwind(AssertUnwindSafe(|| reader(bytes))).unwrap_or_else(|panic| {
        let words =
            panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
        Err(Problem::Refused { found: words.unwrap_or("no message").to_owned() })
    })?;
    finish(decoded)
}

fn another_format(bytes: &[u8]) -> Problem {
    match image::guess_format(bytes) {
        Ok(format) => Problem::LowDynamicRange { found: format!("{format:?}").to_uppercase() },
        Err(_) => {
            let first: Vec<String> = bytes.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
            Problem::UnknownFormat { found: format!("{} bytes that begin with {}", bytes.len(), first.join(" ")) }
        }
    }
}

/// Refuses a size outside the limits, or one that `available` bytes cannot hold, before anything is allocated.
/// `least_bytes` is the smallest possible size of such an image in this format.
pub fn check_size(width: u64, height: u64, least_bytes: u64, available: usize) -> Result<(u32, u32), Problem> {
    let in_bounds = |size: u64, most: u32| u32::try_from(size).ok().filter(|size| (1..=most).contains(size));
    let (Some(columns), Some(rows)) = (in_bounds(width, MAX_WIDTH), in_bounds(height, MAX_HEIGHT)) else {
        return Err(Problem::Size { width, height });
    };
    let found = available as u64;
    if found < least_bytes {
        return Err(Problem::TooShort { width: columns, height: rows, expected: least_bytes, found });
    }
    Ok((columns, rows))
}

/// Validates every value, since later stages integrate and would spread a single NaN everywhere.
fn finish(decoded: Decoded) -> Result<Environment, Problem> {
    let Decoded { width, height, pixels, mut warnings } = decoded;
    let is_light = |value: &f32| value.is_finite() && *value >= 0.0;
    let bad = |pixel: &[f32; 4]| !pixel.iter().all(is_light);
    if let Some(first) = pixels.par_iter().position_first(bad) {
        let channel = pixels[first].iter().position(|value| !is_light(value)).unwrap_or(0);
        return Err(Problem::Values {
            count: pixels.par_iter().filter(|pixel| bad(pixel)).count(),
            value: pixels[first][channel],
            channel: ["red", "green", "blue", "alpha"][channel],
            x: first % width as usize,
            y: first / width as usize,
        });
    }
    let peak = peak(&pixels);
    if peak == 0.0 {
        warnings.push("the environment is black everywhere: it gives no light".into());
    }
    if u64::from(width) != 2 * u64::from(height) {
        warnings.push(format!(
            "the environment has {width}x{height} pixels; expected twice as many columns as rows (equirectangular). \
             It is stretched over the whole sphere"
        ));
    }
    Ok(Environment { name: String::new(), width, height, pixels, peak, warnings })
}

/// Largest value of red, green and blue.
pub fn peak(pixels: &[[f32; 4]]) -> f32 {
    pixels.par_iter().map(|&[r, g, b, _]| r.max(g).max(b)).reduce(|| 0.0, f32::max)
}
