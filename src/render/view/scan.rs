//! Looks for NaN and infinity in all pixels of a picture, on the CPU: once for a picture that has come to rest.

use std::sync::Arc;

use super::capture::texels;
use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, Memory, Use, vk};
use crate::shader::PixelValue;

/// The pixels of a picture whose values are NaN or infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinitePixels {
    /// [`super::View::picture`] of the picture.
    pub picture: u64,
    /// How many there are.
    pub count: usize,
    /// One of them, from the upper left corner: the middle one in the order of rows.
    pub at: (u32, u32),
}

/// The copy of a picture that is read once its frame has finished.
pub(super) struct Scan {
    buffer: Arc<Buffer>,
    width: u32,
    is_half: bool,
    picture: u64,
}

impl Scan {
    /// Records the copy of an HDR image, which is in [`Use::Sampled`] before and after.
    pub(super) fn record(
        gpu: &Arc<Gpu>,
        encoder: &mut Encoder,
        hdr: &Arc<Image>,
        picture: u64,
    ) -> Result<Self, GpuError> {
        let desc = hdr.desc();
        let is_half = desc.format == vk::Format::R16G16B16A16_SFLOAT;
        let bytes = u64::from(desc.width) * u64::from(desc.height) * if is_half { 8 } else { 16 };
        let buffer = Buffer::new(gpu, "scan", bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
        encoder.transition(hdr, Use::Sampled, Use::CopyFrom);
        encoder.copy_from_image(hdr, &buffer);
        encoder.transition(hdr, Use::CopyFrom, Use::Sampled);
        encoder.copies_done();
        Ok(Self { buffer, width: desc.width, is_half, picture })
    }

    /// Counts the pixels. SYNC: after the fence of the frame.
    pub(super) fn finish(self) -> NotFinitePixels {
        let content = self.buffer.read();
        let is_bad = |(_, texel): &(u32, [f32; 4])| PixelValue::decode(*texel).not_finite;
        let bad: Vec<u32> = (0..).zip(texels(&content, self.is_half)).filter(is_bad).map(|(index, _)| index).collect();
        let middle = bad.get(bad.len() / 2).copied().unwrap_or(0);
        NotFinitePixels { picture: self.picture, count: bad.len(), at: (middle % self.width, middle / self.width) }
    }
}
