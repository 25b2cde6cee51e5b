//! The passes of the shader tree: their images and buffers, and how a view draws those that make an image or a new picture.
//!
//! Images and buffers belong to the view (`images.rs`); those that a new graph needs unchanged stay, with their
//! content, so an edit does not end a simulation. Images with the same properties share one image of the device if one
//! is read for the last time before the other is drawn (`lifetimes.rs`); depth, and the first level of images with mip
//! levels, are needed only while a pass draws, so all passes share them. `--memory` limits what is left (`memory.rs`):
//! exceeding it is an error at the line of the pass for commands, and a notice over the last frame in a window. Between
//! passes every image is in `Use::Sampled`.
//!
//! The optimized modules tell which resources a pipeline reads: bindings, and bytes of the block `Frame`
//! (`gpu::ResourceUsage`). A branch that a constant switches off does not count. Three decisions follow:
//!
//! - An image is reused if it would be the same (`reuse.rs`): nothing differs in its pipelines, the images and textures
//!   that it reads, the model, and the bytes of uniform blocks that it uses. So a shadow map is drawn again when a
//!   light moves, and stays while the camera does. Compute passes, passes that `keep`, and those that read `picture`,
//!   `depth` or a buffer are always drawn.
//! - A picture is animated if a pipeline reads the clock (`interface::CLOCK`), or a pass depends on time: it reads the
//!   previous frame or a buffer. The window then draws continuously. Without a window, `--frames`, `--time` and `--fps`
//!   give the times, and each picture begins with empty images. Accumulation by path tracing continues while only what
//!   follows the model is animated.
//! - A picture that reads keys (`interface::KEYS`) is drawn again when one of them changes, and once more after a
//!   press, which counts in one frame. Other pictures get no keys, so they stay the same whatever is pressed. If a
//!   pipeline reads `frame.clip_from_world_before`, the window draws once more after the camera has come to rest.

mod blocks;
mod cache_key;
mod context;
mod desc;
mod images;
mod lifetimes;
mod memory;
mod phase;
mod reads;
mod reuse;
mod sets;

use std::collections::BTreeMap;
use std::sync::Arc;

use super::capture::PixelReadback;
use crate::frame::PipelineKey;
use crate::gpu::{DescriptorSet, Encoder, Gpu, GpuError, Image, Sampler, SetLayouts, SetWriter, Use};
use crate::interface::SET_TASK;
use crate::render::bound_frame::BoundFrame;
use crate::shader::GraphPass;
use crate::shader::annotation::pass::{PassFormat, PassTarget};
use crate::shader::graph::{RenderPhase, TextureKind};
pub(super) use blocks::Blocks;
pub(super) use context::{DeclaredPasses, PassContext};
use images::Images;
pub use memory::beyond_memory;
use phase::uses_buffers;
pub(super) use reads::FrameImages;
use reads::Reads;
pub(super) use sets::PassSets;
use sets::Sets;

impl DeclaredPasses {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        linear: &Arc<Sampler>,
        nearest: &Arc<Sampler>,
    ) -> Result<Self, GpuError> {
        let blanks = TextureKind::ALL.map(|kind| Ok((kind, images::blank(gpu, kind)?)));
        let blanks: BTreeMap<TextureKind, Arc<Image>> = blanks.into_iter().collect::<Result<_, GpuError>>()?;
        Ok(Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            linear: linear.clone(),
            nearest: nearest.clone(),
            blank: blanks[&TextureKind::Flat].clone(),
            blanks,
            task_set: DescriptorSet::new(layouts, SET_TASK, SetWriter::default())?,
            images: Images::default(),
            sets: Sets::default(),
            picture: None,
            display: None,
        })
    }

    /// Creates the images and buffers that `frame` needs. Those that still fit keep their content. Returns false if the
    /// requirements are unchanged.
    pub(super) fn prepare(&mut self, frame: &BoundFrame) -> Result<bool, GpuError> {
        let next = self.images.next(&self.gpu, frame)?;
        let is_new = next.is_some();
        if let Some(next) = next {
            self.images = next;
            self.sets.clear();
            (self.picture, self.display) = (None, None);
        }
        Ok(is_new)
    }

    /// Makes the next frame clear the images and buffers that depend on earlier frames to 0.
    pub(super) fn restart(&mut self) {
        self.images.restart();
    }

    /// The HDR image that the tone map reads, if a pass has changed it or a pass's image is shown.
    pub(super) fn picture(&self) -> Option<&Arc<Image>> {
        self.picture.as_ref()
    }

    /// Draws the passes whose images the model reads.
    pub(super) fn before_model(&mut self, encoder: &mut Encoder, context: &PassContext<'_>) -> Result<(), GpuError> {
        self.images.begin_frame(encoder);
        let nothing = self.blank.clone();
        self.run(encoder, context, &nothing, RenderPhase::BeforeModel)?;
        finish_buffers(encoder, context);
        Ok(())
    }

    /// Draws the passes between the model and the tone map. `picture` is in [`Use::Sampled`].
    pub(super) fn before_tonemap(
        &mut self,
        encoder: &mut Encoder,
        context: &PassContext<'_>,
        picture: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let last = self.run(encoder, context, picture, RenderPhase::Light)?;
        finish_buffers(encoder, context);
        self.picture = (!Arc::ptr_eq(&last, picture)).then_some(last);
        let shown = shown_image(context.frame).filter(|(_, pass)| pass.phase != RenderPhase::Display);
        // The tone map reads an image of the frame's size.
        if let Some((name, pass)) = shown
            && let (Some(from), Some(to)) = (self.images.current(name), self.images.shown())
        {
            show(encoder, from, to, pass);
            self.picture = Some(to.clone());
        }
        Ok(())
    }

    /// The values of a watched expression that follow the displayed picture, once they are drawn.
    pub(super) fn values_on_display(&self, frame: &BoundFrame) -> Option<&Arc<Image>> {
        self.images.shown().filter(|_| frame.state.pipelines.watches_display())
    }

    /// Records the copies of a pixel of the frame in the images of its passes that have four floats.
    pub(super) fn record_pixels(
        &self,
        encoder: &mut Encoder,
        frame: &BoundFrame,
        at: Option<(u32, u32)>,
        pixels: &mut Vec<(String, PixelReadback)>,
        picture: u64,
    ) -> Result<(), GpuError> {
        let Some((x, y)) = at else {
            pixels.clear();
            return Ok(());
        };
        let (width, height) = frame.state.size;
        let passes = frame.state.pipelines.passes.iter().filter(|pass| pass.desc.to == PassTarget::Image);
        let images = passes.flat_map(|pass| pass.desc.images().map(move |(name, format)| (pass, name, format)));
        let read = images.filter(|(.., format)| matches!(format, PassFormat::Rgba16f | PassFormat::Rgba32f));
        let read: Vec<_> = read.filter_map(|(pass, name, _)| Some((pass, name, self.images.current(name)?))).collect();
        pixels.clear();
        for (pass, name, image) in read {
            let of = image.desc();
            let row = y * of.height / height;
            let row = if pass.desc.rows_up { of.height.saturating_sub(row + 1) } else { row };
            let mut pixel = PixelReadback::new(&self.gpu)?;
            pixel.is_plain = true;
            pixel.record(encoder, image, Some((x * of.width / width, row)), picture);
            pixels.push((format!("pass:{name}"), pixel));
        }
        Ok(())
    }

    /// Whether passes come after the tone map.
    pub(super) fn has_display_passes(frame: &BoundFrame) -> bool {
        frame.state.pipelines.passes.iter().any(|pass| pass.phase == RenderPhase::Display)
    }

    /// Lets `tone_map` draw to an image of its own, and draws the passes after it. Returns the image for the display, in
    /// [`Use::Sampled`]: the previous one unless the frame was `redrawn`. If an expression of one of these passes is watched, `map_values`
    /// draws that image from [`DeclaredPasses::values_on_display`].
    pub(super) fn on_display(
        &mut self,
        encoder: &mut Encoder,
        context: &PassContext<'_>,
        redrawn: bool,
        tone_map: impl FnOnce(&mut Encoder, &Arc<Image>),
        map_values: impl FnOnce(&mut Encoder, &Arc<Image>),
    ) -> Result<Option<Arc<Image>>, GpuError> {
        if let Some(last) = self.display.clone().filter(|_| !redrawn) {
            return Ok(Some(last));
        }
        let Some(first) = self.images.displays.first().cloned() else { return Ok(None) };
        encoder.transition(&first, Use::Undefined, Use::Color);
        encoder.pass("tone map", |encoder| tone_map(encoder, &first));
        encoder.transition(&first, Use::Color, Use::Sampled);
        let mut last = self.run(encoder, context, &first, RenderPhase::Display)?;
        let shown = shown_image(context.frame).filter(|(_, pass)| pass.phase == RenderPhase::Display);
        if let Some((name, pass)) = shown
            && let Some(from) = self.images.current(name)
        {
            if let Some(values) = self.values_on_display(context.frame) {
                show(encoder, from, values, pass);
                last = first;
                encoder.transition(&last, Use::Undefined, Use::Color);
                encoder.pass("tone map", |encoder| map_values(encoder, &last));
                encoder.transition(&last, Use::Color, Use::Sampled);
            } else if let Some(to) = self.images.other_picture(RenderPhase::Display, &last) {
                show(encoder, from, to, pass);
                last = to.clone();
            }
        }
        self.display = Some(last.clone());
        Ok(Some(last))
    }

    /// Marks all images as undefined: the frame's commands were not submitted.
    pub(super) fn forget(&mut self) {
        self.images.forget();
        (self.picture, self.display) = (None, None);
    }

    /// Drops the cached sets, which keep images alive that were replaced.
    pub(super) fn targets_replaced(&mut self) {
        self.drop_sets();
        self.picture = None;
    }

    /// [`Self::targets_replaced`], where the picture is still to be read.
    pub(super) fn drop_sets(&mut self) {
        self.sets.clear();
    }

    /// The sets of the pipelines of `keys`, which draw to the HDR target. They read the current images of passes.
    pub(super) fn sets_of(
        &mut self,
        context: &PassContext<'_>,
        images: &FrameImages<'_>,
        keys: impl Iterator<Item = PipelineKey>,
    ) -> Result<PassSets, GpuError> {
        let passes = &context.frame.state.pipelines.passes;
        let mut sets = PassSets::default();
        for key in keys {
            let Some(pipeline) = context.frame.pipelines.get(&key) else { continue };
            let pass = &key.pass.0;
            let index = passes.iter().position(|other| Arc::ptr_eq(other, pass));
            let reads = Reads { name: pass.name(), inputs: &pass.inputs, images, index };
            sets.insert(pipeline, self.set(&pipeline.layout, context, &reads)?);
        }
        Ok(sets)
    }
}

/// The pass whose own image the frame shows, if it shows one.
fn shown_image(frame: &BoundFrame) -> Option<(&str, &Arc<GraphPass>)> {
    let request = &frame.state.pipelines;
    let shown = request.shown_pass.as_deref()?;
    let pass = request.passes.iter().find(|pass| pass.desc.draws(shown))?;
    Some((shown, pass))
}

/// Scales an image to the size of another. Leaves both in [`Use::Sampled`].
fn show(encoder: &mut Encoder, from: &Arc<Image>, to: &Arc<Image>, pass: &GraphPass) {
    encoder.transition(from, Use::Sampled, Use::CopyFrom);
    encoder.transition(to, Use::Undefined, Use::CopyTo);
    match pass.desc.rows_up {
        true => encoder.pick_flipped(from, to),
        // Flags in alpha have no mean.
        false if pass.desc.watches.is_some() => encoder.pick(from, to),
        false => encoder.scale(from, to),
    }
    encoder.transition(from, Use::CopyFrom, Use::Sampled);
    encoder.transition(to, Use::CopyTo, Use::Sampled);
}

/// SYNC: makes what passes wrote to buffers visible to the passes that make up the picture, if one of them reads a buffer.
fn finish_buffers(encoder: &mut Encoder, context: &PassContext<'_>) {
    let makes_picture = |pass: &&Arc<GraphPass>| {
        matches!(pass.phase, RenderPhase::Model | RenderPhase::Resolve | RenderPhase::Mean | RenderPhase::Tonemap)
    };
    if context.frame.state.pipelines.passes.iter().filter(makes_picture).any(|pass| uses_buffers(pass)) {
        encoder.buffers_done();
    }
}
