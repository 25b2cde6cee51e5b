//! One frame, from the wait for its slot to its picture on the screen or in memory.

use std::sync::Arc;

use crate::gpu::{
    Acquired, Attachments, Buffer, Encoder, Frames, Gpu, GpuError, Image, ImageDesc, Rect, Sampler, SamplerDesc,
    SetLayouts, Swapchain, UiRenderer, Use, vk,
};

use crate::render::brdf::ltc;
use crate::render::capture::{self, Capture, Readback};
use crate::render::compute;
use crate::render::draw::{average, draw_model, tone_map};
use crate::render::environment::bake::GpuEnvironment;
use crate::render::pipelines::PipelineSet;
use crate::render::scene::GpuScene;
use crate::render::shot::Shot;
use crate::render::targets::{Purpose, Targets};
use crate::render::uniforms::{Constants, Sources, Uniforms};
use crate::render::wanted::Wanted;

/// What to draw.
#[derive(Clone, Copy)]
pub struct FrameInput<'a> {
    /// Camera, lights and values.
    pub shot: &'a Shot,
    /// One generation of shaders, and which of its pipelines; it has them all. `None`, at the start, draws the background alone.
    pub pipelines: Option<(&'a Arc<PipelineSet>, &'a Wanted)>,
    /// The model, or none yet.
    pub scene: Option<&'a Arc<GpuScene>>,
    /// Image-based light; [`super::Baked::uniform`] without.
    pub environment: &'a Arc<GpuEnvironment>,
    /// Measured BRDF, as [`super::measured_buffer`] makes it.
    pub measured: &'a Arc<Buffer>,
    /// Where in the output the picture goes.
    pub rect: Rect,
}

/// egui's output for a frame.
pub struct UiFrame<'a> {
    /// Its renderer.
    pub renderer: &'a mut UiRenderer,
    /// What to draw.
    pub primitives: &'a [egui::ClippedPrimitive],
    /// Pixels of a point.
    pub pixels_per_point: f32,
}

/// Where a frame goes.
pub enum Target<'a> {
    /// To a window, with the user interface over it.
    Window(&'a mut Swapchain, UiFrame<'a>),
    /// To memory: picture and raw HDR values.
    Memory,
    /// Nowhere: drawn and waited for, to measure.
    Nowhere,
    /// The same, but nothing is shaded beside one pixel, counted from the upper left corner: for [`Renderer::raw_at`].
    Pixel(u32, u32),
}

/// What became of a frame.
pub enum Drawn {
    /// It is on its way to the screen. `fits` is false when the swapchain must be made anew.
    Shown {
        /// Whether the swapchain still fits the window.
        fits: bool,
    },
    /// The swapchain gave no image; make it anew and draw again.
    NoImage,
    /// It is in memory.
    Captured(Capture),
    /// It is drawn.
    Finished,
}

/// What an HDR picture was drawn from. The same again gives the same, so it is kept: only the panels are drawn anew then.
struct Drawing {
    uniforms: Vec<u8>,
    wanted: Wanted,
    pipelines: Arc<PipelineSet>,
    scene: Option<Arc<GpuScene>>,
    environment: Arc<GpuEnvironment>,
    measured: Arc<Buffer>,
    only: Option<Rect>,
}

impl Drawing {
    fn of(input: &FrameInput<'_>, largest: f32, only: Option<Rect>) -> Option<Self> {
        let (pipelines, wanted) = input.pipelines?;
        // Where in the window it goes is the tone map's business.
        let rect = Rect { x: 0, y: 0, ..input.rect };
        let frame = input.shot.uniforms(rect, largest, input.environment.scale, 0);
        let mut uniforms = bytemuck::bytes_of(&frame).to_vec();
        uniforms.extend_from_slice(bytemuck::cast_slice(&input.shot.lights));
        uniforms.extend_from_slice(&input.shot.params);
        Some(Self {
            uniforms,
            wanted: wanted.clone(),
            pipelines: pipelines.clone(),
            scene: input.scene.cloned(),
            environment: input.environment.clone(),
            measured: input.measured.clone(),
            only,
        })
    }

    fn is_same(&self, other: &Self) -> bool {
        let same_scene = match (&self.scene, &other.scene) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        same_scene
            && Arc::ptr_eq(&self.pipelines, &other.pipelines)
            && Arc::ptr_eq(&self.environment, &other.environment)
            && Arc::ptr_eq(&self.measured, &other.measured)
            && self.only == other.only
            && self.wanted == other.wanted
            && self.uniforms == other.uniforms
    }
}

/// Draws frames.
pub struct Renderer {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    frames: Frames,
    uniforms: Vec<Uniforms>,
    targets: Option<Targets>,
    nearest: Arc<Sampler>,
    constants: Constants,
    scene_format: vk::Format,
    kept: Option<Drawing>,
    redrawn: bool,
    sample_index: u32,
}

impl Renderer {
    /// Frame slots: while the device draws one, the CPU prepares the next.
    pub const IN_FLIGHT: usize = 2;
    /// Format of every picture.
    pub const OUTPUT_FORMAT: vk::Format = Swapchain::FORMAT;

    /// Makes a renderer whose HDR targets have `scene_format`: half floats for a window, full floats to measure.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, scene_format: vk::Format) -> Result<Self, GpuError> {
        Ok(Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            frames: Frames::new(gpu, Self::IN_FLIGHT)?,
            uniforms: (0..Self::IN_FLIGHT).map(|_| Uniforms::new(gpu)).collect::<Result<_, _>>()?,
            targets: None,
            nearest: Sampler::new(gpu, &SamplerDesc::NEAREST)?,
            constants: Constants {
                ltc: ltc::table(gpu)?,
                linear: compute::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?,
            },
            scene_format,
            kept: None,
            redrawn: false,
            sample_index: 0,
        })
    }

    /// Format of the HDR targets.
    pub fn scene_format(&self) -> vk::Format {
        self.scene_format
    }

    /// Device time of the newest finished frame, milliseconds.
    pub fn device_ms(&self) -> Option<f64> {
        self.frames.last_device_ms()
    }

    /// Whether the last frame drew the model, and not only the panels over the picture before.
    pub fn redrawn(&self) -> bool {
        self.redrawn
    }

    /// How many frames the picture is the mean of.
    pub fn accumulated(&self) -> u32 {
        self.sample_index + 1
    }

    /// Raw value at a pixel of the last picture on screen, counted from its upper left corner; `None` outside, or without one.
    ///
    /// # Errors
    /// The device is lost.
    pub fn raw_at(&self, x: u32, y: u32) -> Result<Option<[f32; 4]>, GpuError> {
        match (&self.targets, &self.kept) {
            (Some(targets), Some(_)) => capture::raw_at(&self.gpu, targets.picture(), x, y),
            _ => Ok(None),
        }
    }

    /// SYNC: waits for all frames in flight, before egui's textures change.
    ///
    /// # Errors
    /// The device is lost.
    pub fn wait_for_frames(&mut self) -> Result<(), GpuError> {
        self.frames.wait_all()
    }

    /// Draws one frame.
    ///
    /// # Errors
    /// The device is lost or out of memory.
    pub fn frame(&mut self, input: FrameInput<'_>, mut target: Target<'_>) -> Result<Drawn, GpuError> {
        let size = (input.rect.width.max(1), input.rect.height.max(1));

        // A slot whose last frame is done; then an image to draw to.
        let mut encoder = self.frames.begin()?;
        let acquired = match &mut target {
            Target::Window(swapchain, _) => match swapchain.acquire()? {
                Some(acquired) => Some(acquired),
                None => {
                    self.frames.submit(encoder, Default::default())?;
                    return Ok(Drawn::NoImage);
                }
            },
            Target::Memory | Target::Nowhere | Target::Pixel(..) => None,
        };
        let only = match target {
            Target::Pixel(x, y) => Some(Rect { x, y, width: 1, height: 1 }),
            _ => None,
        };
        let output = match &acquired {
            Some(acquired) => acquired.image.clone(),
            None => self.output_image(size)?,
        };

        // What the shaders read.
        let largest = if self.scene_format == vk::Format::R16G16B16A16_SFLOAT { 65504.0 } else { f32::MAX };
        self.resize_targets(size, &input)?;
        let drawing = Drawing::of(&input, largest, only);
        let is_same = drawing.as_ref().zip(self.kept.as_ref()).is_some_and(|(new, kept)| new.is_same(kept));
        let accumulates = input.pipelines.is_some_and(|(_, wanted)| wanted.accumulates);
        self.sample_index = if is_same && accumulates { self.sample_index.saturating_add(1) } else { 0 };
        let slot = self.frames.current();
        let uniforms = &mut self.uniforms[slot];
        let frame = input.shot.uniforms(input.rect, largest, input.environment.scale, self.sample_index);
        uniforms.write(&frame, &input.shot.lights, &input.shot.params);
        if let Some(tables) = input.pipelines.and_then(|(set, wanted)| set.tables(wanted)) {
            let (environment, measured) = (input.environment.clone(), input.measured.clone());
            let sources = Sources { environment, tables, measured };
            encoder.bind_set(&self.layouts, &uniforms.set(&self.layouts, &sources, &self.constants)?);
        }

        // The model, to HDR; in a window only when something about it has changed.
        let Some(targets) = &self.targets else { return Ok(Drawn::NoImage) };
        self.redrawn = !is_same || accumulates || acquired.is_none();
        if self.redrawn {
            draw_model(&mut encoder, &self.layouts, targets, &input, only);
            encoder.transition(&targets.color, Use::Color, Use::Sampled);
            average(&mut encoder, &self.layouts, targets, &input, only, self.sample_index);
        }
        self.kept = drawing;

        // HDR to the picture: exposure, tone map, sRGB.
        let before = if acquired.is_some() { Use::Acquired } else { Use::Undefined };
        encoder.transition(&output, before, Use::Color);
        let whole = Rect { x: 0, y: 0, width: output.desc().width, height: output.desc().height };
        let attachments = Attachments {
            color: &output,
            clear: Some([0.0, 0.0, 0.0, 1.0]),
            resolve: None,
            depth: None,
            goes_on: false,
            area: whole,
        };
        tone_map(&mut encoder, &self.layouts, targets, &input, only, &attachments);

        // The user interface over it.
        if let Target::Window(_, ui) = &mut target {
            encoder.transition(&output, Use::Color, Use::Color);
            encoder.begin_rendering(&Attachments { clear: None, ..attachments });
            let extent = (whole.width, whole.height);
            ui.renderer.draw(&mut encoder, extent, ui.pixels_per_point, ui.primitives)?;
            encoder.end_rendering();
        }

        self.send(encoder, &output, target, acquired)
    }

    /// Off to the screen, or back to memory.
    fn send(
        &mut self,
        mut encoder: Encoder,
        output: &Arc<Image>,
        target: Target<'_>,
        acquired: Option<Acquired>,
    ) -> Result<Drawn, GpuError> {
        match (target, acquired) {
            (Target::Window(swapchain, _), Some(acquired)) => {
                encoder.transition(output, Use::Color, Use::Present);
                self.frames.submit(encoder, acquired.submission)?;
                Ok(Drawn::Shown { fits: swapchain.present(&acquired)? })
            }
            (Target::Nowhere | Target::Pixel(..), _) => {
                self.frames.submit(encoder, Default::default())?;
                self.frames.wait()?;
                Ok(Drawn::Finished)
            }
            _ => {
                let Some(targets) = &self.targets else { return Ok(Drawn::NoImage) };
                encoder.transition(output, Use::Color, Use::CopyFrom);
                encoder.transition(targets.picture(), Use::Sampled, Use::CopyFrom);
                let readback = Readback::record(&self.gpu, &mut encoder, output, targets.picture())?;
                encoder.transition(targets.picture(), Use::CopyFrom, Use::Sampled);
                self.frames.submit(encoder, Default::default())?;
                self.frames.wait()?;
                Ok(Drawn::Captured(readback.finish()))
            }
        }
    }

    fn output_image(&self, (width, height): (u32, u32)) -> Result<Arc<Image>, GpuError> {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        Image::new(&self.gpu, "picture", ImageDesc::new(width, height, Self::OUTPUT_FORMAT, usage))
    }

    fn resize_targets(&mut self, size: (u32, u32), input: &FrameInput<'_>) -> Result<(), GpuError> {
        let wanted = input.pipelines.map(|(_, wanted)| wanted);
        let purpose = Purpose {
            size,
            samples: wanted.map_or(1, |wanted| wanted.samples),
            format: self.scene_format,
            transmission: input.scene.is_some_and(|scene| scene.is_transmissive()),
            accumulates: wanted.is_some_and(|wanted| wanted.accumulates),
        };
        if self.targets.as_ref().is_some_and(|targets| targets.purpose == purpose) {
            return Ok(());
        }
        self.kept = None;
        let samplers = (&self.nearest, &self.constants.linear);
        self.targets = Some(Targets::new(&self.gpu, &self.layouts, purpose, samplers)?);
        Ok(())
    }
}
