//! The images of a tree's `//@texture` annotations on the device.
//!
//! Textures belong to the pipeline set, since the worker decodes and uploads them. A texture is a name and the kind of
//! sampler that reads it (`TextureKind`), so a table can be a volume in one stage and a strip in another.
//! `graph/textures.rs` finds and reads the files; `shape.rs` derives from the sizes in their headers how layers lie in
//! them and whether the device has such an image, before anything is decoded. `flip` turns a face, layer or slice
//! upside down after it was cut out, an equirectangular image before it is resampled. Only files are cube maps, volumes
//! and arrays: images of passes are 2D.

mod panorama;
mod shape;
mod table;

use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::Arc;

use image::{DynamicImage, ImageError, ImageReader, ImageResult};
use rayon::prelude::*;

use crate::gpu::{Gpu, GpuError, Image, ImageDesc, Sampler, SamplerDesc, upload_images, vk};
use crate::scene::mips::{self, encode_srgb};
use crate::settings::linear_from_srgb;
use crate::shader::annotation::texture::Wrap;
use crate::shader::graph::{Texture, TextureFile, TextureKind};
use crate::shader::{Diagnostic, Graph};
use panorama::is_float;
use shape::{Cut, Shape};
#[cfg(any(test, fuzzing))]
pub(crate) use table::decode as decode_table;

/// A texture on the device, with what it was made from.
struct Uploaded {
    of: Arc<Texture>,
    image: Arc<Image>,
    sampler: Arc<Sampler>,
}

/// The textures of one shader generation, by name and kind.
#[derive(Default)]
pub struct PassTextures(BTreeMap<(String, TextureKind), Arc<Uploaded>>);

impl PassTextures {
    /// Decodes and uploads the textures of `graph`. Textures that `before` has are reused; if nothing changed, the result is the
    /// same object.
    ///
    /// # Errors
    /// A file is no image, sizes do not fit the kind of the texture, or the device has no such image or is out of memory: each
    /// at the line of its annotation.
    pub fn load(gpu: &Arc<Gpu>, graph: &Graph, before: Option<&Arc<Self>>) -> Result<Arc<Self>, Vec<Diagnostic>> {
        let known = |key: &(String, TextureKind), of: &Arc<Texture>| {
            before.and_then(|before| before.0.get(key)).filter(|uploaded| uploaded.of == *of)
        };
        if let Some(before) = before
            && before.0.len() == graph.textures.len()
            && graph.textures.iter().all(|(key, of)| known(key, of).is_some())
        {
            return Ok(before.clone());
        }
        let (mut textures, mut errors) = (BTreeMap::new(), Vec::new());
        for (key, of) in &graph.textures {
            let uploaded = match known(key, of) {
                Some(uploaded) => Ok(uploaded.clone()),
                None => upload(gpu, of).map(Arc::new),
            };
            match uploaded {
                Ok(uploaded) => drop(textures.insert(key.clone(), uploaded)),
                Err(message) => errors.push(of.desc.place.error_at(&of.desc.image, message)),
            }
        }
        if errors.is_empty() { Ok(Arc::new(Self(textures))) } else { Err(errors) }
    }

    /// A texture and how it is sampled.
    pub(crate) fn get(&self, name: &str, kind: TextureKind) -> Option<(&Arc<Image>, &Arc<Sampler>)> {
        self.0.get(&(name.to_owned(), kind)).map(|uploaded| (&uploaded.image, &uploaded.sampler))
    }
}

/// Decodes a texture and uploads it.
fn upload(gpu: &Arc<Gpu>, of: &Arc<Texture>) -> Result<Uploaded, String> {
    // The sizes are checked before anything is decoded.
    let (pictures, sizes) = match of.is_table() {
        true => {
            let table = table::decode(&of.files[0].bytes).map_err(|error| format!("{} {error}", of.files[0].path))?;
            let size = (table.width(), table.height());
            (Some(vec![table]), vec![size])
        }
        false => (None, of.files.iter().map(size).collect::<Result<_, _>>()?),
    };
    let shape = Shape::of(of, &sizes)?;
    if let Some(message) = shape.beyond(gpu, of.kind) {
        return Err(format!("{} {message}", of.files[0].path));
    }
    let pictures = match pictures {
        Some(pictures) => pictures,
        None => of.files.par_iter().map(decode).collect::<Result<_, _>>()?,
    };
    let content = Content::of(layers(pictures, &shape, of), &shape, of);
    make(gpu, of, &shape, &content).map_err(|error| format!("the texture `{}` cannot be made: {error}", of.desc.name))
}

/// Width and height of a file's picture, pixels.
fn size(file: &TextureFile) -> Result<(u32, u32), String> {
    let reader = ImageReader::new(Cursor::new(&file.bytes)).with_guessed_format().map_err(ImageError::IoError);
    readable(file, reader.and_then(ImageReader::into_dimensions))
}

fn decode(file: &TextureFile) -> Result<DynamicImage, String> {
    readable(file, image::load_from_memory(&file.bytes))
}

fn readable<T>(file: &TextureFile, result: ImageResult<T>) -> Result<T, String> {
    result.map_err(|error| format!("{} cannot be read: {error}", file.path))
}

/// Cuts the layers of a texture out of its pictures.
fn layers(pictures: Vec<DynamicImage>, shape: &Shape, of: &Texture) -> Vec<DynamicImage> {
    let flipped = |picture: DynamicImage| if of.desc.flip { picture.flipv() } else { picture };
    let tile = |[column, row]: &[u32; 2]| {
        let (width, height) = (shape.width, shape.height);
        pictures[0].crop_imm(column * width, row * height, width, height)
    };
    match &shape.cut {
        Cut::Files => pictures.into_iter().map(flipped).collect(),
        Cut::Tiles(tiles) => tiles.iter().map(tile).map(flipped).collect(),
        Cut::VerticalCross(tiles) => {
            let mut layers: Vec<DynamicImage> = tiles.iter().map(tile).collect();
            if let Some(last) = layers.last_mut() {
                *last = last.rotate180();
            }
            layers.into_iter().map(flipped).collect()
        }
        Cut::Panorama => {
            let pictures: Vec<DynamicImage> = pictures.into_iter().map(flipped).collect();
            panorama::faces(&pictures[0], shape.width, of.desc.srgb)
        }
    }
}

/// The texels of an image.
struct Content {
    format: vk::Format,
    /// Number of mip levels.
    levels: u32,
    /// The levels one after the other, each with all its layers or slices.
    bytes: Vec<u8>,
}

impl Content {
    fn of(layers: Vec<DynamicImage>, shape: &Shape, of: &Texture) -> Self {
        let is_volume = of.kind == TextureKind::Volume;
        let depth = if is_volume { shape.layers } else { 1 };
        let levels = if of.desc.mips { mips::count(shape.width.max(depth), shape.height) } else { 1 };
        let size = [shape.width, shape.height, depth];
        if layers.iter().any(is_float) {
            let all: Vec<Vec<[f32; 4]>> = layers.into_iter().map(floats).collect();
            let all = if is_volume { vec![all.concat()] } else { all };
            let with_levels = all.into_par_iter().map(|mut texels| {
                if of.desc.mips {
                    texels.extend(mips::below_floats(&texels, size));
                }
                texels
            });
            let bytes = by_level(&with_levels.collect::<Vec<_>>(), 1, size, levels);
            let bytes = bytes.into_iter().flatten().flat_map(half_float).collect();
            return Self { format: vk::Format::R16G16B16A16_SFLOAT, levels, bytes };
        }
        let srgb = of.desc.srgb;
        let format = if srgb { vk::Format::R8G8B8A8_SRGB } else { vk::Format::R8G8B8A8_UNORM };
        let all: Vec<Vec<u8>> = layers.into_iter().map(|layer| layer.to_rgba8().into_raw()).collect();
        if !of.desc.mips {
            return Self { format, levels, bytes: all.concat() };
        }
        if is_volume {
            let mut bytes = all.concat();
            let below = mips::below_floats(&light(&bytes, srgb), size);
            bytes.extend(below.into_iter().flat_map(|texel| encoded(texel, srgb)));
            return Self { format, levels, bytes };
        }
        let with_levels = all.into_par_iter().map(|mut bytes| {
            let below = mips::below(&bytes, shape.width, shape.height, srgb);
            bytes.extend(below);
            bytes
        });
        Self { format, levels, bytes: by_level(&with_levels.collect::<Vec<_>>(), 4, size, levels) }
    }
}

/// Levels that each hold all layers, of layers that each hold all levels. A texel has `values` values.
fn by_level<T: Copy>(layers: &[Vec<T>], values: usize, size: [u32; 3], levels: u32) -> Vec<T> {
    let mut out = Vec::with_capacity(layers.iter().map(Vec::len).sum());
    let mut at = 0;
    for level in 0..levels {
        let texels: usize = size.iter().map(|side| (side >> level).max(1) as usize).product();
        let end = at + texels * values;
        layers.iter().for_each(|layer| out.extend_from_slice(&layer[at..end]));
        at = end;
    }
    out
}

fn floats(picture: DynamicImage) -> Vec<[f32; 4]> {
    picture.to_rgba32f().into_raw().chunks_exact(4).map(|t| [t[0], t[1], t[2], t[3]]).collect()
}

/// Half floats end at 65504.
fn half_float(value: f32) -> [u8; 2] {
    half::f16::from_f32(value.clamp(-65504.0, 65504.0)).to_le_bytes()
}

/// Texels as linear values. Alpha is always linear.
fn light(bytes: &[u8], srgb: bool) -> Vec<[f32; 4]> {
    let value = |channel: usize, byte: u8| match f32::from(byte) / 255.0 {
        encoded if srgb && channel < 3 => linear_from_srgb(encoded),
        linear => linear,
    };
    bytes.chunks_exact(4).map(|texel| std::array::from_fn(|channel| value(channel, texel[channel]))).collect()
}

/// The inverse of [`light`] for a texel.
fn encoded(texel: [f32; 4], srgb: bool) -> [u8; 4] {
    let value = |channel: usize| if srgb && channel < 3 { encode_srgb(texel[channel]) } else { texel[channel] };
    std::array::from_fn(|channel| (value(channel) * 255.0).round() as u8)
}

fn make(gpu: &Arc<Gpu>, of: &Arc<Texture>, shape: &Shape, content: &Content) -> Result<Uploaded, GpuError> {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let one = ImageDesc { mips: content.levels, ..ImageDesc::new(shape.width, shape.height, content.format, usage) };
    let desc = match of.kind {
        TextureKind::Flat => one,
        TextureKind::Cube => ImageDesc::cube(shape.width, content.levels, content.format, usage),
        TextureKind::Volume => one.volume(shape.layers),
        TextureKind::Array => one.array(shape.layers),
    };
    let image = Image::new(gpu, &of.desc.name, desc)?;
    upload_images(gpu, &[(&image, &content.bytes)])?;
    let wrap = match of.desc.wrap {
        Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        Wrap::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
    };
    let [min, mag] = of.desc.nearest.map(|nearest| if nearest { vk::Filter::NEAREST } else { vk::Filter::LINEAR });
    let sampler = SamplerDesc { min, mag, wrap_u: wrap, wrap_v: wrap, wrap_w: wrap, ..SamplerDesc::LINEAR };
    Ok(Uploaded { of: of.clone(), image, sampler: Sampler::new(gpu, &sampler)? })
}
