//! Thumbnails: small pictures of several modes, drawn at once and copied to their places in one image.
//!
//! Up to eight modes share one draw and one pipeline. `spirv::specialize_several` specializes a stage for a set of
//! values of `MODE`: the constant, and what depends on it, become private variables; a new entry point calls the old
//! one once for each mode and writes each color to a target of its own; code that no mode of the set needs is dropped.
//! No uniform holds the mode, so drivers cannot specialize for it again, and ordinary pipelines do not change.
//! `frame::mode_sets` groups modes of one group and stage, so that a set compiles little for one mode alone. One
//! pipeline for all modes would take lavapipe 2 s to compile in the queue, where it holds up frames, and a draw per
//! mode would process the vertices a hundred times.
//!
//! Passes after the model, such as bloom, are left out, and transmissive surfaces show nothing behind them, except in
//! the final picture. Modes of path tracing and images of passes have no thumbnails. A `discard` in one mode of a set,
//! or a loop that does not end, affects the whole set. On lavapipe the first draw of each set compiles it in the queue,
//! and an edit that is saved just then waits for it.

use std::collections::HashMap;
use std::sync::Arc;

use super::declared::{FrameImages, PassContext};
use super::passes::Passes;
use super::targets::ColorTarget;
use super::{BoundFrame, View};
use crate::frame::{Display, Limits};
use crate::gpu::{Encoder, Gpu, GpuError, Image, ImageDesc, Rect, SetLayouts, Use, vk};

/// Draws thumbnails. It has targets of its own and shares nothing with the view of the window but the resources of its frames.
pub struct Thumbnails {
    view: View,
    /// The targets of the second mode and the following ones.
    more: Vec<ColorTarget>,
    /// A thumbnail before it is copied to its place.
    output: Option<Arc<Image>>,
    /// The modes of each slot whose samples have not been read, and what the display makes of them.
    pending: HashMap<usize, Vec<(u32, u8, Display)>>,
    /// The limits of the values of each mode, by the value of `MODE`.
    limits: HashMap<u32, Limits>,
}

impl Thumbnails {
    /// Most modes that one draw can show, where the device has as many color targets.
    const MOST_AT_ONCE: usize = 8;

    /// Creates the uniforms for this many sets of modes in flight.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, in_flight: usize) -> Result<Self, GpuError> {
        let view = View::new(gpu, layouts, in_flight * Self::MOST_AT_ONCE)?;
        Ok(Self { view, more: Vec::new(), output: None, pending: HashMap::new(), limits: HashMap::new() })
    }

    /// The largest number of modes that a device draws at once: the size of a set in [`crate::frame::mode_sets`].
    pub fn most_at_once(gpu: &Gpu) -> usize {
        Self::MOST_AT_ONCE.min(gpu.max_color_targets() as usize)
    }

    /// Reads the samples of a slot's last draw. Returns the modes, by the value of `MODE`, whose limits they have changed: their
    /// thumbnails are outdated. SYNC: after the fence of that draw.
    pub fn collect(&mut self, slot: usize) -> Vec<u32> {
        let mut changed = Vec::new();
        for (index, (mode, components, display)) in
            self.pending.remove(&slot).unwrap_or_default().into_iter().enumerate()
        {
            let in_flight = self.view.in_flight.get_mut(slot * Self::MOST_AT_ONCE + index);
            let Some(range_sample) = in_flight.and_then(|in_flight| in_flight.range_sample.take()) else { continue };
            let before = self.limits.get(&mode).copied();
            let limits = display.limits(range_sample.limits(components), before);
            if limits != before {
                changed.push(mode);
            }
            match limits {
                Some(limits) => self.limits.insert(mode, limits),
                None => self.limits.remove(&mode),
            };
        }
        changed
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
        let first = slot * Self::MOST_AT_ONCE;
        let set = view.frame_set(first, frame)?;
        let tonemap_sets = (0..corners.len()).map(|index| view.frame_set(first + index, frame));
        let tonemap_sets = tonemap_sets.collect::<Result<Vec<_>, _>>()?;
        let (Some(targets), Some(output)) = (&view.targets, &self.output) else { return Ok(()) };
        let in_flight = &view.in_flight[first];
        let (width, height) = frame.state.size;
        let rect = Rect { x: 0, y: 0, width, height };
        let camera = frame.state.camera.clip_from_world();
        let constants = frame.constants(rect, 0, camera);
        // Each mode has its own range and colors, and so its own constants.
        for (index, in_flight) in view.in_flight[first..].iter().take(corners.len().max(1)).enumerate() {
            let (mode, _, display) = frame.state.displays.get(index).copied().unwrap_or((0, 3, frame.state.display));
            let limits =
                if display.is_measured() { self.limits.get(&mode).copied() } else { display.limits(None, None) };
            let constants = crate::interface::Frame { mode, ..display.constants(constants, limits) };
            in_flight.uniforms.write(&constants, (&frame.lights(), &frame.state.light_grid), frame.state.params());
        }
        encoder.bind_set(&view.layouts, &set);

        let depth = targets.read_depth();
        let blocks = in_flight.blocks.clone();
        let placed = view.motion.place(encoder, first, frame, &set, false)?;
        let placed = placed.as_ref();
        let context = PassContext { frame, placed, frame_set: &set, blocks: &blocks, constants: &constants, depth };
        view.declared.before_model(encoder, &context)?;
        let request = &frame.state.pipelines;
        let opaque_scene = targets.opaque_scene.as_ref().filter(|_| request.modes.is_empty());
        let images = FrameImages { picture: Some(&targets.color), opaque_scene, ..FrameImages::default() };
        let sets = view.declared.sets_of(&context, &images, request.model_keys())?;
        let more = &self.more[..request.modes.len().saturating_sub(1)];
        let (layouts, sets) = (&view.layouts, &sets);
        let passes = Passes { layouts, targets, frame, placed, sets, only: None, more, peeling: None, part: None };
        match &*request.modes {
            [] => passes.model(encoder),
            _ => encoder.pass("thumbnails", |encoder| passes.modes(encoder)),
        }

        let pictures = std::iter::once(&targets.color).chain(more.iter().map(|target| &target.color));
        for (index, ((picture, key), corner)) in pictures.zip(request.tonemap_keys()).zip(corners).enumerate() {
            encoder.transition(picture, Use::Color, Use::Sampled);
            if frame.state.displays.get(index).is_some_and(|(_, _, display)| display.is_measured()) {
                view.in_flight[first + index].range_sample.record(&view.gpu, encoder, picture, 1)?;
                self.pending.insert(slot, frame.state.displays.clone());
            }
            encoder.bind_set(&view.layouts, &tonemap_sets[index]);
            let images = FrameImages { picture: Some(picture), ..FrameImages::default() };
            let sets = view.declared.sets_of(&context, &images, std::iter::once(key.clone()))?;
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

    /// Marks the targets as undefined: the commands of a frame were not submitted.
    pub fn forget(&mut self) {
        self.view.forget();
        self.pending.clear();
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
