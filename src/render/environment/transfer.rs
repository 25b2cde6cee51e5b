//! Copies baked images between the device and the bytes that the disk cache keeps.

use std::sync::Arc;

use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, Memory, Use, one_shot, vk};

use crate::render::compute;

/// Uploads the images, whose bytes follow each other. Leaves them in [`Use::Sampled`].
pub(super) fn fill(gpu: &Arc<Gpu>, images: &[&Arc<Image>], bytes: &[u8]) -> Result<(), GpuError> {
    let mut rest = bytes;
    let mut parts = Vec::new();
    for image in images {
        let (own, others) = rest.split_at(image.desc().bytes() as usize);
        parts.push((*image, own));
        rest = others;
    }
    compute::upload(gpu, &parts)
}

/// Copies texels that shaders wrote to a buffer into an image, and leaves it in [`Use::Sampled`]. The caller has recorded
/// [`Encoder::computed`].
pub(super) fn fill_from(encoder: &mut Encoder, texels: &Arc<Buffer>, to: &Arc<Image>) {
    encoder.transition(to, Use::Undefined, Use::CopyTo);
    encoder.copy_to_image(texels, 0, to);
    encoder.transition(to, Use::CopyTo, Use::Sampled);
}

/// Reads back the images, which are in [`Use::Sampled`], one after the other, then the first bytes of each buffer.
pub(super) fn read(
    gpu: &Arc<Gpu>,
    images: &[&Arc<Image>],
    buffers: &[(&Arc<Buffer>, u64)],
) -> Result<Vec<u8>, GpuError> {
    let size = |image: &&Arc<Image>| image.desc().bytes();
    let bytes = images.iter().map(size).sum::<u64>() + buffers.iter().map(|(_, bytes)| bytes).sum::<u64>();
    let out = Buffer::new(gpu, "baked", bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
    one_shot(gpu, |encoder| {
        let mut at = 0;
        for image in images {
            encoder.transition(image, Use::Sampled, Use::CopyFrom);
            encoder.copy_levels_from_image(image, &out, at);
            encoder.transition(image, Use::CopyFrom, Use::Sampled);
            at += size(image);
        }
        for (buffer, bytes) in buffers {
            encoder.copy_buffer(buffer, 0, &out, at, *bytes);
            at += bytes;
        }
        encoder.copies_done();
        Ok(())
    })?;
    Ok(out.read())
}
