//! A frame read back: the picture and the raw values behind it.

use std::sync::Arc;

use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, Memory, Use, one_shot, vk};

/// A frame in memory.
#[derive(Clone, Debug)]
pub struct Capture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The picture: RGBA, straight alpha, 8 bits, rows from the top.
    pub rgba8: Vec<u8>,
    /// The values before exposure, tone map and encoding: RGBA, premultiplied alpha, rows from the top.
    pub raw: Vec<[f32; 4]>,
}

impl Capture {
    /// Raw value at a pixel; `None` outside.
    pub fn raw_at(&self, x: u32, y: u32) -> Option<[f32; 4]> {
        (x < self.width && y < self.height).then(|| self.raw[(y * self.width + x) as usize])
    }
}

/// Copies that were recorded; finished after the submission's fence.
pub(super) struct Readback {
    picture: Arc<Buffer>,
    raw: Arc<Buffer>,
    width: u32,
    height: u32,
    half: bool,
}

impl Readback {
    /// Records the copies. Both images are in `Use::CopyFrom`.
    pub(super) fn record(
        gpu: &Arc<Gpu>,
        encoder: &mut Encoder,
        picture: &Arc<Image>,
        hdr: &Arc<Image>,
    ) -> Result<Self, GpuError> {
        let (width, height) = (picture.desc().width, picture.desc().height);
        let half = hdr.desc().format == vk::Format::R16G16B16A16_SFLOAT;
        let pixels = u64::from(width) * u64::from(height);
        let buffer = |name, size| Buffer::new(gpu, name, size, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback);
        let this = Self {
            picture: buffer("picture readback", pixels * 4)?,
            raw: buffer("raw readback", pixels * if half { 8 } else { 16 })?,
            width,
            height,
            half,
        };
        encoder.copy_from_image(picture, &this.picture);
        encoder.copy_from_image(hdr, &this.raw);
        encoder.copies_done();
        Ok(this)
    }

    /// Reads the buffers. SYNC: after the submission's fence.
    pub(super) fn finish(self) -> Capture {
        let mut rgba8 = self.picture.read();
        rgba8.chunks_exact_mut(4).for_each(|bgra| bgra.swap(0, 2));
        let raw = floats(self.raw.content(), self.half);
        Capture { width: self.width, height: self.height, rgba8, raw }
    }
}

/// One pixel of an HDR image in `Use::Sampled`.
pub(super) fn raw_at(gpu: &Arc<Gpu>, hdr: &Arc<Image>, x: u32, y: u32) -> Result<Option<[f32; 4]>, GpuError> {
    let desc = hdr.desc();
    if x >= desc.width || y >= desc.height {
        return Ok(None);
    }
    let buffer = Buffer::new(gpu, "pixel", 16, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
    one_shot(gpu, |encoder| {
        encoder.transition(hdr, Use::Sampled, Use::CopyFrom);
        encoder.copy_pixel(hdr, (x, y), &buffer);
        encoder.transition(hdr, Use::CopyFrom, Use::Sampled);
        encoder.copies_done();
        Ok(())
    })?;
    let half = desc.format == vk::Format::R16G16B16A16_SFLOAT;
    Ok(floats(&buffer.read(), half).first().copied())
}

/// RGBA pixels of half or full floats.
fn floats(bytes: &[u8], half: bool) -> Vec<[f32; 4]> {
    let decode = |pixel: &[u8]| -> [f32; 4] {
        std::array::from_fn(|c| match half {
            true => half::f16::from_le_bytes([pixel[2 * c], pixel[2 * c + 1]]).to_f32(),
            false => f32::from_le_bytes([pixel[4 * c], pixel[4 * c + 1], pixel[4 * c + 2], pixel[4 * c + 3]]),
        })
    };
    bytes.chunks_exact(if half { 8 } else { 16 }).map(decode).collect()
}
