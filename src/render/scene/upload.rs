//! Uploads a model's geometry and textures through one staging buffer of bounded size. Frees the CPU's pixels as it goes,
//! so that never two copies of all of them exist.

use std::sync::Arc;

use rayon::prelude::*;

use crate::gpu::{Buffer, Gpu, Image, ImageDesc, Memory, Use, one_shot, vk};
use crate::interface::{Displacement, Influence, Vertex};
use crate::render::scene::UploadError;
use crate::render::scene::materials::Textures;
use crate::render::scene::texel_formats::{format_of, forms_of};
use crate::scene::{Model, TextureSource, texture_sources};

/// A model's data on the device.
pub(super) struct Uploaded {
    /// The vertices of all primitives, one after the other.
    pub(super) vertices: Arc<Buffer>,
    /// The indices of all primitives, one after the other, each relative to its primitive's first vertex.
    pub(super) indices: Arc<Buffer>,
    /// The location of each primitive in these buffers.
    pub(super) ranges: Vec<Range>,
    /// The textures of the materials, and the defaults for missing ones.
    pub(super) textures: Textures,
    /// The data by which joints and morph targets move vertices; `None` if nothing moves.
    pub(super) deformers: Option<Deformers>,
}

/// Influences and displacements of all primitives, one after the other.
pub(super) struct Deformers {
    pub(super) influences: Arc<Buffer>,
    pub(super) displacements: Arc<Buffer>,
}

/// The location of a primitive in the shared buffers.
pub(super) struct Range {
    pub(super) first_vertex: u64,
    pub(super) first_index: u32,
}

/// Size of the staging buffer in bytes. It is smaller if the model needs less, and larger if one image needs more.
const STAGING_BYTES: u64 = 32 << 20;
/// Alignment of image copies in the staging buffer, in bytes. Vulkan requires the size of a texel or block; 16 suits all devices.
const ALIGNMENT: u64 = 16;

/// Path tracing copies textures from the device, since the pixels have left the CPU.
const TEXTURE_USAGE: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::SAMPLED.as_raw()
        | vk::ImageUsageFlags::TRANSFER_SRC.as_raw()
        | vk::ImageUsageFlags::TRANSFER_DST.as_raw(),
);

/// Uploads a model and waits until that is done. Each image takes the best form that the device samples. Then its texels are empty. Picking and framing read the rest of
/// the model, so the rest stays.
///
/// # Errors
/// An image that exceeds the device's limit, or no memory left. Some pixels may be freed by then.
pub(super) fn upload(gpu: &Arc<Gpu>, model: &mut Model) -> Result<Uploaded, UploadError> {
    let sources = settled_sources(gpu, model)?;
    let geometry =
        model.primitives.iter().map(|p| size_of_val(p.vertices.as_slice()).max(size_of_val(&*p.indices)) as u64);
    let staging = Staging::new(gpu, model, &sources, geometry.sum())?;
    let textures = staging.textures(model, &sources)?;
    let (mut ranges, mut first_vertex, mut first_index) = (Vec::new(), 0u64, 0u32);
    for primitive in model.primitives.iter() {
        ranges.push(Range { first_vertex, first_index });
        first_vertex += primitive.vertices.len() as u64;
        first_index += primitive.indices.len() as u32;
    }
    use vk::BufferUsageFlags as Usage;
    let vertex_usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
    let vertices: Vec<&[Vertex]> = model.primitives.iter().map(|p| p.vertices.as_slice()).collect();
    let vertices = staging.buffer("vertices", &vertices, vertex_usage)?;
    let indices: Vec<&[u32]> = model.primitives.iter().map(|p| p.indices.as_slice()).collect();
    // Mesh stages read them by address.
    let index_usage = Usage::INDEX_BUFFER | Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
    let indices = staging.buffer("indices", &indices, index_usage)?;
    let deformers = deformers(&staging, model)?;
    Ok(Uploaded { vertices, indices, ranges, textures, deformers })
}

/// Uploads the textures of a model whose geometry is on the device, as [`upload`] does.
///
/// # Errors
/// As [`upload`].
pub(super) fn upload_textures(gpu: &Arc<Gpu>, model: &mut Model) -> Result<Textures, UploadError> {
    let sources = settled_sources(gpu, model)?;
    Staging::new(gpu, model, &sources, 0)?.textures(model, &sources)
}

/// The textures of a model, whose images have the forms in which the device samples them.
fn settled_sources(gpu: &Arc<Gpu>, model: &mut Model) -> Result<Vec<TextureSource>, UploadError> {
    let forms = forms_of(gpu);
    Arc::make_mut(&mut model.images).iter_mut().for_each(|image| image.settle(&forms));
    let sources: Vec<TextureSource> = texture_sources(model).into_iter().collect();
    check_sizes(gpu, model, &sources)?;
    Ok(sources)
}

fn deformers(staging: &Staging<'_>, model: &Model) -> Result<Option<Deformers>, UploadError> {
    let all = || model.primitives.iter().filter_map(|primitive| primitive.deformation.as_deref());
    if all().next().is_none() {
        return Ok(None);
    }
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    let influences: Vec<&[Influence]> = all().map(|deformation| &*deformation.influences).collect();
    let targets: Vec<&[Displacement]> =
        all().flat_map(|deformation| &deformation.targets).map(|target| &**target).collect();
    let influences = staging.buffer("influences of joints", &influences, usage)?;
    let displacements = staging.buffer("displacements of morph targets", &targets, usage)?;
    Ok(Some(Deformers { influences, displacements }))
}

fn check_sizes(gpu: &Gpu, model: &Model, sources: &[TextureSource]) -> Result<(), UploadError> {
    let most = gpu.max_image_size();
    let too_large = sources.iter().filter_map(|source| source.image(model)).find(|i| i.width > most || i.height > most);
    match too_large {
        None => Ok(()),
        Some(image) => {
            let (name, width, height) = (image.name.clone(), image.width, image.height);
            Err(UploadError::ImageTooLarge { name, width, height, most })
        }
    }
}

/// A buffer that the CPU fills and the device copies from, reused as often as needed.
struct Staging<'a> {
    gpu: &'a Arc<Gpu>,
    buffer: Arc<Buffer>,
}

impl<'a> Staging<'a> {
    /// `geometry`: bytes of a buffer that is uploaded too.
    fn new(gpu: &'a Arc<Gpu>, model: &Model, sources: &[TextureSource], geometry: u64) -> Result<Self, UploadError> {
        let images = || sources.iter().map(|source| staged_bytes(source, model));
        let total = images().sum::<u64>().max(geometry);
        let size = total.min(STAGING_BYTES).max(images().max().unwrap_or_default());
        let buffer = Buffer::new(gpu, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload)?;
        Ok(Self { gpu, buffer })
    }

    /// Creates a buffer that holds the slices in order.
    fn buffer<T: bytemuck::Pod>(
        &self,
        name: &str,
        parts: &[&[T]],
        usage: vk::BufferUsageFlags,
    ) -> Result<Arc<Buffer>, UploadError> {
        let size: usize = parts.iter().map(|part| size_of_val(*part)).sum();
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(self.gpu, name, size as u64, usage, Memory::Device)?;
        let (mut copied, mut filled) = (0, 0);
        for part in parts {
            let mut bytes: &[u8] = bytemuck::cast_slice(part);
            while !bytes.is_empty() {
                let fitting = bytes.len().min((self.buffer.size() - filled) as usize);
                let (now, rest) = bytes.split_at(fitting);
                self.buffer.write(filled, now);
                filled += now.len() as u64;
                bytes = rest;
                if filled == self.buffer.size() {
                    self.copy_to_buffer(&buffer, copied, filled)?;
                    copied += std::mem::take(&mut filled);
                }
            }
        }
        if filled > 0 {
            self.copy_to_buffer(&buffer, copied, filled)?;
        }
        Ok(buffer)
    }

    fn copy_to_buffer(&self, to: &Arc<Buffer>, offset: u64, size: u64) -> Result<(), UploadError> {
        one_shot(self.gpu, |encoder| {
            encoder.copy_buffer(&self.buffer, 0, to, offset, size);
            encoder.copies_done();
            Ok(())
        })?;
        Ok(())
    }

    /// Creates all textures, as many at a time as fit into the staging buffer. Frees each image's pixels after the last
    /// texture that reads them.
    fn textures(&self, model: &mut Model, sources: &[TextureSource]) -> Result<Textures, UploadError> {
        let mut readers = vec![0u32; model.images.len()];
        sources.iter().flat_map(|source| source.images()).for_each(|image| readers[image] += 1);
        free_unread(model, &readers);
        let mut textures = Textures::new();
        let mut waiting = sources;
        while !waiting.is_empty() {
            let (batch, later) = waiting.split_at(self.fitting(waiting, model));
            self.batch(batch, model, &mut textures)?;
            batch.iter().flat_map(|source| source.images()).for_each(|image| readers[image] -= 1);
            free_unread(model, &readers);
            waiting = later;
        }
        Ok(textures)
    }

    /// How many of the first sources fit into the staging buffer together. At least 1, since the buffer holds the largest.
    fn fitting(&self, sources: &[TextureSource], model: &Model) -> usize {
        let mut free = self.buffer.size();
        let fits = |source: &&TextureSource| {
            let bytes = staged_bytes(source, model);
            let fits = bytes <= free;
            free = free.saturating_sub(bytes);
            fits
        };
        sources.iter().take_while(fits).count().max(1)
    }

    fn batch(&self, sources: &[TextureSource], model: &Model, textures: &mut Textures) -> Result<(), UploadError> {
        let mut places = Vec::new();
        let mut used = 0;
        for source in sources {
            let image = make_image(self.gpu, source, model)?;
            places.push((*source, image, used));
            used += staged_bytes(source, model);
        }
        self.buffer.fill(0, used as usize, |mut rest| {
            let mut targets = Vec::new();
            for source in sources {
                let (target, after) = rest.split_at_mut(staged_bytes(source, model) as usize);
                targets.push((*source, &mut target[..source.bytes(model) as usize]));
                rest = after;
            }
            targets.into_par_iter().for_each(|(source, target)| source.write(model, target));
        });
        one_shot(self.gpu, |encoder| {
            for (_, image, offset) in &places {
                encoder.transition(image, Use::Undefined, Use::CopyTo);
                encoder.copy_to_image(&self.buffer, *offset, image);
                encoder.transition(image, Use::CopyTo, Use::Sampled);
            }
            encoder.copies_done();
            Ok(())
        })?;
        textures.extend(places.into_iter().map(|(source, image, _)| (source, image)));
        Ok(())
    }
}

/// Frees the pixels of images that no remaining texture reads.
fn free_unread(model: &mut Model, readers: &[u32]) {
    let unread = Arc::make_mut(&mut model.images).iter_mut().zip(readers).filter(|(_, readers)| **readers == 0);
    unread.for_each(|(image, _)| image.free());
}

/// Creates the image of a texture, without content.
fn make_image(gpu: &Arc<Gpu>, source: &TextureSource, model: &Model) -> Result<Arc<Image>, UploadError> {
    let name = source.image(model).map_or("default", |image| &image.name);
    let format = format_of(source.form(model), source.is_srgb());
    let ((width, height), mips) = (source.size(model), source.levels(model));
    Ok(Image::new(gpu, name, ImageDesc { mips, ..ImageDesc::new(width, height, format, TEXTURE_USAGE) })?)
}

/// Bytes that all levels of a texture take in the staging buffer.
fn staged_bytes(source: &TextureSource, model: &Model) -> u64 {
    source.bytes(model).next_multiple_of(ALIGNMENT)
}
