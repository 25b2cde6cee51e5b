//! Reads a frame back: the picture and the raw values before tone mapping.

use std::sync::Arc;

use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, Memory, Swapchain, Use, vk};
use crate::shader::PixelValue;

/// A frame in CPU memory.
#[derive(Clone, Debug, Default)]
pub struct Capture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The LDR output: RGBA, 8 bits, straight alpha, rows from the top.
    pub rgba8: Vec<u8>,
    /// The values before exposure, tone map and encoding: RGBA, premultiplied alpha, rows from the top.
    pub raw: Vec<[f32; 4]>,
    /// [`PixelValue::no_data`] of each pixel, in the order of `raw`.
    pub no_data: Vec<bool>,
    /// [`PixelValue::not_finite`] of each pixel, in the order of `raw`.
    pub not_finite: Vec<bool>,
}

impl Capture {
    /// Raw value at a pixel; `None` outside.
    pub fn raw_at(&self, x: u32, y: u32) -> Option<[f32; 4]> {
        (x < self.width && y < self.height).then(|| self.raw[(y * self.width + x) as usize])
    }
}

/// Bytes of a frame that are read at a time: a multiple of all sizes of pixels.
const PIECE: u64 = 1 << 20;

/// Recorded copies of a frame.
pub struct Readback {
    picture: Arc<Buffer>,
    raw: Arc<Buffer>,
    width: u32,
    height: u32,
    half: bool,
}

impl Readback {
    /// Records the copies. Both images must be in [`Use::CopyFrom`].
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

    /// Width, height and LDR output alone, as in [`Capture::rgba8`]. SYNC: after the fence of the submission.
    pub fn finish_display(self) -> (u32, u32, Vec<u8>) {
        let mut rgba8 = self.picture.read();
        rgba8.chunks_exact_mut(4).for_each(|bgra| bgra.swap(0, 2));
        (self.width, self.height, rgba8)
    }

    /// The captured frame without its raw values. SYNC: after the fence of the submission.
    pub fn finish_picture(self) -> Capture {
        let (width, height, rgba8) = self.finish_display();
        Capture { width, height, rgba8, ..Capture::default() }
    }

    /// The captured frame. SYNC: after the fence of the submission.
    pub fn finish(self) -> Capture {
        let (raw, half) = (self.raw.clone(), self.half);
        let (width, height, rgba8) = self.finish_display();
        let mut capture = Capture { width, height, rgba8, ..Capture::default() };
        let pixels = width as usize * height as usize;
        (capture.raw, capture.no_data) = (Vec::with_capacity(pixels), Vec::with_capacity(pixels));
        capture.not_finite = Vec::with_capacity(pixels);
        // In pieces, since a second copy of a large picture would be most of the memory at this moment.
        for offset in (0..raw.size()).step_by(PIECE as usize) {
            for pixel in texels(&raw.read_part(offset, PIECE), half).map(PixelValue::decode) {
                capture.raw.push(pixel.value);
                capture.no_data.push(pixel.no_data);
                capture.not_finite.push(pixel.not_finite);
            }
        }
        capture
    }
}

/// The value of one pixel before tone mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelAt {
    /// Pixels from the left and upper edge of the picture.
    pub at: (u32, u32),
    /// Its value.
    pub value: PixelValue,
    /// [`super::View::picture`] of the picture that the pixel belongs to.
    pub picture: u64,
}

/// Copies one pixel per frame of a slot, as part of the frame.
pub(super) struct PixelReadback {
    buffer: Arc<Buffer>,
    /// Pixel position, the image's format, and the picture's number.
    copied: Option<((u32, u32), vk::Format, u64)>,
    /// Whether alpha is a number of a pass, without flags.
    pub(super) is_plain: bool,
}

impl PixelReadback {
    pub(super) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        let buffer = Buffer::new(gpu, "pixel readback", 16, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
        Ok(Self { buffer, copied: None, is_plain: false })
    }

    /// Records the copy of a pixel of an HDR image, or of the LDR output. The image is in [`Use::Sampled`] before and after.
    pub(super) fn record(&mut self, encoder: &mut Encoder, image: &Arc<Image>, at: Option<(u32, u32)>, picture: u64) {
        let desc = image.desc();
        let at = at.filter(|(x, y)| *x < desc.width && *y < desc.height);
        self.copied = at.map(|at| (at, desc.format, picture));
        if let Some(at) = at {
            encoder.transition(image, Use::Sampled, Use::CopyFrom);
            encoder.copy_pixel(image, at, &self.buffer);
            encoder.transition(image, Use::CopyFrom, Use::Sampled);
            encoder.copies_done();
        }
    }

    /// The pixel of the last frame that recorded one. SYNC: after that frame's fence.
    pub(super) fn read(&self) -> Option<PixelAt> {
        let (at, format, picture) = self.copied?;
        let value = match (format, &*self.buffer.read()) {
            // The LDR output has no flags in alpha.
            (Swapchain::FORMAT, [blue, green, red, alpha, ..]) => {
                let value = [red, green, blue, alpha].map(|byte| f32::from(*byte) / 255.0);
                PixelValue { value, ..PixelValue::default() }
            }
            (format, bytes) => {
                let value = texels(bytes, format == vk::Format::R16G16B16A16_SFLOAT).next()?;
                let not_finite = !value.iter().all(|number| number.is_finite());
                match self.is_plain {
                    true => PixelValue { value, not_finite, no_data: false },
                    false => PixelValue::decode(value),
                }
            }
        };
        Some(PixelAt { at, value, picture })
    }
}

/// Decodes RGBA pixels of half or full floats.
pub(super) fn texels(bytes: &[u8], half: bool) -> impl Iterator<Item = [f32; 4]> + '_ {
    let decode = move |texel: &[u8]| -> [f32; 4] {
        std::array::from_fn(|c| match half {
            true => half::f16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32(),
            false => f32::from_le_bytes([texel[4 * c], texel[4 * c + 1], texel[4 * c + 2], texel[4 * c + 3]]),
        })
    };
    bytes.chunks_exact(if half { 8 } else { 16 }).map(decode)
}
