//! Decodes the bytes of an image file into a validated [`Environment`].

use glam::Mat3;
use rayon::prelude::*;

use super::decoded::{Decoded, MAX_WIDTH};
use super::error::EnvironmentProblem as Problem;
use super::panorama::peak;
use super::projection::Projection;
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

/// Makes the image equirectangular and validates every value, since later stages integrate and would spread a single NaN everywhere.
fn finish(decoded: Decoded) -> Result<Environment, Problem> {
    let Decoded { width, height, mut pixels, projection, mut warnings } = decoded;
    let bad = |pixel: &[f32; 4]| !pixel.iter().all(|value| value.is_finite());
    if let Some(first) = pixels.par_iter().position_first(bad) {
        let channel = pixels[first].iter().position(|value| !value.is_finite()).unwrap_or(0);
        return Err(Problem::Values {
            count: pixels.par_iter().filter(|pixel| bad(pixel)).count(),
            value: pixels[first][channel],
            channel: ["red", "green", "blue", "alpha"][channel],
            x: first % width as usize,
            y: first / width as usize,
        });
    }
    // Filters with negative weights, and colors that Rec. 709 does not have, leave such values.
    let negative: Vec<f32> = pixels
        .par_iter_mut()
        .filter_map(|pixel| {
            let least = pixel.iter().copied().fold(0.0, f32::min);
            *pixel = pixel.map(|value| value.max(0.0));
            (least < 0.0).then_some(least)
        })
        .collect();
    if !negative.is_empty() {
        let (count, least) = (negative.len(), negative.into_iter().fold(0.0, f32::min));
        let subject = if count == 1 {
            "1 pixel of the environment is".into()
        } else {
            format!("{count} pixels of the environment are")
        };
        warnings.push(format!("{subject} negative, down to {least}: 0 is used, since light is not negative"));
    }
    let (width, height, pixels) = match projection.or_else(|| Projection::of_shape(width, height)) {
        Some(Projection::Cube(layout)) => {
            warnings.push(format!("the environment's {width}x{height} pixels are read as {}", layout.name));
            layout.unwrap((width, height), &pixels, MAX_WIDTH, Mat3::IDENTITY)
        }
        Some(Projection::Equirectangular) => (width, height, pixels),
        None => {
            warnings.push(format!(
                "the environment has {width}x{height} pixels; expected twice as many columns as rows (equirectangular), or a cube as a \
                 cross of 4:3 or 3:4 or a strip of 6:1 or 1:6. It is stretched over the whole sphere"
            ));
            (width, height, pixels)
        }
    };
    let peak = peak(&pixels);
    if peak == 0.0 {
        warnings.push("the environment is black everywhere: it gives no light".into());
    }
    Ok(Environment { name: String::new(), width, height, pixels, peak, warnings })
}
