//! A view draws [`BoundFrame`]s. It owns the images between the model and the picture, what they hold, and the mean of an
//! accumulating mode, so that several views share nothing but the resources of their frames.

mod capture;
mod passes;
mod targets;
mod uniforms;

use std::sync::Arc;

pub use capture::Capture;
use capture::{PixelReadback, Readback};
use targets::{TargetDesc, Targets};
pub(crate) use uniforms::{SharedImages, Sources, Uniforms};

use super::brdf::ltc;
use super::compute;
use super::resources::BoundFrame;
use super::state::TargetFormat;
use crate::gpu::{
    Encoder, Gpu, GpuError, Image, ImageDesc, Rect, Sampler, SamplerDesc, SetLayouts, Swapchain, Use, vk,
};
use crate::shader::PixelValue;

/// Where a view puts its picture.
pub struct Output<'a> {
    /// The image. It is left in [`Use::Color`].
    pub image: &'a Arc<Image>,
    /// What the image was used for before: [`Use::Undefined`], or [`Use::Acquired`] from a swapchain.
    pub before: Use,
    /// Upper left corner of the picture in the image. What the picture does not cover becomes black.
    pub at: (u32, u32),
}

/// How much of a frame is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Redraw {
    /// The model is drawn only if the picture has changed since the last frame.
    IfChanged,
    /// Everything.
    Always,
    /// Everything, but only one pixel is shaded, counted from the upper left corner.
    Pixel(u32, u32),
}

/// The raw value of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelAt {
    /// Pixels from the left and upper edge of the picture.
    pub at: (u32, u32),
    /// Its value.
    pub value: PixelValue,
    /// [`View::picture`] of the picture that it belongs to.
    pub picture: u64,
}

/// What the HDR target holds.
struct Drawn {
    frame: BoundFrame,
    only: Option<Rect>,
}

/// What belongs to a frame in flight.
struct InFlight {
    uniforms: Uniforms,
    pixel: PixelReadback,
}

/// Draws frames of one picture after another.
pub struct View {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    nearest: Arc<Sampler>,
    shared: SharedImages,
    in_flight: Vec<InFlight>,
    targets: Option<Targets>,
    drawn: Option<Drawn>,
    /// Counts the pictures that were drawn.
    picture: u64,
    sample_index: u32,
    /// The pixel whose value each frame reports.
    pub probe: Option<(u32, u32)>,
}

impl View {
    /// Frames that an accumulating mode adds up, unless every frame is asked for: more change nothing that can be seen.
    pub const MOST_ACCUMULATED: u32 = 4096;
    /// Format of every picture.
    pub const OUTPUT_FORMAT: vk::Format = Swapchain::FORMAT;

    /// A view for a renderer with this many frames in flight.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, frames_in_flight: usize) -> Result<Self, GpuError> {
        let in_flight = || -> Result<_, GpuError> {
            Ok(InFlight { uniforms: Uniforms::new(gpu)?, pixel: PixelReadback::new(gpu)? })
        };
        Ok(Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            nearest: Sampler::new(gpu, &SamplerDesc::NEAREST)?,
            shared: SharedImages {
                ltc: ltc::table(gpu)?,
                linear: compute::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?,
            },
            in_flight: (0..frames_in_flight).map(|_| in_flight()).collect::<Result<_, _>>()?,
            targets: None,
            drawn: None,
            picture: 0,
            sample_index: 0,
            probe: None,
        })
    }

    /// Makes the images that `frame` is drawn to, if those at hand do not fit. If that fails, these stay.
    ///
    /// # Errors
    /// Out of memory.
    pub fn prepare(&mut self, frame: &BoundFrame) -> Result<(), GpuError> {
        let request = &frame.state.pipelines;
        let desc = TargetDesc {
            size: frame.state.size,
            format: request.target,
            transmission: frame.state.scene.as_ref().is_some_and(|scene| scene.is_transmissive()),
            accumulates: request.accumulates,
        };
        if self.targets.as_ref().is_none_or(|targets| targets.desc != desc) {
            let samplers = (&self.nearest, &self.shared.linear);
            self.targets = Some(Targets::new(&self.gpu, &self.layouts, desc, samplers)?);
            self.drawn = None;
        }
        Ok(())
    }

    /// Draws `frame`, for which [`View::prepare`] was called, with the uniforms of frame slot `slot`.
    ///
    /// # Errors
    /// Out of memory.
    pub fn draw(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        output: &Output<'_>,
        redraw: Redraw,
    ) -> Result<(), GpuError> {
        let Some(targets) = &self.targets else { return Ok(()) };
        let (width, height) = frame.state.size;
        let rect = Rect { x: output.at.0, y: output.at.1, width, height };
        let only = match redraw {
            Redraw::Pixel(x, y) => Some(Rect { x, y, width: 1, height: 1 }),
            Redraw::IfChanged | Redraw::Always => None,
        };

        // An accumulating mode adds a frame to the mean of the same picture, and starts again with another.
        let accumulates = frame.state.pipelines.accumulates;
        let unchanged = self.drawn.as_ref().is_some_and(|drawn| drawn.only == only && drawn.frame.is_same(frame));
        let improves = accumulates && self.sample_index + 1 < Self::MOST_ACCUMULATED;
        let redrawn = !unchanged || improves || redraw != Redraw::IfChanged;
        if redrawn {
            self.picture += 1;
            self.sample_index = if unchanged && accumulates { self.sample_index.saturating_add(1) } else { 0 };
        }

        // What the shaders read.
        let in_flight = &mut self.in_flight[slot];
        let constants = frame.state.constants(rect, frame.environment.scale, self.sample_index);
        in_flight.uniforms.write(&constants, &frame.state.lights, frame.state.params());
        let sources = Sources {
            environment: frame.environment.clone(),
            tables: frame.pipelines.tables.clone(),
            measured: frame.measured.clone(),
        };
        encoder.bind_set(&self.layouts, &in_flight.uniforms.set(&self.layouts, &sources, &self.shared)?);

        // The model, to HDR.
        let passes = passes::Passes { layouts: &self.layouts, targets, frame, only };
        if redrawn {
            passes.model(encoder);
            encoder.transition(&targets.color, Use::Color, Use::Sampled);
            passes.accumulate(encoder, self.sample_index);
        }
        self.drawn = Some(Drawn { frame: frame.clone(), only });

        // The value of one pixel, for whoever asks for it once the frame has finished.
        in_flight.pixel.record(encoder, targets.picture(), self.probe, self.picture);

        // HDR to the picture: exposure, tone map, sRGB.
        encoder.transition(output.image, output.before, Use::Color);
        encoder.pass("tone map", |encoder| passes.tone_map(encoder, output.image, rect));
        Ok(())
    }

    /// Fills an output with black, when there is no frame to draw yet.
    pub fn clear(encoder: &mut Encoder, output: &Output<'_>) {
        encoder.transition(output.image, output.before, Use::Color);
        passes::clear(encoder, output.image);
    }

    /// Number of the picture on screen. It changes whenever the model is drawn, and not when only the tone map is.
    pub fn picture(&self) -> u64 {
        self.picture
    }

    /// Number of frames that the picture is the mean of.
    pub fn accumulated(&self) -> u32 {
        self.sample_index + 1
    }

    /// The probed pixel as it was in the last frame of slot `slot`; `None` without one. SYNC: that frame has finished.
    pub fn pixel(&self, slot: usize) -> Option<PixelAt> {
        self.in_flight.get(slot).and_then(|in_flight| in_flight.pixel.read())
    }

    /// Records the copy of picture and HDR target to memory, for [`Readback::finish`] once the frame has finished. `output` is
    /// where [`View::draw`] put the picture.
    ///
    /// # Errors
    /// Out of memory.
    pub fn read_back(&self, encoder: &mut Encoder, output: &Arc<Image>) -> Result<Option<Readback>, GpuError> {
        let Some(targets) = &self.targets else { return Ok(None) };
        encoder.transition(output, Use::Color, Use::CopyFrom);
        encoder.transition(targets.picture(), Use::Sampled, Use::CopyFrom);
        let readback = Readback::record(&self.gpu, encoder, output, targets.picture())?;
        encoder.transition(targets.picture(), Use::CopyFrom, Use::Sampled);
        Ok(Some(readback))
    }

    /// An image for pictures that are read back.
    ///
    /// # Errors
    /// Out of memory.
    pub fn output_image(&self, (width, height): (u32, u32)) -> Result<Arc<Image>, GpuError> {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        Image::new(&self.gpu, "picture", ImageDesc::new(width, height, Self::OUTPUT_FORMAT, usage))
    }

    /// Samples per pixel as `msaa` asks, if the device can.
    ///
    /// # Errors
    /// A count that is neither 1 nor 4, or that the device lacks, in words.
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
