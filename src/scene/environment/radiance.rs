//! Reads Radiance HDR (RGBE) with the `image` crate: flat pixels, old and new run lengths; rows from top to bottom.

use image::ImageDecoder;
use image::codecs::hdr::{HdrDecoder, HdrMetadata};
use image::error::{ImageError, UnsupportedErrorKind};

use super::error::EnvironmentProblem as Problem;
use super::float_image::{Decoded, check_size};

/// Decodes a whole file.
pub fn decode(bytes: &[u8]) -> Result<Decoded, Problem> {
    // Non-strict: the strict decoder refuses files that begin with `#?RGBE`, which are common.
    let decoder = HdrDecoder::new_nonstrict(bytes).map_err(problem)?;
    let metadata = decoder.metadata();
    let (columns, rows) = (u64::from(metadata.width), u64::from(metadata.height));
    let (width, height) = check_size(columns, rows, least_bytes(columns, rows), bytes.len())?;

    // The decoder writes three floats a pixel. They go to the front of the final buffer and are spread out in place
    // from the back: a second buffer for the largest image would take 1.5 GiB.
    let count = width as usize * height as usize;
    let mut pixels = vec![[0.0_f32; 4]; count];
    let floats: &mut [f32] = pixels.as_flattened_mut();
    decoder.read_image(bytemuck::cast_slice_mut(&mut floats[..3 * count])).map_err(problem)?;
    for pixel in (0..count).rev() {
        let [r, g, b] = [floats[3 * pixel], floats[3 * pixel + 1], floats[3 * pixel + 2]];
        floats[4 * pixel..4 * pixel + 4].copy_from_slice(&[r, g, b, 1.0]);
    }
    let mut warnings = Vec::new();
    if let Some(factors) = recorded_factors(&metadata)? {
        for pixel in &mut pixels {
            for (value, factor) in pixel.iter_mut().zip(factors) {
                *value /= factor;
            }
        }
        let [r, g, b] = factors;
        warnings.push(format!(
            "the header says that the pixels were multiplied by {r} {g} {b} (EXPOSURE, COLORCORR); Specula divides by it"
        ));
    }
    Ok(Decoded { width, height, pixels, warnings })
}

/// The smallest possible size. A row with new run lengths takes 4 bytes, and 2 for each run of 127 in each of 4
/// components. One with old run lengths takes as little as a pixel and a marker, or a single pixel if it has one
/// column.
fn least_bytes(width: u64, height: u64) -> u64 {
    let new = 4 + 4 * 2 * width.div_ceil(127);
    height * new.min(if width > 1 { 8 } else { 4 })
}

/// The factors by which the writer multiplied the radiance, RGB; `None` if all are 1.
fn recorded_factors(metadata: &HdrMetadata) -> Result<Option<[f32; 3]>, Problem> {
    let exposure = metadata.exposure.unwrap_or(1.0);
    let (r, g, b) = metadata.color_correction.unwrap_or((1.0, 1.0, 1.0));
    let factors = [r, g, b].map(|correction| correction * exposure);
    if !factors.iter().all(|factor| factor.is_normal() && *factor > 0.0) {
        return Err(Problem::Unsupported {
            found: format!("an HDR image with an EXPOSURE times COLORCORR of {factors:?} in its header"),
            expected: "positive factors",
            todo: "Correct those lines of the header or remove them.",
        });
    }
    Ok((factors != [1.0; 3]).then_some(factors))
}

fn problem(error: ImageError) -> Problem {
    match error {
        ImageError::Unsupported(unsupported) => Problem::Unsupported {
            found: match unsupported.kind() {
                UnsupportedErrorKind::Format(hint) => format!("an HDR image with the pixel format {hint}"),
                UnsupportedErrorKind::GenericFeature(feature) => format!("an HDR image with: {feature}"),
                _ => unsupported.to_string(),
            },
            expected: "FORMAT=32-bit_rle_rgbe and rows from top to bottom (-Y height +X width)",
            todo: "Save it again from an image editor.",
        },
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            Problem::Damaged { format: "Radiance HDR", found: "the end of the file in the middle of a row".into() }
        }
        error => Problem::Damaged { format: "Radiance HDR", found: error.to_string() },
    }
}
