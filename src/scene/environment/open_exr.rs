//! Reads OpenEXR with the `exr` crate: one flat part with channels R, G and B, in scan lines or tiles.

use std::io::Cursor;

use exr::meta::attribute::Chromaticities;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, Vec2};

use super::decoded::{Decoded, check_size};
use super::error::EnvironmentProblem as Problem;

/// Flags in the version field (OpenEXR file layout, "Version Field").
const DEEP: u32 = 1 << 11;
const MULTI_PART: u32 = 1 << 12;
/// CIE xy of the Rec. 709 primaries and white point, which an EXR has by default.
const REC_709: [(f32, f32); 4] = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290)];

/// Decodes a whole file.
pub fn decode(bytes: &[u8]) -> Result<Decoded, Problem> {
    check_kind(bytes)?;
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(problem)?;
    let [header] = reader.headers() else { return Err(unsupported("an EXR with several parts".into())) };
    let (columns, rows) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
    let (width, height) = check_size(columns, rows, least_bytes(header), bytes.len())?;
    check_channels(header)?;
    check_window(header)?;
    let mut warnings = Vec::new();
    warnings.extend(header.shared_attributes.chromaticities.as_ref().and_then(other_primaries));

    let row = width as usize;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| vec![[0.0, 0.0, 0.0, 1.0]; size.area()],
            move |pixels: &mut Vec<[f32; 4]>, at: Vec2<usize>, (r, g, b): (f32, f32, f32)| {
                pixels[at.y() * row + at.x()] = [r, g, b, 1.0];
            },
        )
        .first_valid_layer()
        .all_attributes()
        // The crate's own threads abort the process if a damaged file makes the decoder panic. On this thread, the
        // caller catches the panic.
        .non_parallel()
        .from_chunks(reader)
        .map_err(problem)?;
    Ok(Decoded { width, height, pixels: image.layer_data.channel_data.pixels, warnings })
}

/// Refuses deep and multi-part files by the version field, before their headers are read.
fn check_kind(bytes: &[u8]) -> Result<(), Problem> {
    let Some(version) = bytes.get(4..8) else {
        return Err(Problem::Damaged {
            format: "OpenEXR",
            found: format!("{} bytes, less than a header", bytes.len()),
        });
    };
    let flags = u32::from_le_bytes([version[0], version[1], version[2], version[3]]);
    match flags {
        _ if flags & DEEP != 0 => Err(unsupported("a deep EXR (several samples a pixel)".into())),
        _ if flags & MULTI_PART != 0 => Err(unsupported("an EXR with several parts".into())),
        _ => Ok(()),
    }
}

/// The smallest possible size: each chunk has 8 bytes in the offset table and 8 bytes of its own, and only compression
/// makes the pixels smaller.
fn least_bytes(header: &Header) -> u64 {
    let chunks = header.chunk_count as u64 * 16;
    let stored_whole = header.compression == exr::compression::Compression::Uncompressed;
    chunks + if stored_whole { header.total_pixel_bytes() as u64 } else { 0 }
}

fn check_channels(header: &Header) -> Result<(), Problem> {
    let channels = &header.channels.list;
    let name = |channel: &exr::meta::attribute::ChannelDescription| channel.name.to_string();
    let missing = ["R", "G", "B"].into_iter().any(|wanted| !channels.iter().any(|channel| channel.name.eq(wanted)));
    if missing {
        let names: Vec<String> = channels.iter().map(name).collect();
        return Err(Problem::Unsupported {
            found: format!("an EXR with the channels {}", names.join(", ")),
            expected: "channels R, G and B",
            todo: "Export its color as a plain RGB image, without layer names.",
        });
    }
    match channels.iter().find(|channel| channel.sampling != Vec2(1, 1)) {
        Some(channel) => Err(unsupported(format!("an EXR whose channel {} is subsampled", channel.name))),
        None => Ok(()),
    }
}

/// Refuses crops and overscan, which would shift the directions of all texels.
fn check_window(header: &Header) -> Result<(), Problem> {
    let display = header.shared_attributes.display_window;
    let position = header.own_attributes.layer_position;
    if display.position == position && display.size == header.layer_size {
        return Ok(());
    }
    let (size, whole) = (header.layer_size, display.size);
    Err(Problem::Unsupported {
        found: format!(
            "an EXR that stores {}x{} pixels at {}, {} of a picture of {}x{} at {}, {}",
            size.width(),
            size.height(),
            position.x(),
            position.y(),
            whole.width(),
            whole.height(),
            display.position.x(),
            display.position.y()
        ),
        expected: "the whole picture",
        todo: "Export it without crop and overscan.",
    })
}

fn other_primaries(found: &Chromaticities) -> Option<String> {
    let found = [found.red, found.green, found.blue, found.white].map(|Vec2(x, y)| (x, y));
    let far = |(a, b): (&(f32, f32), &(f32, f32))| (a.0 - b.0).abs().max((a.1 - b.1).abs()) > 0.005;
    found.iter().zip(&REC_709).any(far).then(|| {
        "the EXR declares primaries other than Rec. 709 (sRGB). Specula does not convert them, so colors are off. \
         Export it as linear sRGB"
            .to_owned()
    })
}

fn unsupported(found: String) -> Problem {
    Problem::Unsupported {
        found,
        expected: "one flat part with channels R, G and B",
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
