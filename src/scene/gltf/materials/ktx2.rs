//! Reads KTX2 textures: Basis Universal (`KHR_texture_basisu`), blocks of BC, ETC2 and ASTC, and the common plain formats. All keep their
//! form and their mip levels.

use std::borrow::Cow;
use std::io::Read;

use half::f16;
use ktx2::{Format, Header, LevelIndex, SupercompressionScheme};

use crate::astc;
use crate::scene::images::{Basis, TexelForm, Texels, rgba8_of_blocks};
use crate::scene::mips;

/// The first bytes of a file.
const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
/// Maximum number of bytes of all levels.
const MOST_BYTES: u64 = 2 << 30;

/// Whether a file begins as KTX2 does.
pub fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Takes memory for some bytes, or says why there is none.
type Take<'t> = &'t dyn Fn(u64) -> Result<(), String>;

/// Width, height and texels, or the reason of a failure. `largest`: the maximum of width and height.
pub fn texels(bytes: &[u8], largest: u32, take: Take<'_>) -> Result<(u32, u32, Texels), String> {
    // Only the header and the levels, since the crate's reader panics on some damaged descriptors.
    let header = bytes.first_chunk().ok_or("damaged KTX2: it is cut short")?;
    let header = Header::from_bytes(header).map_err(|error| format!("damaged KTX2: {error}"))?;
    let (width, height) = (header.pixel_width, header.pixel_height);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(format!("it has {width}x{height} pixels"));
    }
    if header.pixel_depth > 1 || header.layer_count > 1 || header.face_count > 1 {
        return Err("expected one picture, found a KTX2 with layers, faces or depth".into());
    }
    if header.level_count > mips::count(width, height) {
        return Err(format!("damaged KTX2: {} levels of {width}x{height} pixels", header.level_count));
    }
    let basis = || {
        // Where the device samples no compressed form. Of floats it is twice as much.
        take(u64::from(width) * u64::from(height) * 4)?;
        check_lengths(bytes, &header)?;
        Basis::read(bytes, header.level_count).map(Texels::Basis)
    };
    let texels = match header.format {
        None => basis()?,
        // ASTC of less than 8 bits a channel needs the transcoder where the device does not sample it.
        Some(format) if astc_block(format).is_some() => basis()?,
        // So do those of floats, which Basis Universal calls UASTC HDR and ASTC HDR.
        Some(Format::ASTC_4x4_SFLOAT_BLOCK | Format::ASTC_6x6_SFLOAT_BLOCK) => basis()?,
        Some(format) => stored(bytes, &header, format, take)?,
    };
    Ok((width, height, texels))
}

/// The levels of a format of Vulkan, each in the form that the model keeps.
fn stored(bytes: &[u8], header: &Header, format: Format, take: Take<'_>) -> Result<Texels, String> {
    let unsupported = || format!("the KTX2 format {format:?} is not supported");
    let file = file_form(format).ok_or_else(unsupported)?;
    let levels = header.level_count.max(1);
    let size = |level| mips::size(header.pixel_width, header.pixel_height, level);
    let total = (0..levels).map(|level| file.form().bytes(size(level).0, size(level).1)).sum::<u64>();
    if total > MOST_BYTES {
        return Err(format!("it takes {} MiB", total >> 20));
    }
    take(total)?;
    let mut all = Vec::new();
    for level in 0..levels {
        let (width, height) = size(level);
        let length = file.bytes(width, height);
        let data = decompress(stored_level(bytes, level)?, header.supercompression_scheme, length)?;
        let data = data.get(..length).ok_or("damaged KTX2: too little data")?;
        all.extend(file.texels(data, width, height));
    }
    Ok(Texels::Stored { form: file.form(), levels, bytes: all })
}

/// Where a level is; `None` if the file ends before it.
fn level_index(bytes: &[u8], level: u32) -> Option<LevelIndex> {
    let at = Header::LENGTH + level as usize * LevelIndex::LENGTH;
    bytes.get(at..).and_then(<[u8]>::first_chunk).map(LevelIndex::from_bytes)
}

/// Refuses a file one of whose levels says that it is longer than its blocks without supercompression: the transcoder takes as much memory
/// as a file says.
fn check_lengths(bytes: &[u8], header: &Header) -> Result<(), String> {
    for level in 0..header.level_count.max(1) {
        let (width, height) = mips::size(header.pixel_width, header.pixel_height, level);
        // No block of 16 bytes has fewer texels.
        let most = TexelForm::Astc(4, 4).bytes(width, height);
        let length = level_index(bytes, level).map_or(0, |index| index.uncompressed_byte_length);
        if length > most {
            return Err(format!("damaged KTX2: level {level} has {length} bytes, expected {most} at most"));
        }
    }
    Ok(())
}

/// The stored bytes of a level.
fn stored_level(bytes: &[u8], level: u32) -> Result<&[u8], String> {
    let range = level_index(bytes, level).and_then(|index| {
        let start = usize::try_from(index.byte_offset).ok()?;
        Some(start..start.checked_add(usize::try_from(index.byte_length).ok()?)?)
    });
    range.and_then(|range| bytes.get(range)).ok_or_else(|| "damaged KTX2: it is cut short".into())
}

fn astc_block(format: Format) -> Option<(u8, u8)> {
    let first = Format::ASTC_4x4_UNORM_BLOCK.value();
    // Each size is there as UNORM and as SRGB.
    let index = format.value().checked_sub(first)? / 2;
    astc::BLOCKS.get(index as usize).copied()
}

/// How a file stores texels.
#[derive(Clone, Copy)]
enum FileForm {
    /// As the model keeps them.
    Same(TexelForm),
    /// 1 or 2 channels of 8 bits: gray, or gray and alpha.
    Bytes(usize),
    /// Four floats.
    Floats,
    /// Four half floats.
    Halves,
    /// BC4: one channel of gray.
    Gray,
    /// BC5: the first two coordinates of a normal.
    Normal,
}

impl FileForm {
    /// The form in which the model keeps the texels.
    fn form(self) -> TexelForm {
        match self {
            Self::Same(form) => form,
            Self::Bytes(_) | Self::Gray | Self::Normal => TexelForm::Rgba8,
            Self::Floats | Self::Halves => TexelForm::Half,
        }
    }

    /// Bytes of a level in the file.
    fn bytes(self, width: u32, height: u32) -> usize {
        let texels = width as usize * height as usize;
        match self {
            Self::Same(form) => form.bytes(width, height) as usize,
            Self::Bytes(channels) => texels * channels,
            Self::Floats => texels * 16,
            Self::Halves => texels * 8,
            Self::Gray => TexelForm::Bc1Rgb.bytes(width, height) as usize,
            Self::Normal => TexelForm::Bc3.bytes(width, height) as usize,
        }
    }

    /// The texels of a level.
    fn texels(self, data: &[u8], width: u32, height: u32) -> Vec<u8> {
        match self {
            Self::Same(_) => data.to_vec(),
            Self::Bytes(1) => data.iter().flat_map(|gray| [*gray, *gray, *gray, 255]).collect(),
            Self::Bytes(_) => data.chunks_exact(2).flat_map(|texel| [texel[0], texel[0], texel[0], texel[1]]).collect(),
            Self::Floats => data.as_chunks().0.iter().flat_map(|value| half(f32::from_le_bytes(*value))).collect(),
            Self::Halves => {
                let values = data.as_chunks().0.iter().map(|value| f16::from_le_bytes(*value).to_f32());
                values.flat_map(half).collect()
            }
            Self::Gray => rgba8_of_blocks(data, 8, gray_block, width as usize, height as usize),
            Self::Normal => rgba8_of_blocks(data, 16, normal_block, width as usize, height as usize),
        }
    }
}

/// A half float that is finite.
fn half(value: f32) -> [u8; 2] {
    let value = if value.is_nan() { 0.0 } else { value };
    f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())).to_le_bytes()
}

fn gray_block(block: &[u8], out: &mut [u8], pitch: usize) {
    let mut gray = [0; 16];
    bcdec_rs::bc4(block, &mut gray, 4, false);
    write_block(out, pitch, |texel| [gray[texel], gray[texel], gray[texel], 255]);
}

/// The third coordinate of a unit vector follows from the others.
fn normal_block(block: &[u8], out: &mut [u8], pitch: usize) {
    let mut both = [0; 32];
    bcdec_rs::bc5(block, &mut both, 8, false);
    write_block(out, pitch, |texel| {
        let [x, y] = [both[2 * texel], both[2 * texel + 1]].map(|byte| f32::from(byte) / 127.5 - 1.0);
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        [both[2 * texel], both[2 * texel + 1], ((z + 1.0) * 127.5).round() as u8, 255]
    });
}

fn write_block(out: &mut [u8], pitch: usize, texel: impl Fn(usize) -> [u8; 4]) {
    for (y, row) in out.chunks_mut(pitch).take(4).enumerate() {
        for (x, to) in row.chunks_exact_mut(4).take(4).enumerate() {
            to.copy_from_slice(&texel(4 * y + x));
        }
    }
}

/// How a file of this format stores texels; `None` if the format is not supported.
fn file_form(format: Format) -> Option<FileForm> {
    use FileForm::{Bytes, Floats, Gray, Halves, Normal, Same};
    Some(match format {
        Format::R8_UNORM | Format::R8_SRGB => Bytes(1),
        Format::R8G8_UNORM | Format::R8G8_SRGB => Bytes(2),
        Format::R8G8B8_UNORM | Format::R8G8B8_SRGB => Same(TexelForm::Rgb8),
        Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => Same(TexelForm::Rgba8),
        Format::R16G16B16A16_UNORM => Same(TexelForm::Rgba16),
        Format::R16G16B16A16_SFLOAT => Halves,
        Format::R32G32B32A32_SFLOAT => Floats,
        Format::BC1_RGB_UNORM_BLOCK | Format::BC1_RGB_SRGB_BLOCK => Same(TexelForm::Bc1Rgb),
        Format::BC1_RGBA_UNORM_BLOCK | Format::BC1_RGBA_SRGB_BLOCK => Same(TexelForm::Bc1Rgba),
        Format::BC2_UNORM_BLOCK | Format::BC2_SRGB_BLOCK => Same(TexelForm::Bc2),
        Format::BC3_UNORM_BLOCK | Format::BC3_SRGB_BLOCK => Same(TexelForm::Bc3),
        Format::BC4_UNORM_BLOCK => Gray,
        Format::BC5_UNORM_BLOCK => Normal,
        Format::BC6H_UFLOAT_BLOCK => Same(TexelForm::Bc6hUnsigned),
        Format::BC6H_SFLOAT_BLOCK => Same(TexelForm::Bc6hSigned),
        Format::BC7_UNORM_BLOCK | Format::BC7_SRGB_BLOCK => Same(TexelForm::Bc7),
        Format::ETC2_R8G8B8_UNORM_BLOCK | Format::ETC2_R8G8B8_SRGB_BLOCK => Same(TexelForm::Etc2Rgb),
        Format::ETC2_R8G8B8A1_UNORM_BLOCK | Format::ETC2_R8G8B8A1_SRGB_BLOCK => Same(TexelForm::Etc2Rgba1),
        Format::ETC2_R8G8B8A8_UNORM_BLOCK | Format::ETC2_R8G8B8A8_SRGB_BLOCK => Same(TexelForm::Etc2Rgba8),
        _ => return None,
    })
}

/// Undoes the supercompression of a level, up to `size` bytes.
fn decompress(data: &[u8], scheme: Option<SupercompressionScheme>, size: usize) -> Result<Cow<'_, [u8]>, String> {
    let mut out = Vec::new();
    let read = |reader: &mut dyn Read, out: &mut Vec<u8>| reader.take(size as u64).read_to_end(out).map(|_| ());
    match scheme {
        None => return Ok(Cow::Borrowed(data)),
        Some(SupercompressionScheme::ZLIB) => read(&mut flate2::read::ZlibDecoder::new(data), &mut out),
        Some(SupercompressionScheme::Zstandard) => {
            let decoder = ruzstd::StreamingDecoder::new(data).map_err(|error| format!("damaged KTX2: {error}"))?;
            read(&mut { decoder }, &mut out)
        }
        Some(other) => return Err(format!("the KTX2 supercompression {other:?} is not supported")),
    }
    .map_err(|error| format!("damaged KTX2: {error}"))?;
    Ok(Cow::Owned(out))
}

#[cfg(test)]
mod tests;
