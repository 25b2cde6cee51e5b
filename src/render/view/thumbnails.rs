//! Thumbnails: small pictures of several modes, drawn at once and copied to their places in one image.

use std::sync::Arc;

use super::declared::{Drawn, Given};
use super::passes::{ColorTarget, Passes};
use super::{BoundFrame, View};
use crate::gpu::{Encoder, Gpu, GpuError, Image, ImageDesc, Rect, SetLayouts, Use, vk};

/// Draws thumbnails. It has targets of its own and shares nothing with the large picture but the resources of its frames.
pub struct Thumbnails {
    view: View,
    /// The targets of the second mode and the following ones.
    more: Vec<ColorTarget>,
    /// A thumbnail before it is copied to its place.
    output: Option<Arc<Image>>,
}

impl Thumbnails {
    /// Modes that are drawn at once, where the device has as many color targets.
    const MOST_AT_ONCE: usize = 8;

    /// Creates the uniforms for this many sets of modes in flight.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, in_flight: usize) -> Result<Self, GpuError> {
        Ok(Self { view: View::new(gpu, layouts, in_flight)?, more: Vec::new(), output: None })
    }

    /// The largest number of modes that a device draws at once: the size of a set in [`crate::frame::mode_sets`].
    pub fn most_at_once(gpu: &Gpu) -> usize {
        Self::MOST_AT_ONCE.min(gpu.max_color_targets() as usize)
    }

    /// Draws the modes of `frame`, a state of [`crate::frame::FrameState::of_modes`], and copies the thumbnail of each to its corner in
    /// `atlas`. `slot` is one of those in flight. The atlas is in [`Use::CopyTo`] before and after.
    ///
    /// # Errors
    /// Out of memory. Drop the thumbnails then, unless the commands are not submitted.
    pub fn draw(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        atlas: &Arc<Image>,
        corners: &[(u32, u32)],
    ) -> Result<(), GpuError> {
        self.prepare(frame)?;
        let view = &mut self.view;
        let set = view.frame_set(slot, frame)?;
        let (Some(targets), Some(output)) = (&view.targets, &self.output) else { return Ok(()) };
        let in_flight = &mut view.in_flight[slot];
        let (width, height) = frame.state.size;
        let rect = Rect { x: 0, y: 0, width, height };
        let camera = frame.state.camera.clip_from_world();
        let constants = frame.state.constants(rect, frame.environment.scale_and_sun(), 0, camera);
        in_flight.uniforms.write(&constants, &frame.state.lights, frame.state.params());
        encoder.bind_set(&view.layouts, &set);

        let (depth, blocks) = (targets.read_depth(), &in_flight.blocks);
        let drawn = Drawn { frame, frame_set: &set, blocks, constants: &constants, depth };
        view.declared.before_model(encoder, &drawn)?;
        let request = &frame.state.pipelines;
        let behind = targets.behind.as_ref().filter(|_| request.modes.is_empty());
        let given = Given { picture: Some(&targets.color), behind, ..Given::default() };
        let sets = view.declared.sets_of(&drawn, &given, request.model_keys())?;
        let more = &self.more[..request.modes.len().saturating_sub(1)];
        let passes = Passes { layouts: &view.layouts, targets, frame, sets: &sets, only: None, more };
        match &*request.modes {
            [] => passes.model(encoder),
            _ => encoder.pass("thumbnails", |encoder| passes.modes(encoder)),
        }

        let pictures = std::iter::once(&targets.color).chain(more.iter().map(|target| &target.color));
        for ((picture, key), corner) in pictures.zip(request.tonemap_keys()).zip(corners) {
            encoder.transition(picture, Use::Color, Use::Sampled);
            let given = Given { picture: Some(picture), ..Given::default() };
            let sets = view.declared.sets_of(&drawn, &given, std::iter::once(key.clone()))?;
            encoder.transition(output, Use::Undefined, Use::Color);
            passes.tone_map_with(encoder, Some(&key), &sets, output, rect);
            encoder.transition(output, Use::Color, Use::CopyFrom);
            encoder.copy_image_to(output, atlas, *corner);
        }
        Ok(())
    }

    /// Creates the targets that `frame` needs.
    fn prepare(&mut self, frame: &BoundFrame) -> Result<(), GpuError> {
        let gpu = self.view.gpu.clone();
        let view = &mut self.view;
        let before = view.targets.as_ref().map(|targets| targets.color.clone());
        view.prepare(frame)?;
        let Some(targets) = &view.targets else { return Ok(()) };
        if before.is_none_or(|before| !Arc::ptr_eq(&before, &targets.color)) {
            self.more.clear();
        }
        while self.more.len() + 1 < frame.state.pipelines.modes.len() {
            self.more.push(targets.another_color(&gpu)?);
        }
        let (width, height) = frame.state.size;
        if self.output.as_ref().is_none_or(|output| (output.desc().width, output.desc().height) != (width, height)) {
            self.output = Some(view.output_image((width, height))?);
        }
        Ok(())
    }

    /// Forgets what is drawn: the commands of a frame were not submitted.
    pub fn forget(&mut self) {
        self.view.forget();
    }

    /// An image for `columns` x `rows` thumbnails of `size` pixels, which shaders can sample. They read linear values of what thumbnails
    /// store with the sRGB curve, as egui expects.
    ///
    /// # Errors
    /// Out of memory.
    pub fn atlas(gpu: &Arc<Gpu>, size: (u32, u32), (columns, rows): (u32, u32)) -> Result<Arc<Image>, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::SAMPLED | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
        let (width, height) = (size.0 * columns, size.1 * rows);
        Image::new(gpu, "thumbnails", ImageDesc::new(width, height, vk::Format::B8G8R8A8_SRGB, usage))
    }
}
