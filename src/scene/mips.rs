//! Computes mip levels on the CPU, so that every device gets the same bytes. A software device would take seven times as long
//! to blit them.

use std::sync::LazyLock;

use rayon::prelude::*;

use crate::settings::linear_from_srgb;

/// Pixels that one task computes.
const PIXELS_A_TASK: usize = 1 << 14;

/// Number of levels down to 1x1.
pub fn count(width: u32, height: u32) -> u32 {
    width.max(height).max(1).ilog2() + 1
}

/// Size of a level.
pub fn size(width: u32, height: u32, level: u32) -> (u32, u32) {
    ((width >> level).max(1), (height >> level).max(1))
}

/// Bytes of all levels.
pub fn bytes(width: u32, height: u32) -> usize {
    let pixels = |level| {
        let (width, height) = size(width, height, level);
        width as usize * height as usize
    };
    (0..count(width, height)).map(pixels).sum::<usize>() * 4
}

/// Levels 1 and up of an RGBA image, one after the other. Each pixel is the mean of up to 2x2 pixels of the level above.
/// sRGB-encoded colors are averaged as linear values; alpha is always linear.
pub fn below(rgba8: &[u8], width: u32, height: u32, srgb: bool) -> Vec<u8> {
    let mut chain = vec![0; bytes(width, height) - rgba8.len()];
    let (mut above, mut rest) = (rgba8, chain.as_mut_slice());
    for level in 1..count(width, height) {
        let (to, later) = rest.split_at_mut(level_bytes(width, height, level));
        halve(above, size(width, height, level - 1), to, size(width, height, level), srgb);
        (above, rest) = (to, later);
    }
    chain
}

/// Levels 1 and up of an image of four words a texel, in little endian, one after the other. `mean` gives a channel of a texel from those of
/// up to 2x2 texels of the level above.
pub fn below_words(words: &[u16], width: u32, height: u32, mean: impl Fn([u16; 4]) -> u16 + Sync) -> Vec<u8> {
    let mut out = Vec::new();
    let mut above = words.to_vec();
    for level in 1..count(width, height) {
        let ((from_w, from_h), (to_w, to_h)) = (size(width, height, level - 1), size(width, height, level));
        let mut texels = vec![0; to_w as usize * to_h as usize * 4];
        // An axis with a single texel keeps it.
        let pair = |from: u32, at: usize| if from > 1 { [2 * at, 2 * at + 1] } else { [0, 0] };
        texels.par_chunks_exact_mut(to_w as usize * 4).enumerate().for_each(|(y, row)| {
            let rows = pair(from_h, y).map(|y| &above[y * from_w as usize * 4..]);
            for (at, word) in row.iter_mut().enumerate() {
                let columns = pair(from_w, at / 4).map(|x| 4 * x + at % 4);
                *word = mean([rows[0][columns[0]], rows[0][columns[1]], rows[1][columns[0]], rows[1][columns[1]]]);
            }
        });
        out.extend(texels.iter().flat_map(|word| word.to_le_bytes()));
        above = texels;
    }
    out
}

/// Levels 1 and up of an RGBA image or volume of floats, one after the other. `size`: width, height and depth. Each texel is the
/// mean of up to 2x2x2 texels of the level above.
pub fn below_floats(texels: &[[f32; 4]], size: [u32; 3]) -> Vec<[f32; 4]> {
    let at_level = |level: u32| size.map(|side| (side >> level).max(1) as usize);
    let [width, height, depth] = size;
    let mut out = Vec::new();
    let mut above = texels.to_vec();
    for level in 1..count(width.max(depth), height) {
        let (from, [to_w, to_h, to_d]) = (at_level(level - 1), at_level(level));
        let mut texels = vec![[0.0; 4]; to_w * to_h * to_d];
        // An axis with a single texel keeps it.
        let pair = |axis: usize, at: usize| if from[axis] > 1 { [2 * at, 2 * at + 1] } else { [0, 0] };
        texels.par_chunks_exact_mut(to_w).enumerate().for_each(|(row, texels)| {
            let (ys, zs) = (pair(1, row % to_h), pair(2, row / to_h));
            let rows = zs.map(|z| ys.map(|y| &above[(z * from[1] + y) * from[0]..][..from[0]]));
            for (x, texel) in texels.iter_mut().enumerate() {
                let taps = rows.iter().flatten().flat_map(|row| pair(0, x).map(|x| row[x]));
                *texel = taps.fold([0.0; 4], |sum, tap| std::array::from_fn(|c| sum[c] + tap[c] / 8.0));
            }
        });
        out.extend_from_slice(&texels);
        above = texels;
    }
    out
}

fn level_bytes(width: u32, height: u32, level: u32) -> usize {
    let (width, height) = size(width, height, level);
    width as usize * height as usize * 4
}

fn halve(above: &[u8], (from_w, from_h): (u32, u32), to: &mut [u8], (to_w, _): (u32, u32), srgb: bool) {
    let row_bytes = from_w as usize * 4;
    let curve = srgb.then(|| &*CURVE);
    let halve_row = |(y, row): (usize, &mut [u8])| {
        // A level of height 1 has a single row.
        let (top, bottom) = if from_h > 1 { (2 * y, 2 * y + 1) } else { (0, 0) };
        let rows = [top, bottom].map(|y| &above[y * row_bytes..][..row_bytes]);
        // A level of width 1 has a single column.
        let doubled = (from_w == 1).then(|| rows.map(|row| [row, row].concat()));
        let rows = doubled.as_ref().map_or(rows, |rows| [&rows[0], &rows[1]]);
        match curve {
            Some(curve) => halve_light(row, rows, curve),
            None => halve_values(row, rows),
        }
    };
    let rows_a_task = PIXELS_A_TASK.div_ceil(to_w as usize);
    to.par_chunks_exact_mut(to_w as usize * 4).enumerate().with_min_len(rows_a_task).for_each(halve_row);
}

/// Means of 2x2 pixels, all channels at once: two channels of a pixel lie in 16 bits each.
fn halve_values(to: &mut [u8], [top, bottom]: [&[u8]; 2]) {
    const EVEN: u64 = 0x00ff_00ff_00ff_00ff;
    let (to, _) = to.as_chunks_mut::<4>();
    let pairs = top.as_chunks::<8>().0.iter().zip(bottom.as_chunks::<8>().0);
    for (pixel, (top, bottom)) in to.iter_mut().zip(pairs) {
        let [top, bottom] = [u64::from_le_bytes(*top), u64::from_le_bytes(*bottom)];
        let mean = |top: u64, bottom: u64| {
            let both = (top & EVEN) + (bottom & EVEN);
            ((both + (both >> 32) + 0x0002_0002) >> 2) as u32 & EVEN as u32
        };
        *pixel = (mean(top, bottom) | (mean(top >> 8, bottom >> 8) << 8)).to_le_bytes();
    }
}

/// Means of 2x2 pixels whose colors are sRGB-encoded.
fn halve_light(to: &mut [u8], [top, bottom]: [&[u8]; 2], curve: &Curve) {
    let (to, _) = to.as_chunks_mut::<4>();
    let pairs = top.as_chunks::<8>().0.iter().zip(bottom.as_chunks::<8>().0);
    for (pixel, (top, bottom)) in to.iter_mut().zip(pairs) {
        for (channel, value) in pixel[..3].iter_mut().enumerate() {
            *value = curve.mean([top[channel], top[4 + channel], bottom[channel], bottom[4 + channel]]);
        }
        let alpha = [top[3], top[7], bottom[3], bottom[7]].map(u32::from);
        pixel[3] = ((alpha.iter().sum::<u32>() + 2) / 4) as u8;
    }
}

/// The sRGB curve (IEC 61966-2-1) of a linear value, 0..1.
pub fn encode_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Tables of the sRGB curve and its inverse (IEC 61966-2-1). 16 bits of linear light distinguish all dark values.
struct Curve {
    linear: [u32; 256],
    encoded: Vec<u8>,
}

static CURVE: LazyLock<Curve> = LazyLock::new(|| Curve {
    linear: std::array::from_fn(|i| (linear_from_srgb(i as f32 / 255.0) * 65535.0).round() as u32),
    encoded: (0..=65535u32).map(|l| (encode_srgb(l as f32 / 65535.0) * 255.0).round() as u8).collect(),
});

impl Curve {
    fn mean(&self, taps: [u8; 4]) -> u8 {
        let sum: u32 = taps.iter().map(|t| self.linear[usize::from(*t)]).sum();
        self.encoded[(sum as usize + 2) / 4]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_image_stays_flat_at_every_level() {
        for (width, height) in [(1, 1), (1, 8), (7, 1), (5, 3), (8, 8), (13, 32)] {
            for color in [[0, 1, 2, 3], [17, 128, 255, 64]] {
                for srgb in [false, true] {
                    let image = color.repeat((width * height) as usize);
                    let chain = below(&image, width, height, srgb);
                    assert_eq!(chain.len() + image.len(), bytes(width, height));
                    assert!(chain.chunks_exact(4).all(|p| p == color), "{width}x{height} {color:?} srgb {srgb}");
                }
            }
        }
    }

    #[test]
    fn a_texel_of_a_volume_is_the_mean_of_eight() {
        let volume: Vec<[f32; 4]> = (0..8).map(|value| [value as f32; 4]).collect();
        assert_eq!(below_floats(&volume, [2, 2, 2]), [[3.5; 4]]);
        // 4 x 1 x 2: a level of 2 x 1 x 1, and one texel.
        assert_eq!(below_floats(&volume, [4, 1, 2]), [[2.5; 4], [4.5; 4], [3.5; 4]]);
        assert_eq!(below_floats(&volume[..3], [3, 1, 1]), [[0.5; 4]]);
    }

    /// A plain mean of each channel, for the lanes of `halve_values`.
    #[test]
    fn channels_do_not_touch_each_other() {
        let mut state = 7_u32;
        let mut byte = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // Often the ends of the range, where a lane would carry.
            [0, 255, (state >> 24) as u8][(state >> 16) as usize % 3]
        };
        for (width, height) in [(8, 6), (5, 7), (1, 9), (9, 1), (2, 2)] {
            let image: Vec<u8> = (0..width * height * 4).map(|_| byte()).collect();
            let [half_w, half_h] = [(width / 2).max(1), (height / 2).max(1)];
            let at = |x: usize, y: usize, channel: usize| {
                u32::from(image[(y.min(height - 1) * width + x.min(width - 1)) * 4 + channel])
            };
            let chain = below(&image, width as u32, height as u32, false);
            for (place, value) in chain[..half_w * half_h * 4].iter().enumerate() {
                let (x, y, channel) = (place / 4 % half_w * 2, place / 4 / half_w * 2, place % 4);
                let taps = [at(x, y, channel), at(x + 1, y, channel), at(x, y + 1, channel), at(x + 1, y + 1, channel)];
                assert_eq!(u32::from(*value), (taps.iter().sum::<u32>() + 2) / 4, "{width}x{height} {x} {y} {channel}");
            }
        }
    }

    #[test]
    fn srgb_averages_light_and_not_code_values() {
        let image: Vec<u8> = [[0, 0, 0, 0], [255, 255, 255, 255]].concat().repeat(2);
        // Half the light of white is sRGB 188; half its code value is 128, as for alpha.
        assert_eq!(below(&image, 2, 2, true), [188, 188, 188, 128]);
        assert_eq!(below(&image, 2, 2, false), [128, 128, 128, 128]);
    }
}
