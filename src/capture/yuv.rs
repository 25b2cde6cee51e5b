//! An sRGB image as the planes of a video: BT.709, limited range, 4:2:0.

use image::{Rgba, RgbaImage};
use openh264::formats::YUVSlices;

/// Weights of red, green and blue in the luma of BT.709.
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Luma, and the two color differences at half the width and height.
pub(super) struct Planes {
    /// Even.
    size: (u32, u32),
    luma: Vec<u8>,
    blue: Vec<u8>,
    red: Vec<u8>,
}

impl Planes {
    /// Planes for images of this size. A video has an even number of columns and rows, so an odd size grows by one.
    pub(super) fn new((width, height): (u32, u32)) -> Self {
        let size = (width.next_multiple_of(2), height.next_multiple_of(2));
        let pixels = size.0 as usize * size.1 as usize;
        Self { size, luma: vec![0; pixels], blue: vec![0; pixels / 4], red: vec![0; pixels / 4] }
    }

    /// Width and height of the video.
    pub(super) fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Converts an image. An odd size repeats its last column or row, and transparent pixels become black.
    pub(super) fn fill(&mut self, image: &RgbaImage) {
        let (right, bottom) = (image.width().saturating_sub(1), image.height().saturating_sub(1));
        let width = self.size.0 as usize;
        for y in 0..self.size.1 / 2 {
            for x in 0..self.size.0 / 2 {
                let mut sum = [0.0; 3];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, y) = (2 * x + dx, 2 * y + dy);
                    let color = opaque(image.get_pixel(x.min(right), y.min(bottom)));
                    self.luma[y as usize * width + x as usize] = (16.5 + 219.0 * luma(color)) as u8;
                    sum = std::array::from_fn(|channel| sum[channel] + color[channel] * 0.25);
                }
                let index = y as usize * width / 2 + x as usize;
                // The difference to the luma is at most 1 - weight, which maps to half of 224 steps.
                let chroma = |channel: usize| 128.5 + 112.0 * (sum[channel] - luma(sum)) / (1.0 - LUMA[channel]);
                self.blue[index] = chroma(2) as u8;
                self.red[index] = chroma(0) as u8;
            }
        }
    }

    /// The planes, for the encoder.
    pub(super) fn slices(&self) -> YUVSlices<'_> {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        YUVSlices::new((&self.luma, &self.blue, &self.red), (width, height), (width, width / 2, width / 2))
    }
}

/// A pixel over black, 0 to 1.
fn opaque(pixel: &Rgba<u8>) -> [f32; 3] {
    let alpha = f32::from(pixel[3]) / (255.0 * 255.0);
    std::array::from_fn(|channel| f32::from(pixel[channel]) * alpha)
}

fn luma(color: [f32; 3]) -> f32 {
    color.iter().zip(LUMA).map(|(channel, weight)| channel * weight).sum()
}

#[cfg(test)]
mod tests {
    use openh264::formats::YUVSource as _;

    use super::*;

    #[test]
    fn colors_are_those_of_bt_709() {
        // ITU-R BT.709: black, white, and the primaries at 8 bits.
        for (color, expected) in [
            ([0, 0, 0, 255], [16, 128, 128]),
            ([255, 255, 255, 255], [235, 128, 128]),
            ([255, 0, 0, 255], [63, 102, 240]),
            ([0, 255, 0, 255], [173, 42, 26]),
            ([0, 0, 255, 255], [32, 240, 118]),
            ([255, 255, 255, 0], [16, 128, 128]),
        ] {
            let mut planes = Planes::new((1, 3));
            planes.fill(&RgbaImage::from_pixel(1, 3, Rgba(color)));
            let slices = planes.slices();
            assert_eq!(slices.dimensions(), (2, 4));
            assert_eq!([slices.y()[7], slices.u()[1], slices.v()[1]], expected, "{color:?}");
        }
    }
}
