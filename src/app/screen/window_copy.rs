//! A copy of the whole window on its way from the device.

use std::sync::Arc;

use crate::gpu::{Buffer, Encoder, Gpu, Image, Memory, Use, vk};

/// A copy of the window in flight.
pub(super) struct WindowCopy {
    /// The frame that it is copied with.
    pub(super) slot: usize,
    pub(super) pixels: Arc<Buffer>,
    pub(super) size: (u32, u32),
}

impl WindowCopy {
    /// Records a copy of the finished image, in [`Use::Color`] before and after, in frame slot `slot`.
    ///
    /// # Errors
    /// Why it cannot be copied.
    pub(super) fn record(
        gpu: &Arc<Gpu>,
        encoder: &mut Encoder,
        slot: usize,
        image: &Arc<Image>,
    ) -> Result<Self, String> {
        let desc = image.desc();
        if !desc.usage.contains(vk::ImageUsageFlags::TRANSFER_SRC) {
            return Err("this display's images cannot be read; capture without `ui`".to_owned());
        }
        let size = (desc.width, desc.height);
        let bytes = u64::from(size.0) * u64::from(size.1) * 4;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let pixels = Buffer::new(gpu, "window readback", bytes, usage, Memory::Readback);
        let pixels = pixels.map_err(|error| error.to_string())?;
        encoder.transition(image, Use::Color, Use::CopyFrom);
        encoder.copy_from_image(image, &pixels);
        encoder.transition(image, Use::CopyFrom, Use::Color);
        encoder.copies_done();
        Ok(Self { slot, pixels, size })
    }
}
