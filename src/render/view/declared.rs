//! The passes that the shader tree declares: their images and buffers, and how a view draws them.

mod blocks;
mod images;
mod sets;

use std::sync::Arc;

use crate::frame::PipelineKey;
use crate::gpu::{
    Attachments, DescriptorSet, Encoder, Gpu, GpuError, Image, PassLayout, PassResource, Sampler, SetLayouts,
    SetWriter, Use,
};
use crate::interface::{SET_PASS, SET_TASK};
use crate::render::resources::BoundFrame;
use crate::shader::GraphPass;
use crate::shader::annotation::pass::Dispatch;
use crate::shader::graph::Input;
pub(super) use blocks::Blocks;
use images::Images;
use sets::Sets;

/// Draws the declared passes of a view, and keeps their images, buffers and descriptor sets between frames.
pub(super) struct DeclaredPasses {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    /// Interpolates between texels and between levels.
    linear: Arc<Sampler>,
    nearest: Arc<Sampler>,
    /// Reads as 0. Passes read it in place of a missing image, such as that of a pass that is switched off.
    blank: Arc<Image>,
    /// The set of tasks, through which compute stages report endless loops.
    task_set: Arc<DescriptorSet>,
    images: Images,
    sets: Sets,
    /// The HDR picture after the passes before the tone map, or the image of the shown pass.
    picture: Option<Arc<Image>>,
    /// The displayed picture, after the passes that follow the tone map.
    display: Option<Arc<Image>>,
}

/// The arguments of a frame's passes.
pub(super) struct Drawn<'a> {
    pub(super) frame: &'a BoundFrame,
    pub(super) frame_set: &'a Arc<DescriptorSet>,
    pub(super) blocks: &'a Blocks,
    /// Depth of the model, one sample a pixel.
    pub(super) depth: Option<&'a Arc<Image>>,
}

/// Number of cached sets per pass at which the cache is cleared: the sets of two frame slots with two images each, and
/// spares.
const SETS_KEPT: usize = 8;

impl DeclaredPasses {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        linear: &Arc<Sampler>,
        nearest: &Arc<Sampler>,
    ) -> Result<Self, GpuError> {
        Ok(Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            linear: linear.clone(),
            nearest: nearest.clone(),
            blank: images::blank(gpu)?,
            task_set: DescriptorSet::new(layouts, SET_TASK, SetWriter::default())?,
            images: Images::default(),
            sets: Sets::default(),
            picture: None,
            display: None,
        })
    }

    /// Creates the images and buffers that `frame` needs. Those that still fit are kept, with their content. Returns
    /// false if the needs are the same as before.
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

    /// Makes the next frame clear all images and buffers to 0.
    pub(super) fn restart(&mut self) {
        self.images.restart();
    }

    /// The HDR picture that the tone map reads, if a pass has changed it or a pass's image is shown.
    pub(super) fn picture(&self) -> Option<&Arc<Image>> {
        self.picture.as_ref()
    }

    /// Draws the passes before the tone map. `picture` is in [`Use::Sampled`].
    pub(super) fn before_tonemap(
        &mut self,
        encoder: &mut Encoder,
        drawn: &Drawn<'_>,
        picture: &Arc<Image>,
    ) -> Result<(), GpuError> {
        self.images.begin_frame(encoder);
        let last = self.run(encoder, drawn, picture, false)?;
        self.picture = (!Arc::ptr_eq(&last, picture)).then_some(last);
        let shown = shown_image(drawn.frame).filter(|pass| !pass.after_tonemap);
        // The tone map reads an image of the picture's size.
        if let Some(pass) = shown
            && let (Some(from), Some(to)) = (self.images.current(pass.name()), self.images.shown())
        {
            scale(encoder, from, to);
            self.picture = Some(to.clone());
        }
        Ok(())
    }

    /// Whether passes come after the tone map.
    pub(super) fn has_display_passes(frame: &BoundFrame) -> bool {
        frame.state.pipelines.passes.iter().any(|pass| pass.after_tonemap)
    }

    /// Lets `tone_map` draw to an intermediate image, and draws the passes after the tone map. Returns the image for
    /// the display, in [`Use::Sampled`]. It is the image of the previous frame unless the picture was `redrawn`.
    pub(super) fn on_display(
        &mut self,
        encoder: &mut Encoder,
        drawn: &Drawn<'_>,
        redrawn: bool,
        tone_map: impl FnOnce(&mut Encoder, &Arc<Image>),
    ) -> Result<Option<Arc<Image>>, GpuError> {
        if let Some(last) = self.display.clone().filter(|_| !redrawn) {
            return Ok(Some(last));
        }
        let Some(first) = self.images.displays.first().cloned() else { return Ok(None) };
        encoder.transition(&first, Use::Undefined, Use::Color);
        encoder.pass("tone map", |encoder| tone_map(encoder, &first));
        encoder.transition(&first, Use::Color, Use::Sampled);
        let mut last = self.run(encoder, drawn, &first, true)?;
        let shown = shown_image(drawn.frame).filter(|pass| pass.after_tonemap);
        if let Some(pass) = shown
            && let (Some(from), Some(to)) = (self.images.current(pass.name()), self.images.other_picture(true, &last))
        {
            scale(encoder, from, to);
            last = to.clone();
        }
        self.display = Some(last.clone());
        Ok(Some(last))
    }

    /// Discards the results of the passes, since the frame's commands were not submitted.
    pub(super) fn forget(&mut self) {
        self.restart();
        (self.picture, self.display) = (None, None);
    }

    /// Drops the cached sets, which would keep the replaced targets alive.
    pub(super) fn targets_replaced(&mut self) {
        self.sets.clear();
        self.picture = None;
    }

    /// The set with which the tone map reads `picture`.
    pub(super) fn tonemap_set(&mut self, picture: &Arc<Image>) -> Result<Arc<DescriptorSet>, GpuError> {
        let writer = SetWriter::default().texture(0, picture, &self.nearest);
        let make = || DescriptorSet::new(&self.layouts, SET_PASS, writer);
        self.sets.get(vec![Arc::as_ptr(picture) as usize], SETS_KEPT, make)
    }

    /// Draws the passes before or after the tone map, starting with `picture`. Returns the last picture.
    fn run(
        &mut self,
        encoder: &mut Encoder,
        drawn: &Drawn<'_>,
        picture: &Arc<Image>,
        after_tonemap: bool,
    ) -> Result<Arc<Image>, GpuError> {
        let mut picture = picture.clone();
        let request = &drawn.frame.state.pipelines;
        for (index, pass) in request.passes.iter().enumerate().filter(|(_, pass)| pass.after_tonemap == after_tonemap) {
            let target = match pass.note.to_picture {
                true => self.images.other_picture(after_tonemap, &picture).cloned(),
                false => self.images.target(pass.name()).cloned(),
            };
            let Some(target) = target else { continue };
            let key = request.pass_key(pass);
            encoder.pass(&pass.note.name, |encoder| match key {
                Some(key) => self.draw(encoder, drawn, (index, pass, &key), &picture, &target),
                None => self.dispatch(encoder, drawn, (index, pass), &picture, &target),
            })?;
            match pass.note.to_picture {
                true => picture = target,
                false => self.images.finished(pass.name()),
            }
        }
        Ok(picture)
    }

    fn draw(
        &mut self,
        encoder: &mut Encoder,
        drawn: &Drawn<'_>,
        (index, pass, key): (usize, &Arc<GraphPass>, &PipelineKey),
        picture: &Arc<Image>,
        target: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let Some(pipeline) = drawn.frame.pipelines.get(key) else { return Ok(()) };
        let Some(layout) = &pipeline.layout else { return Ok(()) };
        let set = self.set(layout, drawn, (index, pass), picture, target)?;
        if uses_buffers(pass) {
            encoder.buffers_done();
        }
        let level = self.images.first_level(pass.name()).cloned();
        let color = level.as_ref().unwrap_or(target);
        encoder.transition(color, Use::Undefined, Use::Color);
        encoder.begin_rendering(&Attachments::of(color));
        encoder.bind_pipeline(pipeline);
        encoder.bind_set(&self.layouts, drawn.frame_set);
        encoder.bind_pass_set(layout, &set);
        encoder.draw(3);
        encoder.end_rendering();
        match &level {
            // An attachment has one level. So the pass draws to a separate image, from which all levels are made.
            Some(level) => {
                encoder.transition(level, Use::Color, Use::CopyFrom);
                encoder.transition(target, Use::Undefined, Use::CopyTo);
                encoder.fill_levels(level, target);
                encoder.transition(target, Use::CopyFrom, Use::Sampled);
            }
            None => encoder.transition(target, Use::Color, Use::Sampled),
        }
        Ok(())
    }

    fn dispatch(
        &mut self,
        encoder: &mut Encoder,
        drawn: &Drawn<'_>,
        (index, pass): (usize, &Arc<GraphPass>),
        picture: &Arc<Image>,
        target: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let Some(pipeline) = drawn.frame.pipelines.compute(&pass.note.stage) else { return Ok(()) };
        let Some(layout) = &pipeline.layout else { return Ok(()) };
        let set = self.set(layout, drawn, (index, pass), picture, target)?;
        if uses_buffers(pass) {
            encoder.buffers_done();
        }
        let groups = match pass.note.dispatch {
            Dispatch::Groups(groups) => groups,
            Dispatch::Size => {
                let [x, y, _] = pass.local_size.map(|size| size.max(1));
                [target.desc().width.div_ceil(x), target.desc().height.div_ceil(y), 1]
            }
        };
        let writes_image = pass.inputs.contains(&Input::Output);
        if writes_image {
            encoder.transition(target, Use::Sampled, Use::Storage);
        }
        encoder.dispatch(pipeline, &[drawn.frame_set, &set, &self.task_set], groups);
        if writes_image {
            encoder.transition(target, Use::Storage, Use::Sampled);
        }
        Ok(())
    }

    /// The pass's own set, for its current inputs.
    fn set(
        &mut self,
        layout: &Arc<PassLayout>,
        drawn: &Drawn<'_>,
        (index, pass): (usize, &Arc<GraphPass>),
        picture: &Arc<Image>,
        target: &Arc<Image>,
    ) -> Result<Arc<DescriptorSet>, GpuError> {
        let mut sets = std::mem::take(&mut self.sets);
        let set = self.resources(drawn, (index, pass), picture, target).and_then(|resources| {
            let ids = resources.iter().map(PassResource::id);
            let key = std::iter::once(Arc::as_ptr(layout) as usize).chain(ids).collect();
            let most = SETS_KEPT * drawn.frame.state.pipelines.passes.len();
            sets.get(key, most, || layout.set(&pass.note.name, &resources))
        });
        self.sets = sets;
        set
    }

    /// The inputs of a pass, by binding.
    fn resources<'a>(
        &'a self,
        drawn: &'a Drawn<'_>,
        (index, pass): (usize, &GraphPass),
        picture: &'a Arc<Image>,
        target: &'a Arc<Image>,
    ) -> Result<Vec<PassResource<'a>>, GpuError> {
        let textures = drawn.frame.pipelines.textures();
        // Does not happen: `Images` has a buffer for each name, and `Blocks` has one for each block.
        let missing = || GpuError::NoStage(pass.note.stage.clone());
        let resource = |(binding, input): (usize, &Input)| {
            Ok(match input {
                Input::Picture => self.sampled(picture),
                Input::Depth => PassResource::Texture(drawn.depth.unwrap_or(&self.blank), &self.nearest),
                Input::Image(name) => self.sampled(self.images.current(name).unwrap_or(&self.blank)),
                Input::Before(name) => self.sampled(self.images.before(name).unwrap_or(&self.blank)),
                Input::Texture(name) => {
                    let (image, sampler) = textures.get(name).unwrap_or((&self.blank, &self.linear));
                    PassResource::Texture(image, sampler)
                }
                Input::Output => PassResource::Storage(target),
                Input::Buffer(name, _) => PassResource::Buffer(self.images.buffer(name).ok_or_else(missing)?),
                Input::Parameters(..) | Input::Size => {
                    PassResource::Buffer(drawn.blocks.get(index, binding).ok_or_else(missing)?)
                }
            })
        };
        pass.inputs.iter().enumerate().map(resource).collect()
    }

    /// An image for passes to read. Its texels are interpolated if the device supports that for the format.
    fn sampled<'a>(&'a self, image: &'a Arc<Image>) -> PassResource<'a> {
        let blends = self.gpu.blends_texels(image.desc().format);
        PassResource::Texture(image, if blends { &self.linear } else { &self.nearest })
    }
}

/// The pass whose own image the frame shows, if it shows one.
fn shown_image(frame: &BoundFrame) -> Option<&Arc<GraphPass>> {
    let request = &frame.state.pipelines;
    let shown = request.shown_pass.as_deref()?;
    request.passes.iter().find(|pass| pass.name() == shown && !pass.note.to_picture)
}

/// Scales an image to the size of another. Leaves both in [`Use::Sampled`].
fn scale(encoder: &mut Encoder, from: &Arc<Image>, to: &Arc<Image>) {
    encoder.transition(from, Use::Sampled, Use::CopyFrom);
    encoder.transition(to, Use::Undefined, Use::CopyTo);
    encoder.scale(from, to);
    encoder.transition(from, Use::CopyFrom, Use::Sampled);
    encoder.transition(to, Use::CopyTo, Use::Sampled);
}

fn uses_buffers(pass: &GraphPass) -> bool {
    pass.inputs.iter().any(|input| matches!(input, Input::Buffer(..)))
}
