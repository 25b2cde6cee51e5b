//! A frame read back: the picture and the raw values behind it.

use std::sync::Arc;

use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, Memory, vk};

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
        let bytes = self.raw.read();
        let raw = if self.half {
            let halves = bytes.chunks_exact(2).map(|b| half::f16::from_le_bytes([b[0], b[1]]).to_f32());
            let floats: Vec<f32> = halves.collect();
            floats.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect()
        } else {
            let floats = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            let floats: Vec<f32> = floats.collect();
            floats.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect()
        };
        Capture { width: self.width, height: self.height, rgba8, raw }
    }
}
