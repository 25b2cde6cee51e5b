//! Makes the images and buffers that a frame needs, of those of the frame before where they fit.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ImageKey, Images, PassImages};
use crate::gpu::{Buffer, Gpu, GpuError, Image, ImageDesc, Memory, Swapchain, vk};
use crate::render::bound_frame::BoundFrame;
use crate::render::view::declared::desc::{PassDesc, ScratchDesc};
use crate::render::view::declared::lifetimes;
use crate::render::view::declared::memory::{beyond_memory, buffer_of};
use crate::shader::GraphPass;
use crate::shader::annotation::pass::{PassFormat, PassTarget};
use crate::shader::graph::{Graph, RenderPhase};

impl Images {
    /// The images for `frame`. Those of `self` that fit are reused. `None` if the requirements are unchanged.
    pub(in crate::render::view::declared) fn next(
        &mut self,
        gpu: &Arc<Gpu>,
        frame: &BoundFrame,
    ) -> Result<Option<Self>, GpuError> {
        let request = &frame.state.pipelines;
        if self.key.size == frame.state.size && std::ptr::eq(self.request.as_ptr(), Arc::as_ptr(request)) {
            return Ok(None);
        }
        let key = ImageKey {
            size: frame.state.size,
            picture: request.picture_format(),
            passes: request.passes.clone(),
            shown: request.shown_pass.clone(),
            buffers: buffers(&frame.state.shaders.graph),
        };
        if key == self.key {
            self.request = Arc::downgrade(request);
            return Ok(None);
        }
        if let Some(error) = beyond_memory(request, frame.state.size, frame.state.pass_memory) {
            return Err(GpuError::PassMemory(error.one_line()));
        }
        let request_of_key = Arc::downgrade(request);
        let (fresh, drawings) = (self.fresh.clone(), self.drawings);
        let mut next = Self { key, request: request_of_key, fresh, drawings, ..Self::default() };
        let describe = |pass: &GraphPass, image: (&str, PassFormat)| PassDesc::new(pass, image, frame.state.size);
        let slots = lifetimes::shared_images(&request.passes, request.shown_pass.as_deref(), describe);
        let mut shared = BTreeMap::new();
        for pass in request.passes.iter().filter(|pass| pass.desc.to == PassTarget::Image) {
            for image in pass.desc.images() {
                let slot = slots.get(image.0).map(|slot| shared.entry(*slot).or_default());
                let images = next.images_of(gpu, (image.0, describe(pass, image)), self, slot)?;
                next.passes.insert(image.0.to_owned(), images);
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
        for (name, images) in self.passes.iter().filter(|(name, _)| graph.maker(name).is_some_and(|p| p.desc.keep)) {
            next.passes.entry(name.clone()).or_insert_with(|| images.clone());
        }
        for (name, buffer) in &self.buffers {
            if next.key.buffers.get(name).is_some_and(|bytes| buffer.size() == u64::from(*bytes)) {
                next.buffers.entry(name.clone()).or_insert_with(|| buffer.clone());
            }
        }
        let makers =
            request.passes.iter().filter(|pass| pass.desc.to_picture() && pass.phase == RenderPhase::Light).count();
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
        let displays = if request.passes.iter().any(|pass| pass.phase == RenderPhase::Display) { 2 } else { 0 };
        next.displays = take("display of a pass", Swapchain::FORMAT, displays, &self.displays)?;
        if request.shown_pass.is_some() {
            let known: Vec<_> = self.shown.iter().cloned().collect();
            // Its values are read, so full floats stay what they are.
            let is_full = request.shown().is_some_and(|pass| pass.desc.format == PassFormat::Rgba32f);
            let format = if is_full { vk::Format::R32G32B32A32_SFLOAT } else { next.key.picture };
            next.shown = take("shown pass", format, 1, &known)?.pop();
        }
        Ok(Some(next))
    }

    /// The images with this name and these properties: those of `last` if they fit. `shared`: the image that other passes have
    /// drawn to, or `None` if this is the first.
    fn images_of(
        &mut self,
        gpu: &Arc<Gpu>,
        (name, desc): (&str, PassDesc),
        last: &Self,
        shared: Option<&mut Option<Arc<Image>>>,
    ) -> Result<PassImages, GpuError> {
        let is_shared = shared.is_some();
        let fits = |known: &&PassImages| known.desc == desc && known.is_shared == is_shared;
        let known = last.passes.get(name).filter(fits);
        if !is_shared && let Some(known) = known {
            return Ok(known.clone());
        }
        let ((width, height), most) = (desc.size, gpu.max_image_size());
        if width > most || height > most {
            let message = format!(
                "the image {name} of a pass has {width} x {height} pixels; this device draws at most {most} a side"
            );
            return Err(GpuError::Texture(message));
        }
        let new = ImageDesc { mips: desc.mips, ..ImageDesc::new(width, height, desc.format, desc.usage()) };
        let first_level = desc.first_level().map(|desc| self.scratch(gpu, desc, last)).transpose()?;
        let depth = desc.depth().map(|desc| self.scratch(gpu, desc, last)).transpose()?;
        let images = match shared {
            Some(Some(image)) => vec![image.clone()],
            Some(first) => {
                let is_free = |image: &&Arc<Image>| !self.uses(image);
                let mut known =
                    known.into_iter().chain(last.passes.values().filter(fits)).flat_map(|pass| &pass.images);
                let known = known.find(is_free).cloned();
                let image = match known {
                    Some(image) => image,
                    None => self.cleared(gpu, name, new)?,
                };
                vec![first.insert(image).clone()]
            }
            None => {
                (0..if desc.keeps { 2 } else { 1 }).map(|_| self.cleared(gpu, name, new)).collect::<Result<_, _>>()?
            }
        };
        let (mut newest, mut drawing) = (0, 0);
        let is_other_size = |known: &&PassImages| desc.keeps && known.desc.is_resized(&desc);
        if let Some(known) = last.passes.get(name).filter(is_other_size) {
            newest = known.newest;
            self.drawings += 1;
            drawing = self.drawings;
            for (from, to) in known.images.iter().zip(&images) {
                self.resized.extend(last.drawn(from).map(|from| (from, to.clone())));
            }
        }
        Ok(PassImages {
            desc,
            is_shared,
            images,
            first_level,
            depth,
            newest,
            is_drawn: false,
            drawing,
            cache_key: None,
        })
    }

    /// The image with the content that an image has or will have. `None` if it was never drawn to.
    fn drawn(&self, image: &Arc<Image>) -> Option<Arc<Image>> {
        let source = self.resized.iter().find(|(_, to)| Arc::ptr_eq(to, image)).map(|(from, _)| from.clone());
        let is_fresh = self.fresh.0.iter().any(|fresh| Arc::ptr_eq(fresh, image));
        source.or_else(|| (!is_fresh).then(|| image.clone()))
    }

    /// A new image, which the next frame clears to 0.
    fn cleared(&mut self, gpu: &Arc<Gpu>, name: &str, desc: ImageDesc) -> Result<Arc<Image>, GpuError> {
        let image = Image::new(gpu, name, desc)?;
        self.fresh.0.push(image.clone());
        Ok(image)
    }

    fn uses(&self, image: &Arc<Image>) -> bool {
        self.passes.values().flat_map(|pass| &pass.images).any(|used| Arc::ptr_eq(used, image))
    }

    /// An image that passes need only while they draw: all passes with the same requirements share it.
    fn scratch(&self, gpu: &Arc<Gpu>, desc: ScratchDesc, last: &Self) -> Result<Arc<Image>, GpuError> {
        let known = self.passes.values().chain(last.passes.values());
        let mut known = known.flat_map(|pass| {
            let descs = [pass.desc.first_level(), pass.desc.depth()];
            descs.into_iter().zip([&pass.first_level, &pass.depth])
        });
        match known.find_map(|(of, image)| image.as_ref().filter(|_| of == Some(desc))) {
            Some(known) => Ok(known.clone()),
            None => {
                Image::new(gpu, "pass in progress", ImageDesc::new(desc.size.0, desc.size.1, desc.format, desc.usage()))
            }
        }
    }

    fn new_buffer(&mut self, gpu: &Arc<Gpu>, name: &str, bytes: u32) -> Result<Arc<Buffer>, GpuError> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(gpu, name, u64::from(bytes), usage, Memory::Device)?;
        self.fresh.1.push(buffer.clone());
        Ok(buffer)
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
