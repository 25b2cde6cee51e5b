//! The values of one pixel in several modes: only the pixels that share their derivatives are drawn, to targets of two by two pixels.
//!
//! The targets hold the pixels that share derivatives with the inspected one. The viewport is that of the whole frame,
//! moved so that this quad lies at the corner of the targets, so rasterization, derivatives and mip levels are the
//! frame's. Only `gl_FragCoord` differs: shaders use `picture_px()` (`common/picture_px.glsl`) instead, and a user
//! shader that reads `gl_FragCoord` itself gets other coordinates here. Passes after the model, and what lies behind
//! transmissive surfaces, are left out. Where a mode shows a color for each number, the same draw gives the number.

use std::sync::Arc;

use super::capture::PixelReadback;
use super::declared::{FrameImages, PassContext};
use super::passes::Passes;
use super::peel_images::PeelImages;
use super::targets::ColorTarget;
use super::targets::{TargetDesc, Targets};
use super::{BoundFrame, View};
use crate::frame::PipelineRequest;
use crate::gpu::{Attachments, Encoder, Gpu, GpuError, Image, Rect, SetLayouts, Use};
use crate::shader::PixelValue;

/// Draws a pixel of a frame in several modes at once, and reads the values back. It shares nothing with the view of the window
/// but the resources of its frames.
pub struct PixelModes {
    /// Its passes and uniforms. A draw has two slots: one for the passes that the model reads, one for the pixel.
    view: View,
    targets: Option<Targets>,
    /// The targets of the second mode and the following ones.
    more: Vec<ColorTarget>,
    /// The copied values of each draw in flight.
    values: Vec<Vec<PixelReadback>>,
}

impl PixelModes {
    /// Width and height of the targets. Graphics hardware shades pixels in quads of two by two and takes derivatives within a
    /// quad.
    const QUAD: u32 = 2;

    /// Creates the uniforms for this many draws in flight.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, in_flight: usize) -> Result<Self, GpuError> {
        let values = (0..in_flight).map(|_| Vec::new()).collect();
        Ok(Self { view: View::new(gpu, layouts, 2 * in_flight)?, targets: None, more: Vec::new(), values })
    }

    /// Draws the pixel `at`, counted from the upper left corner, of `frame`, a state of [`crate::frame::FrameState::of_modes`]
    /// with one sample per pixel. `slot` is one of the draws in flight, from 0. Passes after the model are left out, and
    /// transmissive surfaces show nothing behind them.
    ///
    /// # Errors
    /// Out of memory. Drop this object then, unless the commands are not submitted.
    pub fn draw(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        at: (u32, u32),
    ) -> Result<(), GpuError> {
        self.prepare(slot, frame)?;
        let (of_passes, of_pixel) = (2 * slot, 2 * slot + 1);
        let view = &mut self.view;
        let sets = [view.frame_set(of_passes, frame)?, view.frame_set(of_pixel, frame)?];
        let Some(targets) = &self.targets else { return Ok(()) };
        let state = &frame.state;
        let whole = Rect { x: 0, y: 0, width: state.size.0, height: state.size.1 };
        let constants = frame.constants(whole, 0, state.camera.clip_from_world());
        let origin = (at.0 / Self::QUAD * Self::QUAD, at.1 / Self::QUAD * Self::QUAD);
        let mut at_pixel = constants;
        at_pixel.viewport_origin_px = [-(origin.0 as f32), -(origin.1 as f32)];
        for (slot, constants) in [(of_passes, &constants), (of_pixel, &at_pixel)] {
            view.in_flight[slot].uniforms.write(constants, (&frame.lights(), &frame.state.light_grid), state.params());
        }

        let placed = view.motion.place(encoder, of_passes, frame, &sets[0], false)?;
        let placed = placed.as_ref();
        let context = |slot: usize| {
            let (frame_set, constants) = (&sets[slot % 2], if slot == of_pixel { &at_pixel } else { &constants });
            PassContext { frame, placed, frame_set, blocks: &view.in_flight[slot].blocks, constants, depth: None }
        };
        encoder.bind_set(&view.layouts, &sets[0]);
        view.declared.before_model(encoder, &context(of_passes))?;
        encoder.bind_set(&view.layouts, &sets[1]);
        let images = FrameImages { picture: Some(&targets.color), ..FrameImages::default() };
        let pass_sets = view.declared.sets_of(&context(of_pixel), &images, state.pipelines.model_keys())?;
        let more = &self.more[..state.pipelines.modes.len().saturating_sub(1)];
        let peeling = PeelImages::new(&mut view.declared, &context(of_pixel), targets)?;
        let (layouts, sets, peeling) = (&view.layouts, &pass_sets, peeling.as_ref());
        let passes = Passes { layouts, targets, frame, placed, sets, only: None, more, peeling, part: None };
        let all: Vec<&Arc<Image>> =
            std::iter::once(&targets.color).chain(more.iter().map(|target| &target.color)).collect();
        encoder.pass("inspector", |encoder| draw_pixel(encoder, &passes, &all, origin));
        for (image, value) in all.into_iter().zip(&mut self.values[slot]) {
            encoder.transition(image, Use::Color, Use::Sampled);
            value.record(encoder, image, Some((at.0 - origin.0, at.1 - origin.1)), 0);
        }
        Ok(())
    }

    /// Creates the targets and buffers that `frame` needs.
    fn prepare(&mut self, slot: usize, frame: &BoundFrame) -> Result<(), GpuError> {
        let gpu = self.view.gpu.clone();
        self.view.declared.prepare(frame)?;
        let request = &frame.state.pipelines;
        let desc = TargetDesc {
            size: (Self::QUAD, Self::QUAD),
            format: request.target,
            transmission: false,
            accumulates: false,
            reads_depth: false,
            resolves_last: false,
            peels: request.peel_pass().is_some(),
        };
        let targets = match self.targets.take().filter(|targets| targets.desc == desc) {
            Some(targets) => targets,
            None => {
                self.more.clear();
                Targets::new(&gpu, desc)?
            }
        };
        while self.more.len() + 1 < request.modes.len() {
            self.more.push(targets.another_color(&gpu)?);
        }
        self.targets = Some(targets);
        let values = &mut self.values[slot];
        let count = request.modes.len().max(1);
        values.truncate(count);
        while values.len() < count {
            values.push(PixelReadback::new(&gpu)?);
        }
        Ok(())
    }

    /// The values that the last draw of `slot` has read, in the order of its modes. SYNC: after that draw's fence.
    pub fn values(&self, slot: usize) -> Vec<PixelValue> {
        let values = self.values.get(slot).into_iter().flatten();
        values.filter_map(|value| value.read()).map(|pixel| pixel.value).collect()
    }

    /// Marks the targets as undefined: the commands of a frame were not submitted.
    pub fn forget(&mut self) {
        self.view.forget();
    }
}

/// Draws the surfaces, what lies behind them, and passes that draw the model too. Leaves all images in [`Use::Color`].
fn draw_pixel(encoder: &mut Encoder, passes: &Passes<'_>, all: &[&Arc<Image>], origin: (u32, u32)) {
    let (frame, depth) = (passes.frame, &passes.targets.depth);
    all.iter().for_each(|image| encoder.transition(image, Use::Undefined, Use::Color));
    encoder.transition(depth, Use::Undefined, Use::Depth);
    let sorted = passes.sorted();
    let further: Vec<Arc<Image>> = all.iter().skip(1).map(|image| (*image).clone()).collect();
    let Some(first) = all.first() else { return };
    let begin = |encoder: &mut Encoder, color: &Arc<Image>, more: &[Arc<Image>], clear| {
        let attachments =
            Attachments { more, clear, depth: Some(depth), keeps_contents: true, ..Attachments::of(color) };
        encoder.begin_rendering(&attachments);
        encoder.set_part_of_picture(origin, frame.state.size);
    };
    let go_on = |encoder: &mut Encoder| {
        encoder.end_rendering();
        all.iter().for_each(|image| encoder.transition(image, Use::Color, Use::Color));
        encoder.transition(depth, Use::Depth, Use::Depth);
    };
    begin(encoder, first, &further, Some([0.0; 4]));
    passes.draw(encoder, &sorted, &sorted.opaque, PipelineRequest::model_key);
    passes.draw(encoder, &sorted, &sorted.transmissive, PipelineRequest::model_key);
    go_on(encoder);
    for color in all {
        begin(encoder, color, &[], None);
        passes.added(encoder, false);
        passes.background(encoder);
        go_on(encoder);
    }
    match passes.peeling.filter(|_| !sorted.blended.is_empty()) {
        Some(peeling) => passes.peel(encoder, &sorted, peeling, |encoder, to| {
            let more = if to.is_shaded { &further[..] } else { &[] };
            let (depth, clear_depth) = (Some(to.depth), to.clear_depth);
            let attachments = Attachments { more, depth, clear_depth, keeps_contents: true, ..Attachments::of(first) };
            encoder.begin_rendering(&attachments);
            encoder.set_part_of_picture(origin, frame.state.size);
        }),
        None => {
            begin(encoder, first, &further, None);
            passes.draw(encoder, &sorted, &sorted.blended, PipelineRequest::model_key);
            encoder.end_rendering();
        }
    }
    all.iter().for_each(|image| encoder.transition(image, Use::Color, Use::Color));
    encoder.transition(depth, Use::Depth, Use::Depth);
    for color in all {
        begin(encoder, color, &[], None);
        passes.added(encoder, true);
        encoder.end_rendering();
    }
}
