//! A view draws [`BoundFrame`]s. It owns the render targets, tracks what they hold, and keeps the mean of an accumulating mode,
//! so that views share nothing but the resources of their frames.
//!
//! `View::draw` writes uniforms, draws the model to an HDR target (4x multisampled by default), resolves it, adds it to
//! the accumulation buffer of an accumulating mode, copies the probed pixel, and tone maps. If nothing has changed,
//! only the tone map runs. Each pass has a debug label and GPU timestamps, which `bench frame` and the panel "Timing"
//! report.
//!
//! A mode that says `accumulate` is a Monte Carlo estimate. `average.frag` adds each frame to an accumulation buffer of
//! full floats with weight 1 / n until anything about the frame changes; `frame.sample_index` selects the next samples.
//!
//! HDR alpha is coverage plus flags: "no data" and "not finite" survive half floats, clamping and the MSAA resolve
//! (`common/pixel.glsl`, decoded by `shader/pixel.rs`). Depth is reversed and infinite. Vertices are read by device
//! address, a draw's matrices are push constants or, in a model of many draws, in a buffer (`model_draws.rs`), and a
//! material is a descriptor set. The debug mode is one specialization constant of `debug.frag`, `MODE`, so the driver
//! keeps the code of one mode only.

mod capture;
mod declared;
mod limits;
mod model_draws;
mod motion;
mod moved_vertices;
mod new_picture;
mod output;
mod parts;
mod passes;
mod peel_images;
mod peeling;
mod pixel_modes;
mod range_sample;
mod results;
mod scan;
mod targets;
mod thumbnails;
mod uniforms;

use std::collections::HashMap;
use std::sync::Arc;

use glam::Mat4;

use capture::PixelReadback;
pub use capture::{Capture, PixelAt, Readback};
pub use declared::beyond_memory;
pub use output::Output;
pub use pixel_modes::PixelModes;
pub use range_sample::RangeSample;
pub use scan::NotFinitePixels;
use targets::{TargetDesc, Targets};
pub use thumbnails::Thumbnails;
pub(crate) use uniforms::{SharedImages, Sources, Uniforms};

use range_sample::RangeSampleReadback;
use scan::Scan;

use declared::{Blocks, DeclaredPasses, FrameImages, PassContext};
use motion::Motion;
use new_picture::{InParts, NewPicture, picture_rect};
use peel_images::PeelImages;

use super::bound_frame::BoundFrame;
use super::scene::PlacedScene;
use crate::frame::{Display, Limits};
use crate::gpu::{DescriptorSet, Encoder, Gpu, GpuError, Image, Rect, Sampler, SamplerDesc, SetLayouts, Use};
use crate::shader::annotation::pass::PassTarget;
use crate::shader::graph::Input;

/// How much of a frame [`View::draw`] draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Redraw {
    /// Draws the model only if it has changed since the last frame; otherwise only tone maps.
    IfChanged,
    /// Forces the model pass. Declared passes still reuse unchanged outputs.
    Always,
    /// Draws the model only if it has changed. Otherwise an accumulation buffer stays as it is, and only the tone map runs.
    ToneMap,
    /// Draws the model, but shades only this pixel, counted from the upper left corner.
    Pixel(u32, u32),
}

/// The resources of one frame in flight.
struct InFlight {
    uniforms: Uniforms,
    blocks: Blocks,
    pixel: PixelReadback,
    /// The pixel in the images of passes, by the slugs of their modes.
    pass_pixels: Vec<(String, PixelReadback)>,
    scan: Option<Scan>,
    range_sample: RangeSampleReadback,
}

/// Draws frames, and redraws only what has changed.
pub struct View {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    shared: SharedImages,
    in_flight: Vec<InFlight>,
    targets: Option<Targets>,
    declared: DeclaredPasses,
    motion: Motion,
    /// The frame that the HDR target holds, and the part of it that was shaded. `None` is all of it.
    drawn: Option<(BoundFrame, Option<Rect>)>,
    /// The next picture, while its model is being drawn in parts.
    parts: Option<InParts>,
    /// The cameras of the last picture and of the one before, as `clip_from_world`.
    cameras: Option<[Mat4; 2]>,
    /// Number of times the model was drawn.
    picture: u64,
    sample_index: u32,
    /// The pixel whose value each frame reports.
    pub probe: Option<(u32, u32)>,
    /// The pixel whose values in the images of passes each frame reports.
    pub probe_passes: Option<(u32, u32)>,
    /// Whether frames also run the fragment stage where a nearer surface hides it, for the list of all fragments. Such a picture is not shown.
    pub draws_hidden: bool,
    /// Whether the next frame looks for NaN and infinity in its picture.
    pub scans: bool,
    /// Whether to sample each frame's values even if no range is automatic.
    pub samples_range: bool,
    /// The newest samples.
    range_sample: Option<Arc<RangeSample>>,
    /// The frame of which the last samples were copied.
    range_sampled: u64,
    /// The limits between which almost all values of a frame lie.
    measured: Option<(u64, Option<Limits>)>,
    /// The value of `MODE`, and its first picture since it was chosen.
    mode_since: Option<(u32, u64)>,
    /// The limits of the last frame of each mode, by the value of `MODE`.
    known_limits: HashMap<u32, Limits>,
    /// The content of the display's constants in the last frame.
    displayed: Option<(Display, Option<Limits>)>,
    /// Whether the last frame showed other limits than the one before.
    limits_changed: bool,
    /// The limits of another view, which replace those of this view's own values.
    followed: Option<Option<Limits>>,
    /// The light of a file, which the tone map reads instead of the rendered frame. It has the size of the frame and is in
    /// [`Use::Sampled`].
    pub override_image: Option<Arc<Image>>,
}

impl View {
    /// An accumulating mode stops after this many frames, unless the caller passes [`Redraw::Always`]. Further frames
    /// make no visible difference.
    pub const MOST_ACCUMULATED: u32 = 4096;

    /// Creates a view for this many frames in flight.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, frames_in_flight: usize) -> Result<Self, GpuError> {
        let in_flight = || -> Result<_, GpuError> {
            let (uniforms, pixel) = (Uniforms::new(gpu)?, PixelReadback::new(gpu)?);
            let (blocks, pass_pixels, scan, range_sample) = Default::default();
            Ok(InFlight { uniforms, blocks, pixel, pass_pixels, scan, range_sample })
        };
        let (nearest, shared) = (Sampler::new(gpu, &SamplerDesc::NEAREST)?, SharedImages::new(gpu)?);
        Ok(Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            declared: DeclaredPasses::new(gpu, layouts, &shared.linear, &nearest)?,
            shared,
            motion: Motion::new(gpu, layouts, frames_in_flight),
            in_flight: (0..frames_in_flight).map(|_| in_flight()).collect::<Result<_, _>>()?,
            targets: None,
            drawn: None,
            parts: None,
            cameras: None,
            picture: 0,
            sample_index: 0,
            probe: None,
            probe_passes: None,
            draws_hidden: false,
            scans: false,
            samples_range: false,
            range_sample: None,
            range_sampled: 0,
            measured: None,
            mode_since: None,
            known_limits: HashMap::new(),
            displayed: None,
            limits_changed: false,
            followed: None,
            override_image: None,
        })
    }

    /// Replaces the targets if they do not fit `frame`. On failure the old targets stay.
    ///
    /// # Errors
    /// Out of memory.
    pub fn prepare(&mut self, frame: &BoundFrame) -> Result<(), GpuError> {
        let request = &frame.state.pipelines;
        let desc = TargetDesc {
            size: frame.state.size,
            format: request.target,
            transmission: request.has_transmission(),
            accumulates: request.accumulates,
            peels: request.peel_pass().is_some(),
            // Several modes at once are resolved by their last draw.
            resolves_last: request.resolves_samples() && request.modes.is_empty(),
            reads_depth: request.passes.iter().any(|pass| pass.inputs.values().any(|input| *input == Input::Depth)),
        };
        if self.targets.as_ref().is_none_or(|targets| targets.desc != desc) {
            self.targets = Some(Targets::new(&self.gpu, desc)?);
            (self.drawn, self.parts) = (None, None);
            self.declared.targets_replaced();
        }
        if self.declared.prepare(frame)? {
            (self.drawn, self.parts) = (None, None);
        }
        Ok(())
    }

    /// Draws `frame` with the uniforms of frame slot `slot`. Call [`View::prepare`] for the frame first, and
    /// [`View::forget`] if the commands are not submitted.
    ///
    /// # Errors
    /// Out of memory. Call [`View::forget`] then.
    pub fn draw(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        output: &Output<'_>,
        redraw: Redraw,
    ) -> Result<(), GpuError> {
        if self.targets.is_none() {
            return Ok(());
        }
        // This can fail, so it comes before the view changes.
        let set = self.frame_set(slot, frame)?;
        let has_display_passes = DeclaredPasses::has_display_passes(frame);
        let rect = picture_rect(frame, output.at);
        let only = match redraw {
            Redraw::Pixel(..) if !frame.state.pipelines.is_local() => None,
            Redraw::Pixel(x, y) => Some(Rect { x, y, width: 1, height: 1 }),
            Redraw::IfChanged | Redraw::Always | Redraw::ToneMap => None,
        };

        let (redrawn, has_model) = self.begin_picture(frame, only, redraw);
        let limits = self.limits_of(frame);
        let limits_changed =
            self.displayed.replace((frame.state.display, limits)) != Some((frame.state.display, limits));
        self.limits_changed = limits_changed;
        let samples_range =
            (self.samples_range || frame.state.display.is_measured()) && self.range_sampled != self.picture;
        let Some(targets) = &self.targets else { return Ok(()) };
        let in_flight = &mut self.in_flight[slot];

        encoder.draw_hidden(self.draws_hidden);
        // Uniforms and set 0.
        let [_, before] = self.cameras.unwrap_or([frame.state.camera.clip_from_world(); 2]);
        let constants = frame.constants(rect, self.sample_index, before);
        let constants = frame.state.display.constants(constants, limits);
        in_flight.uniforms.write(&constants, (&frame.lights(), &frame.state.light_grid), frame.state.params());
        encoder.bind_set(&self.layouts, &set);

        // The passes that the model reads, the model to the HDR target, and the passes before the tone map.
        let (depth, blocks) = (targets.read_depth(), &in_flight.blocks);
        let draws_model = redrawn && !has_model;
        let placed = match draws_model {
            true => self.motion.place(encoder, slot, frame, &set, true)?,
            false => self.motion.placed().cloned(),
        };
        let placed = placed.as_ref();
        let context = PassContext { frame, placed, frame_set: &set, blocks, constants: &constants, depth };
        if draws_model {
            self.declared.before_model(encoder, &context)?;
        }
        let (samples, opaque_scene) = (targets.multisampled.as_ref(), targets.opaque_scene.as_ref());
        let images = FrameImages { picture: Some(&targets.color), samples, opaque_scene, ..FrameImages::default() };
        let keys = redrawn.then(|| frame.state.pipelines.model_keys()).into_iter().flatten();
        let sets = self.declared.sets_of(&context, &images, keys)?;
        let peeling = PeelImages::new(&mut self.declared, &context, targets)?.filter(|_| !self.draws_hidden);
        let (layouts, more, peeling) = (&self.layouts, &[][..], peeling.as_ref());
        let passes = passes::Passes { layouts, targets, frame, placed, sets: &sets, only, more, peeling, part: None };
        if draws_model {
            passes.model(encoder);
        }
        if redrawn {
            encoder.transition(&targets.color, Use::Color, Use::Sampled);
            passes.accumulate(encoder, self.sample_index);
            self.declared.before_tonemap(encoder, &context, targets.picture())?;
        }
        self.drawn = Some((frame.clone(), only));

        // The probed pixel, which `pixel` reads once the frame has finished.
        let drawn_picture = self.declared.picture().unwrap_or(targets.picture());
        let picture = self.override_image.as_ref().unwrap_or(drawn_picture).clone();
        let is_on_display = frame.state.pipelines.shows_display();
        let values = self.declared.values_on_display(frame).cloned();
        let in_light = self.probe.filter(|_| !is_on_display);
        let shown = frame.state.pipelines.shown().map(|pass| &pass.desc);
        let is_plain = shown.is_some_and(|pass| pass.to == PassTarget::Image && pass.watches.is_none());
        (in_flight.pixel.is_plain, in_flight.range_sample.is_plain) = (is_plain, is_plain);
        in_flight.pixel.record(encoder, &picture, in_light, self.picture);
        self.declared.record_pixels(encoder, frame, self.probe_passes, &mut in_flight.pass_pixels, self.picture)?;
        if std::mem::take(&mut self.scans) {
            in_flight.scan = Some(Scan::record(&self.gpu, encoder, &picture, self.picture)?);
        }
        if samples_range && values.is_none() {
            in_flight.range_sample.record(&self.gpu, encoder, &picture, self.picture)?;
            self.range_sampled = self.picture;
        }

        // The HDR target to the display: exposure, tone map, sRGB.
        let images = FrameImages { picture: Some(&picture), ..FrameImages::default() };
        let request = &frame.state.pipelines;
        let of_picture = request.watched_tonemap_key().or_else(|| request.tonemap_key());
        let sets = self.declared.sets_of(&context, &images, of_picture.clone().into_iter())?;
        if !has_display_passes {
            encoder.transition(output.image, output.before, Use::Color);
            encoder.pass("tone map", |encoder| passes.tone_map(encoder, &sets, output.image, rect));
            return Ok(());
        }

        // The LDR output, through the declared passes after the tone map.
        let images = FrameImages { picture: values.as_ref(), ..FrameImages::default() };
        let of_values = request.tonemap_key().filter(|_| values.is_some());
        let value_sets = self.declared.sets_of(&context, &images, of_values.into_iter())?;
        let tone_map = |encoder: &mut Encoder, display: &Arc<Image>| {
            passes.tone_map_with(encoder, of_picture.as_ref(), &sets, display, rect);
        };
        let map_values =
            |encoder: &mut Encoder, display: &Arc<Image>| passes.tone_map(encoder, &value_sets, display, rect);
        let display = self.declared.on_display(encoder, &context, redrawn || limits_changed, tone_map, map_values)?;
        if let Some(values) = &values {
            in_flight.pixel.record(encoder, values, self.probe, self.picture);
            if samples_range {
                in_flight.range_sample.record(&self.gpu, encoder, values, self.picture)?;
                self.range_sampled = self.picture;
            }
        }
        encoder.transition(output.image, output.before, Use::Color);
        output::clear_image(encoder, output.image);
        if let Some(display) = display {
            if is_on_display {
                in_flight.pixel.record(encoder, &display, self.probe, self.picture);
                if let Some(at) = self.probe_passes {
                    let mut pixel = PixelReadback::new(&self.gpu)?;
                    pixel.record(encoder, &display, Some(at), self.picture);
                    in_flight.pass_pixels.push(("final".to_owned(), pixel));
                }
            }
            output::copy_image(encoder, &display, output);
        }
        Ok(())
    }

    /// Set 0 of a frame in a slot, with the blocks of its passes.
    fn frame_set(&mut self, slot: usize, frame: &BoundFrame) -> Result<Arc<DescriptorSet>, GpuError> {
        let sources = Sources {
            environment: frame.environment.clone(),
            tables: frame.tables.clone(),
            measured: frame.measured.clone(),
            path_tracing: frame.path_tracing.clone(),
        };
        let in_flight = &mut self.in_flight[slot];
        in_flight.uniforms.reserve(frame.light_bytes(), frame.state.light_grid.bytes().len())?;
        let set = in_flight.uniforms.set(&self.layouts, &sources, &self.shared)?;
        in_flight.blocks.write(&self.gpu, frame.state.pass_blocks())?;
        Ok(set)
    }

    /// Begins a new picture if this frame draws the model. Returns whether it does, and whether its model has been drawn in parts.
    fn begin_picture(&mut self, frame: &BoundFrame, only: Option<Rect>, redraw: Redraw) -> (bool, bool) {
        let Some(new) = self.new_picture(frame, only, redraw) else { return (false, false) };
        let parts = self.parts.take().filter(|parts| only.is_none() && parts.is_whole() && parts.is_of(frame));
        let has_model = parts.is_some();
        let NewPicture { cameras, sample_index } = parts.map_or(new, |parts| parts.new);
        (self.cameras, self.sample_index) = (Some(cameras), sample_index);
        self.picture += 1;
        (true, has_model)
    }

    /// The picture that this frame begins, if it draws the model. An accumulating mode adds a frame to the accumulation buffer while the
    /// model looks the same, and restarts when that changes.
    fn new_picture(&self, frame: &BoundFrame, only: Option<Rect>, redraw: Redraw) -> Option<NewPicture> {
        let accumulates = frame.state.pipelines.accumulates;
        let drawn = self.drawn.as_ref().filter(|(_, part)| *part == only).map(|(drawn, _)| drawn);
        let unchanged = !self.is_moving(frame) && drawn.is_some_and(|drawn| drawn.is_same(frame));
        let continues = accumulates && !self.is_moving(frame) && drawn.is_some_and(|drawn| drawn.is_same_model(frame));
        let improves = accumulates && self.sample_index + 1 < Self::MOST_ACCUMULATED && redraw != Redraw::ToneMap;
        let redrawn = !unchanged || improves || matches!(redraw, Redraw::Always | Redraw::Pixel(..));
        let now = frame.state.camera.clip_from_world();
        redrawn.then(|| NewPicture {
            cameras: [now, self.cameras.map_or(now, |[last, _]| last)],
            sample_index: if continues { self.sample_index.saturating_add(1) } else { 0 },
        })
    }

    /// Whether the picture shows motion of the camera or the model, so that the next frame differs even if both rest.
    pub fn is_moving(&self, frame: &BoundFrame) -> bool {
        let has_moved = self.motion.has_moved() || self.cameras.is_some_and(|[now, before]| now != before);
        has_moved && frame.reads_motion()
    }

    /// Makes the next frame draw everything: the commands of a frame were not submitted, so the targets may be
    /// undefined.
    pub fn forget(&mut self) {
        (self.drawn, self.parts, self.cameras) = (None, None, None);
        self.range_sampled = 0;
        self.in_flight.iter_mut().for_each(|in_flight| in_flight.scan = None);
        self.declared.forget();
        self.motion.forget();
    }

    /// Makes an accumulating mode start again with the next frame.
    pub fn restart_mean(&mut self) {
        (self.drawn, self.parts) = (None, None);
    }

    /// Restarts the declared passes: the next frame clears the images and buffers that depend on earlier frames to 0.
    pub fn restart_passes(&mut self) {
        (self.parts, self.cameras) = (None, None);
        self.motion.restart();
        self.declared.restart();
    }

    /// The model of the last frame, in its pose.
    pub(crate) fn placed(&self) -> Option<&Arc<PlacedScene>> {
        self.motion.placed()
    }

    /// Fills an output with black while there is no frame to draw.
    pub fn clear(encoder: &mut Encoder, output: &Output<'_>) {
        encoder.transition(output.image, output.before, Use::Color);
        output::clear_image(encoder, output.image);
    }
}
