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
mod tests {
    use super::*;
    use crate::scene::{Image, TexelForms};

    /// A file. `model`: the color model of its data format descriptor. `raw`: the bytes of the first level without supercompression.
    fn file(format: u32, scheme: u32, (width, height): (u32, u32), model: u8, levels: &[&[u8]], raw: usize) -> Vec<u8> {
        let count = levels.len() as u32;
        let (descriptor_at, descriptor_length) = (80 + 24 * count, 44_u32);
        let mut out = MAGIC.to_vec();
        let words = [format, 1, width, height, 0, 0, 1, count, scheme, descriptor_at, descriptor_length, 0, 0];
        words.iter().for_each(|word| out.extend_from_slice(&word.to_le_bytes()));
        let mut at = u64::from(descriptor_at + descriptor_length);
        let lengths = [0, 0].into_iter().chain(levels.iter().enumerate().flat_map(|(level, data)| {
            let length = data.len() as u64;
            at += length;
            [at - length, length, if level == 0 { raw as u64 } else { length }]
        }));
        lengths.for_each(|word: u64| out.extend_from_slice(&word.to_le_bytes()));
        out.extend_from_slice(&descriptor_length.to_le_bytes());
        // A basic descriptor with one sample: model, primaries, transfer, flags, blocks of 4x4 texels, 16 bytes.
        let descriptor =
            [0, 2 | 40 << 16, u32::from(model) | 1 << 8 | 2 << 16, 3 | 3 << 8, 16, 0, 127 << 16, 0, 0, u32::MAX];
        descriptor.iter().for_each(|word: &u32| out.extend_from_slice(&word.to_le_bytes()));
        levels.iter().for_each(|level| out.extend_from_slice(level));
        out
    }

    const NO_MODEL: u8 = 1;
    const UASTC: u8 = 166;
    const UASTC_HDR: u8 = 167;

    /// The form on a device that samples `forms`, and its texels.
    fn opened_on(forms: &TexelForms, file: &[u8]) -> Result<(TexelForm, Vec<u8>), String> {
        let (width, height, texels) = texels(file, 64, &|_| Ok(()))?;
        let mut image = Image::new(String::new(), width, height, texels);
        image.settle(forms);
        let mut out = vec![0; image.bytes() as usize];
        image.write(false, &mut out);
        Ok((image.form, out))
    }

    /// The texels on a device without special forms.
    fn opened(file: &[u8]) -> Vec<u8> {
        opened_on(&TexelForms::default(), file).unwrap().1
    }

    #[test]
    fn plain_formats() {
        let texels = [1_u8, 2, 3, 250, 128, 64, 7, 8, 9, 10, 11, 12];
        // Two texels, and the level below.
        let opened = |format: Format, data: &[u8]| {
            let out = opened(&file(format.value(), 0, (2, 1), NO_MODEL, &[data], data.len()));
            out[..out.len() / 3 * 2].to_vec()
        };
        assert_eq!(opened(Format::R8G8B8A8_SRGB, &texels[..8]), texels[..8]);
        assert_eq!(opened(Format::R8G8B8_UNORM, &texels[..6]), [1, 2, 3, 255, 250, 128, 64, 255]);
        assert_eq!(opened(Format::R8_UNORM, &texels[..2]), [1, 1, 1, 255, 2, 2, 2, 255]);
        // Floats keep what is above 1; what is no number is 0.
        let floats = [0.0, 1.0, 0.5, 1.0, 2.0, -1.0, f32::NAN, 1e9];
        let halves: Vec<u8> = floats.iter().flat_map(|value| f16::from_f32(*value).to_le_bytes()).collect();
        let kept = |bytes: Vec<u8>| -> Vec<f32> {
            bytes.as_chunks().0.iter().map(|half| f16::from_le_bytes(*half).to_f32()).collect()
        };
        let expected = [0.0, 1.0, 0.5, 1.0, 2.0, -1.0, 0.0, 65504.0];
        assert_eq!(kept(opened(Format::R16G16B16A16_SFLOAT, &halves)), expected);
        let floats: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
        assert_eq!(kept(opened(Format::R32G32B32A32_SFLOAT, &floats)), expected);
        let refused = texels_of(Format::ASTC_5x4_SFLOAT_BLOCK);
        assert!(refused.unwrap_err().contains("ASTC_5x4_SFLOAT_BLOCK"));
    }

    fn texels_of(format: Format) -> Result<(u32, u32, Texels), String> {
        texels(&file(format.value(), 0, (4, 4), NO_MODEL, &[&[0; 16]], 16), 64, &|_| Ok(()))
    }

    #[test]
    fn blocks_and_supercompression() {
        // BC1: two equal 565 colors, all texels of the first: pure red. 5x3 texels are two blocks.
        let red = [0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0].repeat(2);
        let expected = [255, 0, 0, 255].repeat(15 + 2 + 1);
        let bc1 = Format::BC1_RGBA_UNORM_BLOCK.value();
        assert_eq!(opened(&file(bc1, 0, (5, 3), NO_MODEL, &[&red], 16)), expected);
        let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        std::io::Write::write_all(&mut zlib, &red).unwrap();
        let packed = zlib.finish().unwrap();
        assert_eq!(opened(&file(bc1, 3, (5, 3), NO_MODEL, &[&packed], 16)), expected);
        // A Zstandard frame of one raw block (RFC 8878): magic, descriptor of one segment, content size, header, data.
        let zstd = [&[0x28, 0xb5, 0x2f, 0xfd, 0x20, 16, 16 << 3 | 1, 0, 0], red.as_slice()].concat();
        assert_eq!(opened(&file(bc1, 2, (5, 3), NO_MODEL, &[&zstd], 16)), expected);
    }

    #[test]
    fn two_channels_are_a_normal_and_one_is_gray() {
        // BC4 with two equal endpoints: all texels have the value of the first.
        let bc4 = |value: u8| [value, value, 0, 0, 0, 0, 0, 0];
        let gray = file(Format::BC4_UNORM_BLOCK.value(), 0, (1, 1), NO_MODEL, &[&bc4(77)], 8);
        assert_eq!(opened(&gray), [77, 77, 77, 255]);
        // A normal of (0.6, 0) has z = 0.8.
        let bc5 = [bc4(204), bc4(128)].concat();
        let normal = file(Format::BC5_UNORM_BLOCK.value(), 0, (1, 1), NO_MODEL, &[&bc5], 16);
        assert_eq!(opened(&normal), [204, 128, 229, 255]);
    }

    #[test]
    fn mip_levels_of_the_file_are_used() {
        let levels: [&[u8]; 2] = [&[9; 16], &[200, 100, 50, 25]];
        let own = file(Format::R8G8B8A8_UNORM.value(), 0, (2, 2), NO_MODEL, &levels, 16);
        assert_eq!(opened(&own), levels.concat());
        let many: Vec<&[u8]> = vec![&[9; 16]; 3];
        let problem = texels(&file(Format::R8G8B8A8_UNORM.value(), 0, (2, 2), NO_MODEL, &many, 16), 64, &|_| Ok(()));
        assert_eq!(problem.unwrap_err(), "damaged KTX2: 3 levels of 2x2 pixels");
    }

    /// UASTC mode 8 is a block of one color: its 5 bits of code, then red, green, blue and alpha.
    fn uastc([r, g, b, a]: [u8; 4]) -> [u8; 16] {
        (0x17_u128 | u128::from(r) << 5 | u128::from(g) << 13 | u128::from(b) << 21 | u128::from(a) << 29).to_le_bytes()
    }

    #[test]
    fn blocks_of_floats_keep_what_is_above_1() {
        // A block of one color (void extent) with half floats, as the specification of ASTC has it: 13 ones of the code, then the extent.
        let color = [4.0, 0.5, 65504.0, 1.0].map(f16::from_f32);
        let block: Vec<u8> =
            [0xfc, 0xff].into_iter().chain([0xff; 6]).chain(color.iter().flat_map(|half| half.to_le_bytes())).collect();
        let hdr = file(Format::ASTC_4x4_SFLOAT_BLOCK.value(), 0, (4, 4), UASTC_HDR, &[&block], 16);
        let (form, bytes) = opened_on(&TexelForms::default(), &hdr).unwrap();
        let expected: Vec<u8> = color.iter().flat_map(|half| half.to_le_bytes()).collect();
        assert_eq!((form, &bytes[..8 * 16]), (TexelForm::Half, &expected.repeat(16)[..]));
        // With all levels, it stays compressed where the device samples such blocks.
        let levels: [&[u8]; 3] = [&block, &block, &block];
        let hdr = file(Format::ASTC_4x4_SFLOAT_BLOCK.value(), 0, (4, 4), UASTC_HDR, &levels, 16);
        let on_bc6 = opened_on(&TexelForms::of(|form| form == TexelForm::Bc6hUnsigned), &hdr).unwrap();
        assert_eq!(on_bc6.0, TexelForm::Bc6hUnsigned);
    }

    #[test]
    fn basis_universal_takes_the_form_that_the_device_has() {
        let one = file(0, 0, (4, 4), UASTC, &[&uastc([10, 200, 30, 255])], 16);
        assert_eq!(opened(&one)[..64], [10, 200, 30, 255].repeat(16));
        // Two levels: BC7 where the device has it, then ASTC, then ETC2. Without any, RGBA8 with the levels of the file.
        let colors = [[250, 3, 128, 255], [17, 90, 201, 60]];
        let two = file(0, 0, (4, 4), UASTC, &[&uastc(colors[0]), &uastc(colors[1])], 16);
        let on = |forms: &[TexelForm]| opened_on(&TexelForms::of(|form| forms.contains(&form)), &two).unwrap();
        let (form, plain) = on(&[]);
        assert_eq!((form, plain), (TexelForm::Rgba8, [colors[0].repeat(16), colors[1].repeat(4)].concat()));
        assert_eq!(on(&[TexelForm::Etc2Rgba8]).0, TexelForm::Etc2Rgba8);
        assert_eq!(on(&[TexelForm::Etc2Rgba8, TexelForm::Astc(4, 4)]).0, TexelForm::Astc(4, 4));
        let (form, bc7) = on(&[TexelForm::Astc(4, 4), TexelForm::Bc7]);
        assert_eq!((form, bc7.len()), (TexelForm::Bc7, 32));
    }

    #[test]
    fn damaged_files_cause_no_panic() {
        let block = [0x17_u8; 16];
        let red = [0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0];
        let bc1 = Format::BC1_RGBA_UNORM_BLOCK.value();
        let files = [
            file(0, 0, (4, 4), UASTC, &[&block, &block], 16),
            file(bc1, 0, (4, 4), NO_MODEL, &[&red, &red, &red], 8),
            file(Format::R8G8B8A8_SRGB.value(), 0, (2, 2), NO_MODEL, &[&block, &block[..4]], 16),
            file(Format::ASTC_4x4_UNORM_BLOCK.value(), 0, (4, 4), 162, &[&block], 16),
        ];
        let all = TexelForms::of(|_| true);
        crate::damaged::each(300, &files.each_ref().map(Vec::as_slice), |bytes| {
            let _ = opened_on(&TexelForms::default(), bytes);
            let _ = opened_on(&all, bytes);
        });
        assert!(texels(&files[2][..150], 64, &|_| Ok(())).is_err());
        // A length for which there is no memory would end the program.
        let long = file(0, 2, (4, 4), UASTC, &[&block], 1 << 37);
        let problem = texels(&long, 64, &|_| Ok(())).unwrap_err();
        assert_eq!(problem, "damaged KTX2: level 0 has 137438953472 bytes, expected 16 at most");
    }
}
