//! The images and storage buffers of declared passes.

mod make;

use std::collections::BTreeMap;
use std::sync::{Arc, Weak};

use super::cache_key::PassCacheKey;
use super::desc::PassDesc;
use crate::frame::PipelineRequest;
use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, ImageDesc, Use, one_shot, vk};
use crate::shader::GraphPass;
use crate::shader::annotation::pass::PassFormat;
use crate::shader::graph::{RenderPhase, TextureKind};

/// An image of a pass, with the one before.
#[derive(Clone)]
struct PassImages {
    desc: PassDesc,
    /// Whether other passes of the frame may draw to the same image.
    is_shared: bool,
    /// One image, or two if the image of the previous frame is kept.
    images: Vec<Arc<Image>>,
    /// The image that the pass draws to, if mip levels are made from it. Passes with the same requirements share it, and the
    /// depth.
    first_level: Option<Arc<Image>>,
    /// The depth of the model, if the pass draws it.
    depth: Option<Arc<Image>>,
    /// Which of two images the last frame drew.
    newest: usize,
    /// Whether this frame has drawn the pass.
    is_drawn: bool,
    /// The number of the drawing that the newest image holds; 0: it was cleared.
    drawing: u64,
    /// The inputs of that drawing, if the next frame may reuse it.
    cache_key: Option<PassCacheKey>,
}

/// The requirements of a frame. If they are unchanged, all images and buffers are kept.
#[derive(Clone, Default, PartialEq)]
struct ImageKey {
    size: (u32, u32),
    picture: vk::Format,
    passes: Vec<Arc<GraphPass>>,
    shown: Option<String>,
    /// Sizes of all declared buffers in bytes, by name.
    buffers: BTreeMap<String, u32>,
}

/// The images and buffers of all declared passes of a frame.
#[derive(Default)]
pub(super) struct Images {
    key: ImageKey,
    /// The request that the key was made of.
    request: Weak<PipelineRequest>,
    /// By the names of the images.
    passes: BTreeMap<String, PassImages>,
    buffers: BTreeMap<String, Arc<Buffer>>,
    /// The images that hold the HDR picture between passes, at most two.
    pictures: Vec<Arc<Image>>,
    /// Two images that hold the LDR picture between passes after the tone map. Empty if there are no such passes.
    pub(super) displays: Vec<Arc<Image>>,
    /// The image of the shown pass, scaled to the size of the picture.
    shown: Option<Arc<Image>>,
    /// Number of drawings of all passes so far.
    drawings: u64,
    /// Images and buffers that were never drawn to.
    fresh: (Vec<Arc<Image>>, Vec<Arc<Buffer>>),
    /// Kept images of another size, and the new ones that get their content.
    resized: Vec<(Arc<Image>, Arc<Image>)>,
}

/// An image of this kind that reads as 0.
pub(super) fn blank(gpu: &Arc<Gpu>, kind: TextureKind) -> Result<Arc<Image>, GpuError> {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let format = vk::Format::R16G16B16A16_SFLOAT;
    let flat = ImageDesc::new(1, 1, format, usage);
    let desc = match kind {
        TextureKind::Flat => flat,
        TextureKind::Cube => ImageDesc::cube(1, 1, format, usage),
        TextureKind::Volume => flat.volume(1),
        TextureKind::Array => flat.array(1),
    };
    let image = Image::new(gpu, &format!("blank {}", kind.glsl()), desc)?;
    one_shot(gpu, |encoder| {
        encoder.transition(&image, Use::Undefined, Use::CopyTo);
        encoder.clear_image(&image);
        encoder.transition(&image, Use::CopyTo, Use::Sampled);
        Ok(())
    })?;
    Ok(image)
}

impl Images {
    /// Makes the next frame clear what depends on earlier frames to 0.
    pub(super) fn restart(&mut self) {
        self.clear(|pass| pass.cache_key.is_none());
    }

    /// Makes the next frame clear everything to 0: the images may be undefined.
    pub(super) fn forget(&mut self) {
        self.clear(|_| true);
    }

    fn clear(&mut self, which: impl Fn(&PassImages) -> bool) {
        let passes = self.passes.values_mut().filter(|pass| which(pass));
        let images = passes.flat_map(|pass| {
            (pass.drawing, pass.cache_key) = (0, None);
            pass.images.clone()
        });
        self.fresh = (images.collect(), self.buffers.values().cloned().collect());
        self.resized.clear();
    }

    /// Begins a frame: clears images and buffers that were never drawn to.
    pub(super) fn begin_frame(&mut self, encoder: &mut Encoder) {
        let (images, buffers) = std::mem::take(&mut self.fresh);
        for image in &images {
            encoder.transition(image, Use::Undefined, Use::CopyTo);
            encoder.clear_image(image);
            encoder.transition(image, Use::CopyTo, Use::Sampled);
        }
        for (from, to) in std::mem::take(&mut self.resized) {
            encoder.transition(&from, Use::Sampled, Use::CopyFrom);
            encoder.transition(&to, Use::Sampled, Use::CopyTo);
            encoder.copy_image_to(&from, &to, (0, 0));
            encoder.transition(&from, Use::CopyFrom, Use::Sampled);
            encoder.transition(&to, Use::CopyTo, Use::Sampled);
        }
        buffers.iter().for_each(|buffer| encoder.clear_buffer(buffer));
        if !buffers.is_empty() {
            encoder.copies_done();
        }
        self.passes.values_mut().for_each(|pass| pass.is_drawn = false);
    }

    /// The image that the pass draws to in this frame.
    pub(super) fn target(&self, name: &str) -> Option<&Arc<Image>> {
        let pass = self.passes.get(name)?;
        pass.images.get((pass.newest + 1) % pass.images.len())
    }

    /// The depth target of a pass that draws the model.
    pub(super) fn depth(&self, name: &str) -> Option<&Arc<Image>> {
        self.passes.get(name)?.depth.as_ref()
    }

    /// The images of a pass in this frame, by location, each with the image that the pass draws to: the same, or one of a single
    /// level, from which levels are made.
    pub(super) fn targets(&self, pass: &GraphPass) -> Vec<(Arc<Image>, Arc<Image>)> {
        let of = |(name, _): (&str, PassFormat)| {
            let target = self.target(name)?.clone();
            let first_level = self.passes.get(name)?.first_level.clone();
            Some((target.clone(), first_level.unwrap_or(target)))
        };
        pass.desc.images().filter_map(of).collect()
    }

    /// Records that the pass has drawn its image, and from what, if a later frame may reuse it.
    pub(super) fn finished(&mut self, name: &str, cache_key: Option<PassCacheKey>) {
        self.drawings += 1;
        if let Some(pass) = self.passes.get_mut(name) {
            pass.newest = (pass.newest + 1) % pass.images.len();
            pass.is_drawn = true;
            (pass.drawing, pass.cache_key) = (self.drawings, cache_key);
        }
    }

    /// Whether the image of the pass holds what these inputs would produce.
    pub(super) fn holds(&self, name: &str, cache_key: &PassCacheKey) -> bool {
        self.passes.get(name).and_then(|pass| pass.cache_key.as_ref()).is_some_and(|of| of == cache_key)
    }

    /// Whether another pass of the frame may draw to the image of this one.
    pub(super) fn is_shared(&self, name: &str) -> bool {
        self.passes.get(name).is_some_and(|pass| pass.is_shared)
    }

    /// A unique number of the drawing that the image of a pass holds. `None`: it has no image.
    pub(super) fn drawn_at(&self, name: &str) -> Option<u64> {
        self.active(name).map(|pass| pass.drawing)
    }

    /// The images of a pass of this frame. Images kept for a pass that is off are not read.
    fn active(&self, name: &str) -> Option<&PassImages> {
        let is_active = self.key.passes.iter().any(|pass| pass.desc.draws(name));
        self.passes.get(name).filter(|_| is_active)
    }

    /// The newest image of a pass.
    pub(super) fn current(&self, name: &str) -> Option<&Arc<Image>> {
        let pass = self.active(name)?;
        pass.images.get(pass.newest)
    }

    /// The image of a pass one frame ago.
    pub(super) fn before(&self, name: &str) -> Option<&Arc<Image>> {
        let pass = self.active(name)?;
        let frames = if pass.is_drawn { pass.images.len() - 1 } else { 0 };
        pass.images.get((pass.newest + frames) % pass.images.len())
    }

    /// A storage buffer.
    pub(super) fn buffer(&self, name: &str) -> Option<&Arc<Buffer>> {
        self.buffers.get(name)
    }

    /// The image in which a pass outputs the new picture: never the one that it reads.
    pub(super) fn other_picture(&self, phase: RenderPhase, read: &Arc<Image>) -> Option<&Arc<Image>> {
        let images = if phase == RenderPhase::Display { &self.displays } else { &self.pictures };
        images.iter().find(|image| !Arc::ptr_eq(image, read))
    }

    /// The image of the shown pass, scaled to the size of the picture.
    pub(super) fn shown(&self) -> Option<&Arc<Image>> {
        self.shown.as_ref()
    }
}
