//! KTX2 files of our own making.

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
