//! Decodes the bytes of an image file into a validated [`Environment`].

use rayon::prelude::*;

use super::decoded::Decoded;
use super::error::EnvironmentProblem as Problem;
use super::panorama::peak;
use super::{Environment, open_exr, radiance};
use crate::message::catch_panic;

/// Decodes a file; its content determines the format. The caller sets the name.
pub fn decode(bytes: &[u8]) -> Result<Environment, Problem> {
    let reader = match bytes {
        [] => return Err(Problem::Empty),
        [b'#', b'?', ..] => radiance::decode,
        [0x76, 0x2f, 0x31, 0x01, ..] => open_exr::decode,
        _ => return Err(another_format(bytes)),
    };
    // A panic here is a bug of the decoder. It must not end the user's session, so it becomes an error.
    let decoded = catch_panic(|| reader(bytes)).unwrap_or_else(|found| Err(Problem::Refused { found }))?;
    finish(decoded)
}

fn another_format(bytes: &[u8]) -> Problem {
    match image::guess_format(bytes) {
        Ok(format) => Problem::LowDynamicRange { found: format!("{format:?}").to_uppercase() },
        // A look may name any file, whose bytes a message must not print.
        Err(_) => Problem::UnknownFormat { bytes: bytes.len() },
    }
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
