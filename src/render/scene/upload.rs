//! A model's geometry and textures on their way to the device: one staging buffer, one submission.

use std::sync::Arc;

use rayon::prelude::*;

use crate::gpu::{Buffer, Gpu, Image, ImageDesc, Memory, Use, one_shot, vk};
use crate::interface::Vertex;
use crate::render::scene::UploadError;
use crate::render::scene::materials::Textures;
use crate::render::scene::mips;
use crate::render::scene::texture_source::{Source, sources};
use crate::scene::Model;

/// All primitives in two buffers.
pub(super) struct Geometry {
    pub(super) vertices: Arc<Buffer>,
    pub(super) indices: Arc<Buffer>,
    pub(super) ranges: Vec<Range>,
}

/// Where a primitive lies in the shared buffers.
pub(super) struct Range {
    pub(super) first_vertex: u64,
    pub(super) first_index: u32,
}

/// Collects copies into one staging buffer and runs them as one submission.
pub(super) struct Staging<'a> {
    gpu: &'a Arc<Gpu>,
    buffer: Arc<Buffer>,
    used: u64,
    buffers: Vec<(u64, Arc<Buffer>)>,
    images: Vec<(u64, Arc<Image>)>,
}

const TEXTURE_USAGE: vk::ImageUsageFlags =
    vk::ImageUsageFlags::from_raw(vk::ImageUsageFlags::SAMPLED.as_raw() | vk::ImageUsageFlags::TRANSFER_DST.as_raw());

impl<'a> Staging<'a> {
    pub(super) fn new(gpu: &'a Arc<Gpu>, model: &Model) -> Result<Self, UploadError> {
        let geometry: usize = model
            .primitives
            .iter()
            .map(|p| size_of_val(p.vertices.as_slice()) + size_of_val(p.indices.as_slice()) + 32)
            .sum();
        let bytes = |source: &Source| {
            let (width, height) = size(source, model);
            mips::bytes(width, height) + 16
        };
        let images: usize = sources(model).iter().map(bytes).sum();
        let size = (geometry + images + 64) as u64;
        let buffer = Buffer::new(gpu, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload)?;
        Ok(Self { gpu, buffer, used: 0, buffers: Vec::new(), images: Vec::new() })
    }

    /// Sets `length` bytes apart; returns where.
    fn reserve(&mut self, length: usize) -> u64 {
        let offset = self.used.next_multiple_of(16);
        self.used = offset + length as u64;
        offset
    }

    fn push(&mut self, bytes: &[u8]) -> u64 {
        let offset = self.reserve(bytes.len());
        self.buffer.write(offset, bytes);
        offset
    }

    pub(super) fn geometry(&mut self, model: &Model) -> Result<Geometry, UploadError> {
        let (mut ranges, mut first_vertex, mut first_index) = (Vec::new(), 0u64, 0u32);
        for primitive in &model.primitives {
            ranges.push(Range { first_vertex, first_index });
            first_vertex += primitive.vertices.len() as u64;
            first_index += primitive.indices.len() as u32;
        }
        let flat: Vec<Vertex> = model.primitives.iter().flat_map(|p| p.vertices.iter().copied()).collect();
        let indices: Vec<u32> = model.primitives.iter().flat_map(|p| p.indices.iter().copied()).collect();
        use vk::BufferUsageFlags as Usage;
        let vertex_usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS | Usage::TRANSFER_DST;
        let vertices = self.buffer("vertices", bytemuck::cast_slice(&flat), vertex_usage)?;
        let index_usage = Usage::INDEX_BUFFER | Usage::TRANSFER_DST;
        let indices = self.buffer("indices", bytemuck::cast_slice(&indices), index_usage)?;
        Ok(Geometry { vertices, indices, ranges })
    }

    fn buffer(&mut self, name: &str, bytes: &[u8], usage: vk::BufferUsageFlags) -> Result<Arc<Buffer>, UploadError> {
        let buffer = Buffer::new(self.gpu, name, bytes.len() as u64, usage, Memory::Device)?;
        if !bytes.is_empty() {
            let offset = self.push(bytes);
            self.buffers.push((offset, buffer.clone()));
        }
        Ok(buffer)
    }

    pub(super) fn textures(&mut self, model: &Model) -> Result<Textures, UploadError> {
        let mut textures = Textures::new();
        let most = self.gpu.max_image_size();
        let mut places = Vec::new();
        for source in sources(model) {
            let (width, height) = size(&source, model);
            let name = source.image(model).map_or("default", |image| &image.name);
            if width > most || height > most {
                return Err(UploadError::ImageTooLarge { name: name.to_owned(), width, height, most });
            }
            let offset = self.reserve(mips::bytes(width, height));
            textures.insert(source, self.image(name, (width, height), source.is_srgb(), offset)?);
            places.push((source, (width, height), offset));
        }
        // The first touch of staging memory costs as much as the copy, so that is shared out too.
        let staging = &self.buffer;
        places.par_iter().for_each(|(source, (width, height), offset)| {
            let pixels = source.pixels(model);
            staging.write(*offset, &pixels);
            let below = mips::below(&pixels, *width, *height, source.is_srgb());
            staging.write(offset + pixels.len() as u64, &below);
        });
        Ok(textures)
    }

    /// Makes an image whose levels will lie at `offset`, one after the other.
    fn image(
        &mut self,
        name: &str,
        (width, height): (u32, u32),
        srgb: bool,
        offset: u64,
    ) -> Result<Arc<Image>, UploadError> {
        let format = if srgb { vk::Format::R8G8B8A8_SRGB } else { vk::Format::R8G8B8A8_UNORM };
        let mips = mips::count(width, height);
        let image =
            Image::new(self.gpu, name, ImageDesc { mips, ..ImageDesc::new(width, height, format, TEXTURE_USAGE) })?;
        self.images.push((offset, image.clone()));
        Ok(image)
    }

    /// Copies everything.
    pub(super) fn submit(self) -> Result<(), UploadError> {
        one_shot(self.gpu, |encoder| {
            for (offset, buffer) in &self.buffers {
                encoder.copy_buffer(&self.buffer, *offset, buffer, buffer.size());
            }
            for (offset, image) in &self.images {
                encoder.transition(image, Use::Undefined, Use::CopyTo);
                encoder.copy_to_image(&self.buffer, *offset, image);
                encoder.transition(image, Use::CopyTo, Use::Sampled);
            }
            encoder.copies_done();
            Ok(())
        })?;
        Ok(())
    }
}

/// Width and height.
fn size(source: &Source, model: &Model) -> (u32, u32) {
    source.image(model).map_or((1, 1), |image| (image.width, image.height))
}
