//! Results of a view once its frames are drawn: pictures, values of pixels, and the images that hold them.

use std::sync::Arc;

use super::View;
use super::capture::{PixelAt, Readback};
use super::scan::{NotFinitePixels, Scan};
use crate::frame::TargetFormat;
use crate::gpu::{Encoder, Gpu, GpuError, Image, ImageDesc, Swapchain, Use, vk};

impl View {
    /// The number of the current picture. It increases when the model is drawn, not when only the tone map runs.
    pub fn picture(&self) -> u64 {
        self.picture
    }

    /// The number of accumulated frames.
    pub fn accumulated(&self) -> u32 {
        self.sample_index + 1
    }

    /// The probed pixel of the last frame of slot `slot`, if that frame had one. SYNC: after that frame's fence.
    pub fn pixel(&self, slot: usize) -> Option<PixelAt> {
        self.in_flight.get(slot).and_then(|in_flight| in_flight.pixel.read())
    }

    /// The values of [`View::probe_passes`] in the last frame of slot `slot`, by the slugs of the modes that show them. SYNC: after that frame's fence.
    pub fn pass_pixels(&self, slot: usize) -> Vec<(String, PixelAt)> {
        let pixels = self.in_flight.get(slot).into_iter().flat_map(|in_flight| &in_flight.pass_pixels);
        pixels.filter_map(|(name, pixel)| Some((name.clone(), pixel.read()?))).collect()
    }

    /// The pixels with NaN or infinity in the frame of slot `slot`, if it looked for them. SYNC: after that frame's fence.
    pub fn take_scan(&mut self, slot: usize) -> Option<NotFinitePixels> {
        self.in_flight.get_mut(slot)?.scan.take().map(Scan::finish)
    }

    /// Records the readback of the image in `output`, which [`View::draw`] has drawn, and of the HDR target. Call
    /// `Readback::finish` once the frame has finished.
    ///
    /// # Errors
    /// Out of memory.
    pub fn read_back(&self, encoder: &mut Encoder, output: &Arc<Image>) -> Result<Option<Readback>, GpuError> {
        let Some(targets) = &self.targets else { return Ok(None) };
        encoder.transition(output, Use::Color, Use::CopyFrom);
        let values = self.drawn.as_ref().and_then(|(frame, _)| self.declared.values_on_display(frame));
        let picture = values.or(self.declared.picture()).unwrap_or(targets.picture());
        encoder.transition(picture, Use::Sampled, Use::CopyFrom);
        let readback = Readback::record(&self.gpu, encoder, output, picture)?;
        encoder.transition(picture, Use::CopyFrom, Use::Sampled);
        Ok(Some(readback))
    }

    /// Frees the images that the picture needed only while it was drawn, before it is read back. The next frame needs
    /// [`View::prepare`]. SYNC: after the fence of the last submission.
    pub fn free_samples(&mut self) {
        if let Some(targets) = &mut self.targets {
            targets.multisampled = None;
            self.declared.drop_sets();
        }
    }

    /// Frees the targets. The next frame needs [`View::prepare`]. SYNC: after the fence of the last submission.
    pub fn free_targets(&mut self) {
        self.targets = None;
        self.forget();
        self.declared.targets_replaced();
    }

    /// Creates an output image that can be read back.
    ///
    /// # Errors
    /// Out of memory.
    pub fn output_image(&self, (width, height): (u32, u32)) -> Result<Arc<Image>, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        Image::new(&self.gpu, "picture", ImageDesc::new(width, height, Swapchain::FORMAT, usage))
    }

    /// The target format for `msaa` samples per pixel, with full or half floats.
    ///
    /// # Errors
    /// A message, if `msaa` is neither 1 nor 4 or the device does not support it.
    pub fn target_format(gpu: &Gpu, msaa: u32, full: bool) -> Result<TargetFormat, String> {
        match msaa {
            samples @ (1 | 4) if gpu.supports_samples(samples) => {
                Ok(if full { TargetFormat::full(samples) } else { TargetFormat::half(samples) })
            }
            4 => Err("this device has no 4x multisampling; use --set view.msaa=1".into()),
            other => Err(format!("view.msaa is {other}; it can be 1 or 4")),
        }
    }
}
