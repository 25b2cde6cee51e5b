//! Decodes blocks, for devices that do not sample them.

use half::f16;

use super::form::TexelForm;

/// Decodes a block into rows of RGBA8, `pitch` bytes apart.
type DecodeBlock = fn(&[u8], &mut [u8], usize);

/// A level of blocks as RGBA8, or as half floats if the form is HDR. `data` has all of its blocks. Forms without a decoder become black;
/// ASTC is among them, since the transcoder decodes it.
pub fn blocks(form: TexelForm, data: &[u8], (width, height): (u32, u32)) -> Vec<u8> {
    let (width, height) = (width as usize, height as usize);
    let bytes = form.block().2 as usize;
    if form.is_hdr() {
        return floats(form == TexelForm::Bc6hSigned, data, width, height);
    }
    let decode: DecodeBlock = match form {
        TexelForm::Bc1Rgb => opaque_bc1,
        TexelForm::Bc1Rgba => bcdec_rs::bc1,
        TexelForm::Bc2 => bcdec_rs::bc2,
        TexelForm::Bc3 => bcdec_rs::bc3,
        TexelForm::Bc7 => bcdec_rs::bc7,
        TexelForm::Etc2Rgb => |block, out, pitch| etc2(texture2ddecoder::decode_etc2_rgb_block, block, out, pitch),
        TexelForm::Etc2Rgba1 => |block, out, pitch| etc2(texture2ddecoder::decode_etc2_rgba1_block, block, out, pitch),
        TexelForm::Etc2Rgba8 => |block, out, pitch| etc2(texture2ddecoder::decode_etc2_rgba8_block, block, out, pitch),
        _ => |_, _, _| {},
    };
    rgba8(data, bytes, decode, width, height)
}

/// Blocks of 4x4 texels as RGBA8.
pub fn rgba8(data: &[u8], bytes: usize, decode: DecodeBlock, width: usize, height: usize) -> Vec<u8> {
    let (columns, pitch) = (width.div_ceil(4), width.div_ceil(4) * 16);
    let mut padded = vec![0; pitch * height.div_ceil(4) * 4];
    for (index, block) in data.chunks_exact(bytes).take(columns * height.div_ceil(4)).enumerate() {
        let start = index / columns * 4 * pitch + index % columns * 16;
        decode(block, &mut padded[start..], pitch);
    }
    padded.chunks_exact(pitch).take(height).flat_map(|row| &row[..width * 4]).copied().collect()
}

/// BC1 without alpha: what would be transparent is black.
fn opaque_bc1(block: &[u8], out: &mut [u8], pitch: usize) {
    bcdec_rs::bc1(block, out, pitch);
    for row in out.chunks_mut(pitch).take(4) {
        row.iter_mut().skip(3).step_by(4).take(4).for_each(|alpha| *alpha = 255);
    }
}

/// The decoder writes texels as 0xAARRGGBB.
fn etc2(decode: impl Fn(&[u8], &mut [u32]), block: &[u8], out: &mut [u8], pitch: usize) {
    let mut texels = [0; 16];
    decode(block, &mut texels);
    for (row, texels) in out.chunks_mut(pitch).zip(texels.chunks_exact(4)) {
        for (to, texel) in row.chunks_exact_mut(4).zip(texels) {
            let [b, g, r, a] = texel.to_le_bytes();
            to.copy_from_slice(&[r, g, b, a]);
        }
    }
}

/// BC6H as half floats with an alpha of 1.
fn floats(is_signed: bool, data: &[u8], width: usize, height: usize) -> Vec<u8> {
    let columns = width.div_ceil(4);
    let mut out = vec![0; width * height * 8];
    for (index, block) in data.chunks_exact(16).take(columns * height.div_ceil(4)).enumerate() {
        let mut texels = [0_u16; 48];
        bcdec_rs::bc6h_half(block, &mut texels, 12, is_signed);
        let (left, top) = (index % columns * 4, index / columns * 4);
        for (at, rgb) in texels.chunks_exact(3).enumerate() {
            let (x, y) = (left + at % 4, top + at / 4);
            if x < width && y < height {
                let half = |channel: usize| rgb.get(channel).copied().unwrap_or(f16::ONE.to_bits()).to_le_bytes();
                let texel: Vec<u8> = (0..4).flat_map(half).collect();
                out[(y * width + x) * 8..][..8].copy_from_slice(&texel);
            }
        }
    }
    out
}
