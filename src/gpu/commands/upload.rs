//! Uploads of whole images.

use std::sync::Arc;

use ash::vk;

use super::frames::one_shot;
use super::image_use::Use;
use crate::gpu::{Buffer, Gpu, GpuError, Image, Memory};

/// Uploads all levels and layers of the images, and leaves them in [`Use::Sampled`].
///
/// # Errors
/// Out of memory.
pub fn upload_images(gpu: &Arc<Gpu>, images: &[(&Arc<Image>, &[u8])]) -> Result<(), GpuError> {
    let place = |size: usize| (size as u64).next_multiple_of(16);
    let size = images.iter().map(|(_, bytes)| place(bytes.len())).sum();
    let staging = Buffer::new(gpu, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload)?;
    let mut at = 0;
    for (_, bytes) in images {
        staging.write(at, bytes);
        at += place(bytes.len());
    }
    one_shot(gpu, |encoder| {
        let mut at = 0;
        for (image, bytes) in images {
            encoder.transition(image, Use::Undefined, Use::CopyTo);
            encoder.copy_to_image(&staging, at, image);
            encoder.transition(image, Use::CopyTo, Use::Sampled);
            at += place(bytes.len());
        }
        encoder.copies_done();
        Ok(())
    })
}
