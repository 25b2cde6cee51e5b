//! Decodes KTX2 textures into RGBA with 8 bits a channel: Basis Universal (`KHR_texture_basisu`) and the common plain formats. Smaller
//! levels in the file are not used: `scene::mips` computes them, as for every other image.

use std::io::Read;

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use half::f16;
use ktx2::{Format, Header, LevelIndex, SupercompressionScheme};

use crate::scene::mips::encode_srgb;

/// The first bytes of a file.
const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// Whether a file begins as KTX2 does.
pub fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Width, height and pixels of the largest level, or the reason of a failure. `largest`: the maximum of width and height.
pub fn pixels(bytes: &[u8], largest: u32) -> Result<(u32, u32, Vec<u8>), String> {
    // Only the header and the first level, since the crate's reader panics on some damaged descriptors.
    let header = bytes.first_chunk().ok_or("damaged KTX2: it is cut short")?;
    let header = Header::from_bytes(header).map_err(|error| format!("damaged KTX2: {error}"))?;
    let (width, height) = (header.pixel_width, header.pixel_height);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(format!("it has {width}x{height} pixels"));
    }
    if header.pixel_depth > 1 || header.layer_count > 1 || header.face_count > 1 {
        return Err("expected one picture, found a KTX2 with layers, faces or depth".into());
    }
    let rgba8 = match header.format {
        None => transcode(bytes)?,
        Some(format) if is_astc(format) => transcode(bytes)?,
        Some(format) => plain(level(bytes)?, &header, format)?,
    };
    let expected = width as usize * height as usize * 4;
    if rgba8.len() == expected { Ok((width, height, rgba8)) } else { Err("damaged KTX2: too little data".into()) }
}

/// Decodes Basis Universal and ASTC.
fn transcode(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let damaged = |error: basisu::Error| format!("damaged KTX2: {error:?}");
    let transcoder = Transcoder::new(bytes).map_err(damaged)?;
    if !transcoder.supports(TargetFormat::Rgba32) {
        return Err(format!("KTX2 with {:?} is not supported", transcoder.source_format()));
    }
    transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(damaged)
}

/// The stored bytes of the largest level, which the index lists first.
fn level(bytes: &[u8]) -> Result<&[u8], String> {
    let index = bytes.get(Header::LENGTH..).and_then(<[u8]>::first_chunk).map(LevelIndex::from_bytes);
    let range = index.and_then(|index| {
        let start = usize::try_from(index.byte_offset).ok()?;
        Some(start..start.checked_add(usize::try_from(index.byte_length).ok()?)?)
    });
    range.and_then(|range| bytes.get(range)).ok_or_else(|| "damaged KTX2: it is cut short".into())
}

fn is_astc(format: Format) -> bool {
    (Format::ASTC_4x4_UNORM_BLOCK.value()..=Format::ASTC_12x12_SRGB_BLOCK.value()).contains(&format.value())
}

/// Decodes a format of Vulkan. Floats are linear light, and become sRGB, as 8-bit colors are.
fn plain(level: &[u8], header: &Header, format: Format) -> Result<Vec<u8>, String> {
    let unsupported = || format!("the KTX2 format {format:?} is not supported");
    let (width, height) = (header.pixel_width as usize, header.pixel_height as usize);
    let size = stored_size(format, width, height).ok_or_else(unsupported)?;
    let data = decompress(level, header.supercompression_scheme, size)?;
    if data.len() < size {
        return Err("damaged KTX2: too little data".into());
    }
    let data = &data[..size];
    let opaque = |texel: &[u8]| match *texel {
        [r] => [r, r, r, 255],
        [r, g] => [r, r, r, g],
        [r, g, b] => [r, g, b, 255],
        [r, g, b, a] => [r, g, b, a],
        _ => [0; 4],
    };
    let light = |color: [f32; 4]| {
        let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        let [r, g, b] = [color[0], color[1], color[2]].map(|value| byte(encode_srgb(value.clamp(0.0, 1.0))));
        [r, g, b, byte(color[3])]
    };
    Ok(match format {
        Format::R16G16B16A16_SFLOAT => texels(data, 8, |texel| {
            light(std::array::from_fn(|c| f16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32()))
        }),
        Format::R32G32B32A32_SFLOAT => texels(data, 16, |texel| {
            light(std::array::from_fn(|c| f32::from_le_bytes(std::array::from_fn(|byte| texel[4 * c + byte]))))
        }),
        Format::R16G16B16A16_UNORM => texels(data, 8, |texel| std::array::from_fn(|c| texel[2 * c + 1])),
        _ => match block(format) {
            Some((bytes, decode)) => blocks(data, bytes, decode, width, height),
            None => texels(data, size / (width * height), opaque),
        },
    })
}

/// Bytes of a level; `None` if the format is not supported.
fn stored_size(format: Format, width: usize, height: usize) -> Option<usize> {
    if let Some((bytes, _)) = block(format) {
        return Some(width.div_ceil(4) * height.div_ceil(4) * bytes);
    }
    let bytes = match format {
        Format::R8_UNORM | Format::R8_SRGB => 1,
        Format::R8G8_UNORM | Format::R8G8_SRGB => 2,
        Format::R8G8B8_UNORM | Format::R8G8B8_SRGB => 3,
        Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => 4,
        Format::R16G16B16A16_UNORM | Format::R16G16B16A16_SFLOAT => 8,
        Format::R32G32B32A32_SFLOAT => 16,
        _ => return None,
    };
    Some(width * height * bytes)
}

type DecodeBlock = fn(&[u8], &mut [u8], usize);

/// Bytes of a block of 4x4 texels, and its decoder.
fn block(format: Format) -> Option<(usize, DecodeBlock)> {
    Some(match format {
        Format::BC1_RGB_UNORM_BLOCK
        | Format::BC1_RGB_SRGB_BLOCK
        | Format::BC1_RGBA_UNORM_BLOCK
        | Format::BC1_RGBA_SRGB_BLOCK => (8, bcdec_rs::bc1),
        Format::BC2_UNORM_BLOCK | Format::BC2_SRGB_BLOCK => (16, bcdec_rs::bc2),
        Format::BC3_UNORM_BLOCK | Format::BC3_SRGB_BLOCK => (16, bcdec_rs::bc3),
        Format::BC7_UNORM_BLOCK | Format::BC7_SRGB_BLOCK => (16, bcdec_rs::bc7),
        _ => return None,
    })
}

fn texels(data: &[u8], bytes: usize, decode: impl Fn(&[u8]) -> [u8; 4]) -> Vec<u8> {
    data.chunks_exact(bytes).flat_map(decode).collect()
}

fn blocks(data: &[u8], bytes: usize, decode: DecodeBlock, width: usize, height: usize) -> Vec<u8> {
    let (columns, pitch) = (width.div_ceil(4), width.div_ceil(4) * 16);
    let mut padded = vec![0; pitch * height.div_ceil(4) * 4];
    for (index, block) in data.chunks_exact(bytes).enumerate() {
        let start = index / columns * 4 * pitch + index % columns * 16;
        decode(block, &mut padded[start..], pitch);
    }
    padded.chunks_exact(pitch).take(height).flat_map(|row| &row[..width * 4]).copied().collect()
}

/// Undoes the supercompression of a level, up to `size` bytes.
fn decompress(data: &[u8], scheme: Option<SupercompressionScheme>, size: usize) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    let read = |reader: &mut dyn Read, out: &mut Vec<u8>| reader.take(size as u64).read_to_end(out).map(|_| ());
    match scheme {
        None => return Ok(data.to_vec()),
        Some(SupercompressionScheme::ZLIB) => read(&mut flate2::read::ZlibDecoder::new(data), &mut out),
        Some(SupercompressionScheme::Zstandard) => {
            let decoder = ruzstd::StreamingDecoder::new(data).map_err(|error| format!("damaged KTX2: {error}"))?;
            read(&mut { decoder }, &mut out)
        }
        Some(other) => return Err(format!("the KTX2 supercompression {other:?} is not supported")),
    }
    .map_err(|error| format!("damaged KTX2: {error}"))?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of one level. `model`: the color model of its data format descriptor.
    fn file(format: u32, scheme: u32, (width, height): (u32, u32), model: u8, level: &[u8], raw: usize) -> Vec<u8> {
        let descriptor_length = 44_u32;
        let data_at = 80 + 24 + descriptor_length;
        let mut out = MAGIC.to_vec();
        let words = [format, 1, width, height, 0, 0, 1, 1, scheme, 104, descriptor_length, 0, 0];
        words.iter().for_each(|word| out.extend_from_slice(&word.to_le_bytes()));
        [0, 0, u64::from(data_at), level.len() as u64, raw as u64]
            .iter()
            .for_each(|word| out.extend_from_slice(&word.to_le_bytes()));
        out.extend_from_slice(&descriptor_length.to_le_bytes());
        // A basic descriptor with one sample: model, primaries, transfer, flags, blocks of 4x4 texels, 16 bytes.
        let descriptor =
            [0, 2 | 40 << 16, u32::from(model) | 1 << 8 | 2 << 16, 3 | 3 << 8, 16, 0, 127 << 16, 0, 0, u32::MAX];
        descriptor.iter().for_each(|word: &u32| out.extend_from_slice(&word.to_le_bytes()));
        out.extend_from_slice(level);
        out
    }

    const NO_MODEL: u8 = 1;
    const UASTC: u8 = 166;

    #[test]
    fn plain_formats() {
        let texels = [1_u8, 2, 3, 250, 128, 64, 7, 8, 9, 10, 11, 12];
        let opened = |format: Format, level: &[u8]| {
            pixels(&file(format.value(), 0, (2, 1), NO_MODEL, level, level.len()), 64).unwrap().2
        };
        assert_eq!(opened(Format::R8G8B8A8_SRGB, &texels[..8]), texels[..8]);
        assert_eq!(opened(Format::R8G8B8_UNORM, &texels[..6]), [1, 2, 3, 255, 250, 128, 64, 255]);
        assert_eq!(opened(Format::R8_UNORM, &texels[..2]), [1, 1, 1, 255, 2, 2, 2, 255]);
        let halves: Vec<u8> =
            [0.0, 1.0, 0.5, 1.0, 2.0, -1.0, 0.0, 0.5].iter().flat_map(|v| f16::from_f32(*v).to_le_bytes()).collect();
        assert_eq!(opened(Format::R16G16B16A16_SFLOAT, &halves), [0, 255, 188, 255, 255, 0, 0, 128]);
        let refused = pixels(&file(Format::BC6H_UFLOAT_BLOCK.value(), 0, (4, 4), NO_MODEL, &[0; 16], 16), 64);
        assert!(refused.unwrap_err().contains("BC6H_UFLOAT_BLOCK"));
    }

    #[test]
    fn blocks_and_supercompression() {
        // BC1: two equal 565 colors, all texels of the first: pure red. 5x3 texels are two blocks.
        let red = [0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0].repeat(2);
        let expected = [255, 0, 0, 255].repeat(15);
        let bc1 = Format::BC1_RGBA_UNORM_BLOCK.value();
        assert_eq!(pixels(&file(bc1, 0, (5, 3), NO_MODEL, &red, 16), 64), Ok((5, 3, expected.clone())));
        let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        std::io::Write::write_all(&mut zlib, &red).unwrap();
        let packed = zlib.finish().unwrap();
        assert_eq!(pixels(&file(bc1, 3, (5, 3), NO_MODEL, &packed, 16), 64), Ok((5, 3, expected.clone())));
        // A Zstandard frame of one raw block (RFC 8878): magic, descriptor of one segment, content size, header, data.
        let zstd = [&[0x28, 0xb5, 0x2f, 0xfd, 0x20, 16, 16 << 3 | 1, 0, 0], red.as_slice()].concat();
        assert_eq!(pixels(&file(bc1, 2, (5, 3), NO_MODEL, &zstd, 16), 64), Ok((5, 3, expected)));
    }

    #[test]
    fn basis_universal() {
        // UASTC mode 8 is a block of one color: its 5 bits of code, then red, green, blue and alpha.
        let block = (0x17_u128 | 10 << 5 | 200 << 13 | 30 << 21 | 255 << 29).to_le_bytes();
        let opened = pixels(&file(0, 0, (4, 4), UASTC, &block, 16), 64);
        assert_eq!(opened, Ok((4, 4, [10, 200, 30, 255].repeat(16))));
    }

    #[test]
    fn damaged_files_cause_no_panic() {
        let block = [0x17_u8; 16];
        let red = [0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0];
        let files = [
            file(0, 0, (4, 4), UASTC, &block, 16),
            file(Format::BC1_RGBA_UNORM_BLOCK.value(), 0, (4, 4), NO_MODEL, &red, 8),
            file(Format::R8G8B8A8_SRGB.value(), 0, (2, 2), NO_MODEL, &block, 16),
        ];
        crate::damaged::each(300, &[&files[0], &files[1], &files[2]], |bytes| {
            let _ = pixels(bytes, 64);
        });
        assert!(pixels(&files[2][..150], 64).is_err());
    }
}
