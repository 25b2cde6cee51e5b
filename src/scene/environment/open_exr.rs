//! Reads OpenEXR with the `exr` crate: the first flat part with channels R, G and B, or with luminance and perhaps chroma, in scan lines
//! or tiles. `subsampled.rs` reads channels with fewer samples than pixels.

use std::io::Cursor;

use exr::block::reader::Reader;
use exr::meta::attribute::EnvironmentMap;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, Vec2};

use super::decoded::{Decoded, check_size};
use super::error::EnvironmentProblem as Problem;
use super::primaries::{self, Primaries, REC_709};
use super::projection::{OPEN_EXR_CUBE, Projection};
use super::subsampled::Subsampled;

/// Flags in the version field (OpenEXR file layout, "Version Field").
const DEEP: u32 = 1 << 11;
const MULTI_PART: u32 = 1 << 12;
/// A picture may be this many times larger than the part of it that is stored.
const LARGEST_CROP: u64 = 64;

/// Decodes a whole file.
pub fn decode(bytes: &[u8]) -> Result<Decoded, Problem> {
    check_kind(bytes)?;
    let subsampled = Subsampled::find(bytes);
    let bytes = subsampled.as_ref().map_or(bytes, |file| &file.bytes);
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(problem)?;
    let headers = reader.headers();
    let (names, header) = part_with_color(headers)?;
    if header.deep {
        return Err(unsupported("a deep EXR (several samples a pixel)".into()));
    }
    let (columns, rows) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
    let stored = check_size(columns, rows, least_bytes(header, subsampled.is_some()), bytes.len())?;
    let mut warnings = Vec::new();
    if headers.len() > 1 {
        let name = header.own_attributes.layer_name.as_ref().map_or_else(String::new, ToString::to_string);
        warnings.push(format!("the EXR has {} parts: '{}' is used", headers.len(), name.escape_debug()));
    }
    let projection = header.own_attributes.environment_map.and_then(|map| match map {
        EnvironmentMap::LatitudeLongitude => Some(Projection::Equirectangular),
        EnvironmentMap::Cube if OPEN_EXR_CUBE.fits(stored.0, stored.1) => Some(Projection::Cube(&OPEN_EXR_CUBE)),
        EnvironmentMap::Cube => None,
    });
    let colors = header
        .shared_attributes
        .chromaticities
        .map_or(REC_709, |found| [found.red, found.green, found.blue, found.white].map(|Vec2(x, y)| (x, y)));
    // An environment map fills its data window, whatever picture it is a part of (ImfEnvmap.h).
    let window = if projection.is_some() { None } else { window(header)? };
    let mut pixels = match &subsampled {
        Some(file) => {
            let header = header.clone();
            file.read(reader, header, names)
        }
        None => read(reader, names, stored.0 as usize),
    }
    .map_err(problem)?;
    if names[0] == "Y" {
        from_luminance(&mut pixels, &colors);
    }
    if !primaries::are_equal(&colors, &REC_709) && primaries::convert(&mut pixels, &colors).is_none() {
        warnings.push("the EXR's chromaticities span no colors: its values are taken as Rec. 709".into());
    }
    let Some(window) = window else {
        return Ok(Decoded { width: stored.0, height: stored.1, pixels, projection, warnings });
    };
    let Window { size, offset } = window;
    warnings.push(format!(
        "the EXR stores {}x{} pixels at {}, {} of a picture of {}x{}: the rest is black",
        stored.0, stored.1, offset.0, offset.1, size.0, size.1
    ));
    let pixels = window.picture(&pixels, stored.0 as usize);
    Ok(Decoded { width: size.0, height: size.1, pixels, projection, warnings })
}

/// The first part with color, and the names of its channels. The crate, too, reads the first part that has the first of these channels.
fn part_with_color(headers: &[Header]) -> Result<([&'static str; 3], &Header), Problem> {
    let has = |header: &Header, name: &str| header.channels.list.iter().any(|channel| channel.name.eq(name));
    let first_with = |name| headers.iter().find(|header| has(header, name));
    match (first_with("R"), first_with("Y")) {
        (Some(header), _) if has(header, "G") && has(header, "B") => Ok((["R", "G", "B"], header)),
        (_, Some(header)) => Ok((["Y", "RY", "BY"], header)),
        _ => Err(without_color(headers)),
    }
}

/// Reads three channels of which every pixel has a sample. The second and the third may be missing.
fn read(reader: Reader<Cursor<&[u8]>>, names: [&str; 3], row: usize) -> exr::error::Result<Vec<[f32; 4]>> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required(names[0])
        .optional(names[1], 0.0_f32)
        .optional(names[2], 0.0_f32)
        .collect_pixels(
            |size, _| vec![[0.0, 0.0, 0.0, 1.0]; size.area()],
            move |pixels: &mut Vec<[f32; 4]>, at: Vec2<usize>, (a, b, c): (f32, f32, f32)| {
                pixels[at.y() * row + at.x()] = [a, b, c, 1.0];
            },
        )
        .first_valid_layer()
        .all_attributes()
        // The crate's own threads abort the process if a damaged file makes the decoder panic. On this thread, the
        // caller catches the panic.
        .non_parallel()
        .from_chunks(reader)?;
    Ok(image.layer_data.channel_data.pixels)
}

/// Converts luminance and chroma to RGB (ImfRgbaYca.h): RY = (R - Y) / Y, BY = (B - Y) / Y. Gray has a chroma of 0.
fn from_luminance(pixels: &mut [[f32; 4]], colors: &Primaries) {
    let luminance = |colors| primaries::xyz_from_rgb(colors).map(|matrix| matrix.row(1).as_vec3());
    let Some(weights) = luminance(colors).or_else(|| luminance(&REC_709)) else { return };
    for pixel in pixels {
        let [y, red, blue, _] = *pixel;
        let (r, b) = ((red + 1.0) * y, (blue + 1.0) * y);
        *pixel = [r, (y - r * weights.x - b * weights.z) / weights.y, b, 1.0];
    }
}

/// Refuses deep files by the version field, before their headers are read. Of several parts, some may be flat.
fn check_kind(bytes: &[u8]) -> Result<(), Problem> {
    let Some(version) = bytes.get(4..8) else {
        return Err(Problem::Damaged {
            format: "OpenEXR",
            found: format!("{} bytes, less than a header", bytes.len()),
        });
    };
    let flags = u32::from_le_bytes([version[0], version[1], version[2], version[3]]);
    match flags & (DEEP | MULTI_PART) {
        DEEP => Err(unsupported("a deep EXR (several samples a pixel)".into())),
        _ => Ok(()),
    }
}

/// The smallest possible size: each chunk has 8 bytes in the offset table and 8 bytes of its own, and only compression
/// and subsampling make the pixels smaller.
fn least_bytes(header: &Header, is_subsampled: bool) -> u64 {
    let chunks = header.chunk_count as u64 * 16;
    let stored_whole = header.compression == exr::compression::Compression::Uncompressed && !is_subsampled;
    chunks + if stored_whole { header.total_pixel_bytes() as u64 } else { 0 }
}

fn without_color(headers: &[Header]) -> Problem {
    let channels = headers.iter().flat_map(|header| &header.channels.list);
    let names: Vec<String> = channels.map(|channel| channel.name.to_string()).collect();
    Problem::Unsupported {
        found: format!("an EXR with the channels {}", names.join(", ")),
        expected: "channels R, G and B, or Y",
        todo: "Export its color as a plain RGB image, without layer names.",
    }
}

/// The picture of which a file stores a part, or more than it.
struct Window {
    size: (u32, u32),
    /// From the picture's corner to that of the stored pixels.
    offset: (i64, i64),
}

impl Window {
    /// The picture, black where nothing is stored.
    fn picture(&self, stored: &[[f32; 4]], stored_width: usize) -> Vec<[f32; 4]> {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let mut whole = vec![[0.0, 0.0, 0.0, 1.0]; width * height];
        for (y, row) in stored.chunks_exact(stored_width).enumerate() {
            let Some(y) = usize::try_from(y as i64 + self.offset.1).ok().filter(|y| *y < height) else { continue };
            for (x, pixel) in row.iter().enumerate() {
                if let Some(x) = usize::try_from(x as i64 + self.offset.0).ok().filter(|x| *x < width) {
                    whole[y * width + x] = *pixel;
                }
            }
        }
        whole
    }
}

/// `None` if the whole picture is stored, and nothing else.
fn window(header: &Header) -> Result<Option<Window>, Problem> {
    let display = header.shared_attributes.display_window;
    let position = header.own_attributes.layer_position;
    if display.position == position && display.size == header.layer_size {
        return Ok(None);
    }
    let (width, height) = (display.size.width() as u64, display.size.height() as u64);
    let size = check_size(width, height, 0, 0)?;
    if width * height > LARGEST_CROP * header.layer_size.area() as u64 {
        return Err(unsupported(format!(
            "an EXR that stores less than 1/{LARGEST_CROP} of its picture of {width}x{height}"
        )));
    }
    let offset = |of: fn(&Vec2<i32>) -> i32| i64::from(of(&position)) - i64::from(of(&display.position));
    Ok(Some(Window { size, offset: (offset(|v| v.x()), offset(|v| v.y())) }))
}

fn unsupported(found: String) -> Problem {
    Problem::Unsupported {
        found,
        expected: "a flat part with channels R, G and B, or Y",
        todo: "Export it as a plain RGB image.",
    }
}

fn problem(error: exr::error::Error) -> Problem {
    match error {
        exr::error::Error::NotSupported(what) => unsupported(format!("an EXR that needs: {what}")),
        exr::error::Error::Invalid(what) => Problem::Damaged { format: "OpenEXR", found: what.into_owned() },
        other => Problem::Damaged { format: "OpenEXR", found: other.to_string() },
    }
}
