//! Samples of a picture's values on the CPU, for automatic ranges and histograms. They are copied within the frame and read once it
//! has finished, so nothing waits for them.

use std::sync::Arc;

use super::capture::texels;
use crate::frame::Limits;
use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, ImageDesc, Memory, Use, vk};
use crate::shader::PixelValue;

/// Most samples of a frame: enough for a hundredth of them to be more than a hundred.
const SAMPLES: u32 = 1 << 14;
/// The fraction of the values beyond each end of [`RangeSample::limits`].
const BEYOND: f32 = 0.01;

/// Values of a picture at the points of a grid.
#[derive(Clone, Debug, Default)]
pub struct RangeSample {
    /// [`super::View::picture`] of the sampled picture.
    pub picture: u64,
    /// Raw values where the frame has any, without coverage.
    pub values: Vec<[f32; 3]>,
}

impl RangeSample {
    /// The values between which all but a hundredth at each end lie, over the first `components`. `None` without values.
    pub fn limits(&self, components: u8) -> Option<Limits> {
        let count = usize::from(components).clamp(1, 3);
        let mut all: Vec<f32> = self.values.iter().flat_map(|value| value[..count].iter().copied()).collect();
        if all.is_empty() {
            return None;
        }
        let beyond = (all.len() as f32 * BEYOND) as usize;
        let low = *all.select_nth_unstable_by(beyond, f32::total_cmp).1;
        let last = all.len() - 1 - beyond;
        let high = *all.select_nth_unstable_by(last, f32::total_cmp).1;
        Some((low, high))
    }

    /// How many values of each of the channels lie in each of `bins` equal steps of `place`, which gives 0..1 for values in sight.
    pub fn histogram(&self, bins: usize, place: impl Fn(f32) -> f32) -> [Vec<u32>; 3] {
        std::array::from_fn(|channel| {
            let mut counts = vec![0; bins];
            for value in &self.values {
                let at = (place(value[channel]) * bins as f32) as usize;
                counts[at.min(bins - 1)] += 1;
            }
            counts
        })
    }
}

/// Copies samples of a slot's frames.
#[derive(Default)]
pub(super) struct RangeSampleReadback {
    image: Option<(Arc<Image>, Arc<Buffer>)>,
    /// The picture whose samples the buffer holds.
    copied: Option<u64>,
    /// Whether alpha is a number of a pass, without flags.
    pub(super) is_plain: bool,
}

impl RangeSampleReadback {
    /// Records the copy of an HDR image, which is in [`Use::Sampled`] before and after.
    pub(super) fn record(
        &mut self,
        gpu: &Arc<Gpu>,
        encoder: &mut Encoder,
        hdr: &Arc<Image>,
        picture: u64,
    ) -> Result<(), GpuError> {
        let (grid, buffer) = self.provide(gpu, hdr)?;
        encoder.transition(hdr, Use::Sampled, Use::CopyFrom);
        encoder.transition(&grid, Use::Undefined, Use::CopyTo);
        encoder.pick(hdr, &grid);
        encoder.transition(hdr, Use::CopyFrom, Use::Sampled);
        encoder.transition(&grid, Use::CopyTo, Use::CopyFrom);
        encoder.copy_from_image(&grid, &buffer);
        encoder.copies_done();
        self.copied = Some(picture);
        Ok(())
    }

    /// The grid for frames of this size, and the buffer for its values.
    fn provide(&mut self, gpu: &Arc<Gpu>, hdr: &Arc<Image>) -> Result<(Arc<Image>, Arc<Buffer>), GpuError> {
        let (width, height, format) = (hdr.desc().width, hdr.desc().height, hdr.desc().format);
        let step = (width * height).div_ceil(SAMPLES).max(1).isqrt() + 1;
        let size = (width.div_ceil(step), height.div_ceil(step));
        let fits =
            |image: &Image| (image.desc().width, image.desc().height, image.desc().format) == (size.0, size.1, format);
        if let Some((image, buffer)) = self.image.as_ref().filter(|(image, _)| fits(image)) {
            return Ok((image.clone(), buffer.clone()));
        }
        // Nothing samples this image, but every image has a view.
        let copies = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        let usage = copies | vk::ImageUsageFlags::SAMPLED;
        let image = Image::new(gpu, "range_sample", ImageDesc::new(size.0, size.1, format, usage))?;
        let bytes = u64::from(size.0) * u64::from(size.1) * if is_half(format) { 8 } else { 16 };
        let buffer = Buffer::new(gpu, "range_sample", bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
        self.image = Some((image.clone(), buffer.clone()));
        Ok((image, buffer))
    }

    /// Takes the samples of the last frame that recorded some. SYNC: after that frame's fence.
    pub(super) fn take(&mut self) -> Option<RangeSample> {
        let picture = self.copied.take()?;
        let (image, buffer) = self.image.as_ref()?;
        let content = buffer.read();
        let plain = |[r, g, b, alpha]: [f32; 4]| PixelValue {
            value: [r, g, b, 1.0],
            no_data: false,
            not_finite: ![r, g, b, alpha].iter().all(|number| number.is_finite()),
        };
        let decode = |texel| if self.is_plain { plain(texel) } else { PixelValue::decode(texel) };
        let decoded = texels(&content, is_half(image.desc().format)).map(decode);
        let known = decoded.filter(|pixel| !pixel.no_data && !pixel.not_finite && pixel.value[3] > 0.5);
        let values =
            known.map(|PixelValue { value: [r, g, b, coverage], .. }| [r, g, b].map(|c| c / coverage)).collect();
        Some(RangeSample { picture, values })
    }
}

fn is_half(format: vk::Format) -> bool {
    format == vk::Format::R16G16B16A16_SFLOAT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_leave_out_a_hundredth_at_each_end() {
        let mut values: Vec<[f32; 3]> = (0..1000).map(|i| [i as f32, 0.0, 0.0]).collect();
        values[5] = [1e9, 0.0, 0.0];
        let range_sample = RangeSample { picture: 1, values };
        assert_eq!(range_sample.limits(1), Some((11.0, 990.0)));
        assert_eq!(RangeSample::default().limits(3), None);
    }

    #[test]
    fn a_histogram_counts_every_value() {
        let values = vec![[0.0, 0.5, 2.0], [0.1, 0.5, -3.0]];
        let [r, g, b] = RangeSample { picture: 1, values }.histogram(4, |value| value);
        assert_eq!((r, g, b), (vec![2, 0, 0, 0], vec![0, 0, 2, 0], vec![1, 0, 0, 1]));
    }
}
