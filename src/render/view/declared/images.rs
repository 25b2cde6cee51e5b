//! The images and storage buffers of declared passes.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::reuse::DrawnFrom;
use crate::frame::pass_format;
use crate::gpu::{Buffer, Encoder, Gpu, GpuError, Image, ImageDesc, Memory, Swapchain, Use, one_shot, vk};
use crate::render::bound_frame::BoundFrame;
use crate::scene::mips;
use crate::shader::GraphPass;
use crate::shader::annotation::pass::{PassFormat, Target};
use crate::shader::graph::{Graph, Input, Part, TextureKind};

/// The properties of a pass that determine its images.
#[derive(Clone, Copy, PartialEq)]
struct PassDesc {
    size: (u32, u32),
    format: vk::Format,
    mips: u32,
    is_written: bool,
    keeps: bool,
    has_depth: bool,
}

/// An image of a pass, with the one before.
#[derive(Clone)]
struct PassImages {
    desc: PassDesc,
    /// One image, or two if the image of the previous frame is kept.
    images: Vec<Arc<Image>>,
    /// The image that the pass draws to, if mip levels are made from it.
    first_level: Option<Arc<Image>>,
    /// The depth of the model, if the pass draws it.
    depth: Option<Arc<Image>>,
    /// Which of two images the last frame drew.
    newest: usize,
    /// Whether this frame has drawn the pass.
    is_drawn: bool,
    /// The number of the drawing that the newest image holds; 0: it was cleared.
    drawing: u64,
    /// The sources of that drawing, if the next frame may keep it.
    from: Option<DrawnFrom>,
}

/// The needs of a frame. If they are unchanged, all images and buffers are kept.
#[derive(Clone, Default, PartialEq)]
struct Key {
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
    key: Key,
    /// By the names of the images.
    passes: BTreeMap<String, PassImages>,
    buffers: BTreeMap<String, Arc<Buffer>>,
    /// The images for the HDR picture between passes, at most two.
    pictures: Vec<Arc<Image>>,
    /// Two images for the displayed picture between passes after the tone map. Empty if there are no such passes.
    pub(super) displays: Vec<Arc<Image>>,
    /// The image of the shown pass, scaled to the size of the picture.
    shown: Option<Arc<Image>>,
    /// Number of drawings of all passes so far.
    drawings: u64,
    /// Images and buffers that were never drawn to.
    fresh: (Vec<Arc<Image>>, Vec<Arc<Buffer>>),
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

/// Bytes of the images of a pass, with their levels, the frame before and the depth.
fn bytes_of(pass: &GraphPass, picture: (u32, u32)) -> u64 {
    let (width, height) = pass.note.size.pixels(picture);
    let texels = u64::from(width) * u64::from(height);
    // All levels together have a third more texels. They are made of an image of their own.
    let (frames, levels) = (if pass.note.keep { 2 } else { 1 }, if pass.note.mips { 4 } else { 3 });
    let first_level = if pass.note.mips { 3 } else { 0 };
    let depth = if pass.note.model.is_some() { 4 } else { 0 };
    let of = |(_, format): (&str, PassFormat)| texels * u64::from(format.bytes()) * (frames * levels + first_level) / 3;
    pass.note.images().map(of).sum::<u64>() + texels * depth
}

/// Fails if the images and buffers of passes take more memory than the user allows.
fn check_memory(frame: &BoundFrame) -> Result<(), GpuError> {
    let (passes, limit) = (&frame.state.pipelines.passes, frame.state.pass_memory);
    let mut buffers = BTreeMap::new();
    let mut total = 0;
    for pass in passes {
        let images = if pass.note.to == Target::Image { bytes_of(pass, frame.state.size) } else { 0 };
        let new = pass
            .inputs
            .values()
            .filter_map(buffer_of)
            .filter(|(name, bytes)| buffers.insert((*name).to_owned(), *bytes).is_none());
        total += images + new.map(|(_, bytes)| u64::from(bytes)).sum::<u64>();
        if total > limit {
            let (name, place) = (pass.name(), &pass.note.place);
            return Err(GpuError::OutOfMemory(format!(
                "creating the images and buffers of the pass `{name}` ({}:{}): passes take {} MiB so far, and `--memory` allows {}",
                place.file,
                place.line,
                total.div_ceil(1 << 20),
                limit >> 20
            )));
        }
    }
    Ok(())
}

impl Images {
    /// The images for `frame`. Those of `self` that fit are reused. `None` if the needs are the same as before.
    pub(super) fn next(&self, gpu: &Arc<Gpu>, frame: &BoundFrame) -> Result<Option<Self>, GpuError> {
        let request = &frame.state.pipelines;
        let key = Key {
            size: frame.state.size,
            picture: request.picture_format(),
            passes: request.passes.clone(),
            shown: request.shown_pass.clone(),
            buffers: buffers(&frame.state.shaders.graph),
        };
        if key == self.key {
            return Ok(None);
        }
        check_memory(frame)?;
        let mut next = Self { key, fresh: self.fresh.clone(), drawings: self.drawings, ..Self::default() };
        for pass in request.passes.iter().filter(|pass| pass.note.to == Target::Image) {
            for (name, format) in pass.note.images() {
                let images = next.images_of(gpu, pass, (name, format), self.passes.get(name))?;
                next.passes.insert(name.to_owned(), images);
            }
        }
        let inputs = request.passes.iter().map(|pass| &pass.inputs);
        for (name, bytes) in inputs.flat_map(|inputs| inputs.values()).filter_map(buffer_of) {
            let known = next.buffers.get(name).or(self.buffers.get(name));
            let known = known.filter(|buffer| buffer.size() == u64::from(bytes).max(1));
            let buffer = match known {
                Some(known) => known.clone(),
                None => next.new_buffer(gpu, name, bytes)?,
            };
            next.buffers.insert(name.to_owned(), buffer);
        }
        // Kept images and buffers survive while the user looks at another mode, or switches their pass off.
        let graph = &frame.state.shaders.graph;
        for (name, images) in self.passes.iter().filter(|(name, _)| graph.maker(name).is_some_and(|p| p.note.keep)) {
            next.passes.entry(name.clone()).or_insert_with(|| images.clone());
        }
        for (name, buffer) in &self.buffers {
            if next.key.buffers.get(name).is_some_and(|bytes| buffer.size() == u64::from(*bytes)) {
                next.buffers.entry(name.clone()).or_insert_with(|| buffer.clone());
            }
        }
        let makers = request.passes.iter().filter(|pass| pass.note.to_picture() && pass.part == Part::Light).count();
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let (width, height) = frame.state.size;
        let image = |name: &str, format| Image::new(gpu, name, ImageDesc::new(width, height, format, usage));
        let fits = |image: &&Arc<Image>, format| {
            (image.desc().width, image.desc().height, image.desc().format) == (width, height, format)
        };
        let take = |name: &str, format, count: usize, known: &[Arc<Image>]| -> Result<Vec<Arc<Image>>, GpuError> {
            let known = known.iter().filter(|image| fits(image, format)).cloned();
            let mut images: Vec<_> = known.take(count).collect();
            while images.len() < count {
                images.push(image(name, format)?);
            }
            Ok(images)
        };
        next.pictures = take("picture of a pass", next.key.picture, makers.min(2), &self.pictures)?;
        // The tone map draws to the first.
        let displays = if request.passes.iter().any(|pass| pass.part == Part::Display) { 2 } else { 0 };
        next.displays = take("display of a pass", Swapchain::FORMAT, displays, &self.displays)?;
        if request.shown_pass.is_some() {
            let known: Vec<_> = self.shown.iter().cloned().collect();
            next.shown = take("shown pass", next.key.picture, 1, &known)?.pop();
        }
        Ok(Some(next))
    }

    fn images_of(
        &mut self,
        gpu: &Arc<Gpu>,
        pass: &GraphPass,
        (name, format): (&str, PassFormat),
        known: Option<&PassImages>,
    ) -> Result<PassImages, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let size = pass.note.size.pixels(self.key.size);
        let desc = PassDesc {
            size,
            format: pass_format(format),
            mips: if pass.note.mips { mips::count(size.0, size.1) } else { 1 },
            is_written: pass.inputs.values().any(|input| *input == Input::Output),
            keeps: pass.note.keep,
            // All images of a pass share the depth of the first.
            has_depth: pass.note.model.is_some() && name == pass.name(),
        };
        if let Some(known) = known.filter(|known| known.desc == desc) {
            return Ok(known.clone());
        }
        let most = gpu.max_image_size();
        if size.0 > most || size.1 > most {
            let message = format!(
                "the image of the pass {} has {} x {} pixels; this device draws at most {most} a side",
                pass.name(),
                size.0,
                size.1
            );
            return Err(GpuError::Texture(message));
        }
        let target = if desc.is_written { Usage::STORAGE } else { Usage::COLOR_ATTACHMENT };
        let usage = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST | target;
        let base = ImageDesc::new(size.0, size.1, desc.format, usage);
        let image = |mips| Image::new(gpu, name, ImageDesc { mips, ..base });
        let images = (0..if desc.keeps { 2 } else { 1 }).map(|_| image(desc.mips)).collect::<Result<Vec<_>, _>>()?;
        let first_level = if desc.mips > 1 { Some(image(1)?) } else { None };
        self.fresh.0.extend(images.iter().cloned());
        let depth = match desc.has_depth {
            true => {
                let (format, usage) = (vk::Format::D32_SFLOAT, Usage::DEPTH_STENCIL_ATTACHMENT);
                Some(Image::new(gpu, "depth of a pass", ImageDesc::new(size.0, size.1, format, usage))?)
            }
            false => None,
        };
        Ok(PassImages { desc, images, first_level, depth, newest: 0, is_drawn: false, drawing: 0, from: None })
    }

    fn new_buffer(&mut self, gpu: &Arc<Gpu>, name: &str, bytes: u32) -> Result<Arc<Buffer>, GpuError> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(gpu, name, u64::from(bytes), usage, Memory::Device)?;
        self.fresh.1.push(buffer.clone());
        Ok(buffer)
    }

    /// Makes the next frame clear what depends on earlier frames to 0.
    pub(super) fn restart(&mut self) {
        self.clear(|pass| pass.from.is_none());
    }

    /// Makes the next frame clear everything to 0: the images may be undefined.
    pub(super) fn forget(&mut self) {
        self.clear(|_| true);
    }

    fn clear(&mut self, which: impl Fn(&PassImages) -> bool) {
        let passes = self.passes.values_mut().filter(|pass| which(pass));
        let images = passes.flat_map(|pass| {
            (pass.drawing, pass.from) = (0, None);
            pass.images.clone()
        });
        self.fresh = (images.collect(), self.buffers.values().cloned().collect());
    }

    /// Begins a frame: clears images and buffers that were never drawn to.
    pub(super) fn begin_frame(&mut self, encoder: &mut Encoder) {
        let (images, buffers) = std::mem::take(&mut self.fresh);
        for image in &images {
            encoder.transition(image, Use::Undefined, Use::CopyTo);
            encoder.clear_image(image);
            encoder.transition(image, Use::CopyTo, Use::Sampled);
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
        pass.note.images().filter_map(of).collect()
    }

    /// Records that the pass has drawn its image, and what it was drawn from if a later frame may keep it.
    pub(super) fn finished(&mut self, name: &str, from: Option<DrawnFrom>) {
        self.drawings += 1;
        if let Some(pass) = self.passes.get_mut(name) {
            pass.newest = (pass.newest + 1) % pass.images.len();
            pass.is_drawn = true;
            (pass.drawing, pass.from) = (self.drawings, from);
        }
    }

    /// Whether the image of the pass holds what would be drawn from these sources.
    pub(super) fn holds(&self, name: &str, from: &DrawnFrom) -> bool {
        self.passes.get(name).and_then(|pass| pass.from.as_ref()).is_some_and(|of| of == from)
    }

    /// The number of the drawing that the image of a pass holds, which no other drawing of a pass has. `None`: it has no image.
    pub(super) fn drawn_at(&self, name: &str) -> Option<u64> {
        self.active(name).map(|pass| pass.drawing)
    }

    /// The images of a pass of this frame. Those that are kept of a pass that is off are not read.
    fn active(&self, name: &str) -> Option<&PassImages> {
        let is_active = self.key.passes.iter().any(|pass| pass.note.draws(name));
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

    /// The image that a pass gives a new picture in, which is not the one that it reads.
    pub(super) fn other_picture(&self, part: Part, read: &Arc<Image>) -> Option<&Arc<Image>> {
        let images = if part == Part::Display { &self.displays } else { &self.pictures };
        images.iter().find(|image| !Arc::ptr_eq(image, read))
    }

    /// The image of the shown pass, scaled to the size of the picture.
    pub(super) fn shown(&self) -> Option<&Arc<Image>> {
        self.shown.as_ref()
    }
}

/// The sizes in bytes of all buffers that a graph declares, by name.
fn buffers(graph: &Graph) -> BTreeMap<String, u32> {
    let inputs = graph.passes.iter().map(|pass| &pass.inputs);
    inputs
        .flat_map(|inputs| inputs.values())
        .filter_map(buffer_of)
        .map(|(name, bytes)| (name.to_owned(), bytes))
        .collect()
}

fn buffer_of(input: &Input) -> Option<(&str, u32)> {
    match input {
        Input::Buffer(name, bytes) => Some((name, *bytes)),
        _ => None,
    }
}
