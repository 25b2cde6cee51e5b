//! Draws the passes of a phase, one after the other.

use std::sync::Arc;

use super::cache_key::PassCacheKey;
use super::context::{DeclaredPasses, PassContext};
use super::reads::{FrameImages, Reads};
use super::reuse;
use super::sets::PassSets;
use crate::gpu::{Attachments, DescriptorSet, Encoder, GpuError, Image, PassLayout, PassResource, Use};
use crate::render::view::model_draws::{ModelDraws, instances};
use crate::shader::GraphPass;
use crate::shader::annotation::pass::Dispatch;
use crate::shader::graph::{Input, RenderPhase};

/// Cached sets per pass at which the cache is cleared: the sets of two frame slots with two images each, and spares.
const SETS_KEPT: usize = 8;

impl DeclaredPasses {
    /// Draws the passes of one phase, starting from this picture. Returns the resulting picture.
    pub(super) fn run(
        &mut self,
        encoder: &mut Encoder,
        context: &PassContext<'_>,
        picture: &Arc<Image>,
        phase: RenderPhase,
    ) -> Result<Arc<Image>, GpuError> {
        let mut picture = picture.clone();
        let request = &context.frame.state.pipelines;
        for (index, pass) in request.passes.iter().enumerate().filter(|(_, pass)| pass.phase == phase) {
            let target = match pass.desc.to_picture() {
                true => self.images.other_picture(phase, &picture).cloned(),
                false => self.images.target(pass.name()).cloned(),
            };
            let Some(target) = target else { continue };
            let images = FrameImages {
                picture: Some(&picture),
                depth: context.depth,
                target: Some(&target),
                ..FrameImages::default()
            };
            let reads = Reads { name: pass.name(), inputs: &pass.inputs, images: &images, index: Some(index) };
            let cache_key = self.cache_key(context, pass, index);
            if cache_key.as_ref().is_some_and(|key| self.images.holds(pass.name(), key)) {
                encoder.kept_pass(pass.name());
                continue;
            }
            encoder.pass(pass.name(), |encoder| match pass.is_compute {
                true => self.dispatch(encoder, context, pass, &reads, &target),
                false => self.draw(encoder, context, pass, &reads, &target),
            })?;
            match pass.desc.to_picture() {
                true => picture = target,
                false => pass.desc.images().for_each(|(name, _)| self.images.finished(name, cache_key.clone())),
            }
        }
        Ok(picture)
    }

    /// The cache key of a pass in this frame.
    fn cache_key(&self, context: &PassContext<'_>, pass: &Arc<GraphPass>, index: usize) -> Option<PassCacheKey> {
        let keys = context.frame.state.pipelines.pass_keys(pass);
        let pipelines: Vec<_> = keys.iter().filter_map(|key| context.frame.pipelines.get(key)).collect();
        reuse::cache_key(pass, index, &pipelines, instances(context.frame, pass), context, &self.images)
    }

    fn draw(
        &mut self,
        encoder: &mut Encoder,
        context: &PassContext<'_>,
        pass: &Arc<GraphPass>,
        reads: &Reads<'_>,
        target: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let request = &context.frame.state.pipelines;
        let mut sets = PassSets::default();
        let keys = request.pass_keys(pass);
        for pipeline in keys.iter().filter_map(|key| context.frame.pipelines.get(key)) {
            sets.insert(pipeline, self.set(&pipeline.layout, context, reads)?);
        }
        if uses_buffers(pass) {
            encoder.buffers_done();
        }
        // Each image with the one that the pass draws to: an attachment has a single level, so mip levels are made from a
        // separate image.
        let images: Vec<(Arc<Image>, Arc<Image>)> = match pass.desc.to_picture() {
            true => vec![(target.clone(), target.clone())],
            false => self.images.targets(pass),
        };
        let colors: Vec<Arc<Image>> = images.iter().map(|(_, color)| color.clone()).collect();
        let [color, more @ ..] = &*colors else { return Ok(()) };
        colors.iter().for_each(|color| encoder.transition(color, Use::Undefined, Use::Color));
        let attachments = Attachments { more, ..Attachments::of(color) };
        match pass.desc.model {
            Some(_) => {
                let Some(depth) = self.images.depth(pass.name()) else { return Ok(()) };
                encoder.transition(depth, Use::Undefined, Use::Depth);
                encoder.begin_rendering(&Attachments { clear: Some([0.0; 4]), depth: Some(depth), ..attachments });
                encoder.bind_set(&self.layouts, context.frame_set);
                let instances = instances(context.frame, pass);
                let (layouts, frame, placed) = (&self.layouts, context.frame, context.placed);
                let model = ModelDraws { layouts, frame, placed, sets: &sets, instances, pass };
                model.draw_pass(encoder);
            }
            None => {
                // Where a watched stage discards its fragment there is no value.
                let clear = pass.desc.watches.as_ref().map(|_| [0.0; 4]);
                encoder.begin_rendering(&Attachments { clear, ..attachments });
                if let Some(pipeline) = keys.first().and_then(|key| context.frame.pipelines.get(key)) {
                    encoder.bind_set(&self.layouts, context.frame_set);
                    sets.bind(encoder, pipeline);
                    encoder.draw(3);
                }
            }
        }
        encoder.end_rendering();
        for (target, color) in &images {
            if Arc::ptr_eq(target, color) {
                encoder.transition(target, Use::Color, Use::Sampled);
                continue;
            }
            encoder.transition(color, Use::Color, Use::CopyFrom);
            encoder.transition(target, Use::Undefined, Use::CopyTo);
            encoder.fill_levels(color, target);
            encoder.transition(target, Use::CopyFrom, Use::Sampled);
        }
        Ok(())
    }

    fn dispatch(
        &mut self,
        encoder: &mut Encoder,
        context: &PassContext<'_>,
        pass: &Arc<GraphPass>,
        reads: &Reads<'_>,
        target: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let Some(pipeline) = context.frame.pipelines.compute(&pass.desc.stage) else { return Ok(()) };
        let Some(layout) = &pipeline.layout else { return Ok(()) };
        let set = self.set(layout, context, reads)?;
        if uses_buffers(pass) {
            encoder.buffers_done();
        }
        let groups = match pass.desc.dispatch {
            Dispatch::Groups(groups) => groups,
            Dispatch::Size => {
                let [x, y, _] = pass.local_size.map(|size| size.max(1));
                [target.desc().width.div_ceil(x), target.desc().height.div_ceil(y), 1]
            }
        };
        let writes_image = pass.inputs.values().any(|input| *input == Input::Output);
        if writes_image {
            encoder.transition(target, Use::Sampled, Use::Storage);
        }
        let sets: Vec<_> =
            [Some(context.frame_set), set.as_ref(), Some(&self.task_set)].into_iter().flatten().collect();
        encoder.dispatch(pipeline, &sets, groups);
        if writes_image {
            encoder.transition(target, Use::Storage, Use::Sampled);
        }
        Ok(())
    }

    /// The current set of the resources that a stage reads by name. `None` if the layout has none.
    pub(super) fn set(
        &mut self,
        layout: &Arc<PassLayout>,
        context: &PassContext<'_>,
        reads: &Reads<'_>,
    ) -> Result<Option<Arc<DescriptorSet>>, GpuError> {
        if layout.is_empty() {
            return Ok(None);
        }
        let mut sets = std::mem::take(&mut self.sets);
        let set = self.resources(layout, context, reads).and_then(|resources| {
            let ids = resources.iter().map(PassResource::id);
            let key = std::iter::once(Arc::as_ptr(layout) as usize).chain(ids).collect();
            let most = SETS_KEPT * context.frame.state.pipelines.passes.len();
            sets.get(key, most, || layout.set(reads.name, &resources))
        });
        self.sets = sets;
        set.map(Some)
    }
}

/// Whether a pass reads or writes a buffer.
pub(super) fn uses_buffers(pass: &GraphPass) -> bool {
    pass.inputs.values().any(|input| matches!(input, Input::Buffer(..)))
}
