//! Reads Radiance HDR (RGBE): flat pixels, old and new run lengths; rows in all eight orders. The `image` crate reads the header
//! and all that is unusual. Rows with new run lengths, which nearly all files have, are decoded here, in parallel.

use std::ops::Range;

use image::ImageDecoder;
use image::codecs::hdr::{HdrDecoder, HdrMetadata};
use image::error::{ImageError, UnsupportedErrorKind};
use rayon::prelude::*;

use super::decoded::{Decoded, check_size};
use super::error::EnvironmentProblem as Problem;

/// Decodes a whole file.
pub fn decode(bytes: &[u8]) -> Result<Decoded, Problem> {
    let Some(order) = Order::of(bytes) else { return decode_in_order(bytes) };
    // The decoder knows only the usual order. In that, a file whose rows are columns is turned.
    let usual = [&bytes[..order.line.start], &order.usual_line[..], &bytes[order.line.end..]].concat();
    let Decoded { width, height, pixels, projection, warnings } = decode_in_order(&usual)?;
    let (width, height) = if order.has_columns { (height, width) } else { (width, height) };
    check_size(width.into(), height.into(), 0, 0)?;
    let (columns, rows) = (width as usize, height as usize);
    let from = |at: usize| {
        let (x, y) = (at % columns, at / columns);
        let (x, y) = (if order.flips_x { columns - 1 - x } else { x }, if order.flips_y { rows - 1 - y } else { y });
        pixels[if order.has_columns { x * rows + y } else { y * columns + x }]
    };
    let pixels = (0..pixels.len()).into_par_iter().map(from).collect();
    Ok(Decoded { width, height, pixels, projection, warnings })
}

/// The order of the pixels in a file, if it is another than `-Y height +X width`: from the top, and each row from the left.
struct Order {
    /// Where the header's last line, which names the order, is in the file.
    line: Range<usize>,
    /// The line for the usual order.
    usual_line: Vec<u8>,
    /// Whether the file has the picture's columns one after the other.
    has_columns: bool,
    flips_x: bool,
    flips_y: bool,
}

impl Order {
    fn of(bytes: &[u8]) -> Option<Self> {
        // The line after the empty one that ends the other lines of the header.
        let start = bytes.windows(2).position(|pair| pair == b"\n\n")? + 2;
        let end = start + bytes[start..].iter().position(|byte| *byte == b'\n')?;
        let text = std::str::from_utf8(&bytes[start..end]).ok()?;
        let words: [&str; 4] = text.split_ascii_whitespace().collect::<Vec<_>>().try_into().ok()?;
        let [first, lines, second, length] = words;
        if !matches!((first, second), ("+Y" | "-Y", "+X" | "-X") | ("+X" | "-X", "+Y" | "-Y"))
            || (first, second) == ("-Y", "+X")
        {
            return None;
        }
        let has = |axis: &str| [first, second].contains(&axis);
        Some(Self {
            line: start..end,
            usual_line: format!("-Y {lines} +X {length}").into_bytes(),
            has_columns: first.ends_with('X'),
            flips_x: has("-X"),
            flips_y: has("+Y"),
        })
    }
}

/// Decodes a file whose rows go from top to bottom.
fn decode_in_order(bytes: &[u8]) -> Result<Decoded, Problem> {
    // Non-strict: the strict decoder refuses files that begin with `#?RGBE`, which are common.
    let mut after_header = bytes;
    let metadata = HdrDecoder::new_nonstrict(&mut after_header).map_err(problem)?.metadata();
    let (columns, rows) = (u64::from(metadata.width), u64::from(metadata.height));
    let (width, height) = check_size(columns, rows, least_bytes(columns, rows), bytes.len())?;

    let (width_usize, height_usize) = (width as usize, height as usize);
    let mut pixels = vec![[0.0_f32; 4]; width_usize * height_usize];
    let factors = recorded_factors(&metadata)?;
    match run_length_rows(after_header, width_usize, height_usize) {
        Some(rows) => pixels.par_chunks_exact_mut(width_usize).zip(rows).for_each(|(to, row)| decode_row(row, to)),
        None => decode_unusual(bytes, &mut pixels)?,
    }
    let mut warnings = Vec::new();
    if let Some([r, g, b]) = factors {
        pixels.par_iter_mut().for_each(|pixel| *pixel = [pixel[0] / r, pixel[1] / g, pixel[2] / b, pixel[3]]);
        warnings.push(format!(
            "the header says that the pixels were multiplied by {r} {g} {b} (EXPOSURE, COLORCORR); Specula divides by it"
        ));
    }
    Ok(Decoded { width, height, pixels, projection: None, warnings })
}

/// Decodes flat pixels, old run lengths, and what is damaged, for which the decoder has the error.
fn decode_unusual(bytes: &[u8], pixels: &mut [[f32; 4]]) -> Result<(), Problem> {
    // The decoder writes three floats a pixel. They go to the start of the final buffer and are expanded in place from the back:
    // a second buffer for the largest image would take 1.5 GiB.
    let count = pixels.len();
    let floats: &mut [f32] = pixels.as_flattened_mut();
    let decoder = HdrDecoder::new_nonstrict(bytes).map_err(problem)?;
    decoder.read_image(bytemuck::cast_slice_mut(&mut floats[..3 * count])).map_err(problem)?;
    for pixel in (0..count).rev() {
        let [r, g, b] = [floats[3 * pixel], floats[3 * pixel + 1], floats[3 * pixel + 2]];
        floats[4 * pixel..4 * pixel + 4].copy_from_slice(&[r, g, b, 1.0]);
    }
    Ok(())
}

/// A run of one component: a count above this repeats the byte that follows, count - 128 times; others copy count bytes.
const LONGEST_COPY: u8 = 128;

/// The runs of each row, without its four bytes 2, 2 and the width (G. Ward, "Real Pixels", Graphics Gems II, 1991, and its
/// revision in Radiance 2). `None` if a row is not in this form, or is damaged.
fn run_length_rows(mut rest: &[u8], width: usize, height: usize) -> Option<Vec<&[u8]>> {
    let mut rows = Vec::with_capacity(height);
    for _ in 0..height {
        let ([2, 2, high, _], runs) = rest.split_first_chunk()? else { return None };
        if *high > 127 {
            return None;
        }
        let mut at = 0;
        for _ in 0..4 {
            let mut columns = 0;
            while columns < width {
                let count = *runs.get(at)?;
                let is_copy = count <= LONGEST_COPY;
                columns += usize::from(if is_copy { count } else { count - LONGEST_COPY });
                at += if is_copy { 1 + usize::from(count) } else { 2 };
            }
            if columns != width {
                return None;
            }
        }
        rows.push(runs.get(..at)?);
        rest = &runs[at..];
    }
    Some(rows)
}

/// Decodes a row of [`run_length_rows`], which has as many columns as `to`.
fn decode_row(mut runs: &[u8], to: &mut [[f32; 4]]) {
    let mut rgbe = vec![[0_u8; 4]; to.len()];
    for component in 0..4 {
        let mut column = 0;
        while column < to.len() {
            let (count, after) = (runs[0], &runs[1..]);
            let is_copy = count <= LONGEST_COPY;
            let columns = usize::from(if is_copy { count } else { count - LONGEST_COPY });
            let pixels = &mut rgbe[column..column + columns];
            if is_copy {
                pixels.iter_mut().zip(after).for_each(|(pixel, byte)| pixel[component] = *byte);
            } else {
                pixels.iter_mut().for_each(|pixel| pixel[component] = after[0]);
            }
            runs = &after[if is_copy { columns } else { 1 }..];
            column += columns;
        }
    }
    for (pixel, [r, g, b, e]) in to.iter_mut().zip(rgbe) {
        let scale = scale_of_exponent(e);
        *pixel = [f32::from(r) * scale, f32::from(g) * scale, f32::from(b) * scale, 1.0];
    }
}

/// 2^(e - 128 - 8); 0 stands for black.
fn scale_of_exponent(e: u8) -> f32 {
    // 2^(e - 128) in a float's exponent bits; that of e = 1 is below the smallest normal float.
    let bits = if e > 1 { (u32::from(e) - 1) << 23 } else { u32::from(e) << 22 };
    f32::from_bits(bits) / 256.0
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
            expected: "FORMAT=32-bit_rle_rgbe",
            todo: "Save it again from an image editor.",
        },
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            Problem::Damaged { format: "Radiance HDR", found: "the end of the file in the middle of a row".into() }
        }
        error => Problem::Damaged { format: "Radiance HDR", found: error.to_string() },
    }
}
