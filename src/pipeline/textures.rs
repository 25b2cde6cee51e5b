//! The images of a tree's `//@texture` annotations on the device.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use image::DynamicImage;

use super::cube;
use crate::gpu::{Gpu, GpuError, Image, ImageDesc, Sampler, SamplerDesc, upload_images, vk};
use crate::scene::mips;
use crate::shader::Graph;
use crate::shader::annotation::pass::Wrap;
use crate::shader::graph::Texture;

/// A texture on the device, with what it was made of.
struct Uploaded {
    of: Arc<Texture>,
    image: Arc<Image>,
    sampler: Arc<Sampler>,
}

/// The textures of one shader generation, by name.
#[derive(Default)]
pub(crate) struct PassTextures(BTreeMap<String, Arc<Uploaded>>);

impl PassTextures {
    /// The textures of `graph`. Those that `before` has are taken over; the same object if nothing changed.
    pub(super) fn of(gpu: &Arc<Gpu>, graph: &Graph, before: Option<&Arc<Self>>) -> Result<Arc<Self>, GpuError> {
        let known = |name: &str, of: &Arc<Texture>| {
            before.and_then(|before| before.0.get(name)).filter(|uploaded| uploaded.of == *of)
        };
        if let Some(before) = before
            && before.0.len() == graph.textures.len()
            && graph.textures.iter().all(|(name, of)| known(name, of).is_some())
        {
            return Ok(before.clone());
        }
        let mut textures = BTreeMap::new();
        for (name, of) in &graph.textures {
            let uploaded = match known(name, of) {
                Some(uploaded) => uploaded.clone(),
                None => Arc::new(upload(gpu, of)?),
            };
            textures.insert(name.clone(), uploaded);
        }
        Ok(Arc::new(Self(textures)))
    }

    /// A texture and how it is sampled.
    pub(crate) fn get(&self, name: &str) -> Option<(&Arc<Image>, &Arc<Sampler>)> {
        self.0.get(name).map(|uploaded| (&uploaded.image, &uploaded.sampler))
    }
}

/// Whether a texture is a table of colors.
pub(super) fn is_cube(of: &Texture) -> bool {
    Path::new(&of.path).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("cube"))
}

fn decode(of: &Texture) -> Result<DynamicImage, String> {
    match is_cube(of) {
        true => cube::decode(&of.bytes),
        false => image::load_from_memory(&of.bytes).map_err(|error| format!("cannot be read: {error}")),
    }
}

fn upload(gpu: &Arc<Gpu>, of: &Arc<Texture>) -> Result<Uploaded, GpuError> {
    let mut pixels = decode(of).map_err(|error| GpuError::Texture(format!("{} {error}", of.path)))?;
    if of.note.flip {
        pixels = pixels.flipv();
    }
    let (width, height) = (pixels.width(), pixels.height());
    let most = gpu.max_image_size();
    if width > most || height > most {
        let message = format!("{} has {width} x {height} pixels; this device draws at most {most} a side", of.path);
        return Err(GpuError::Texture(message));
    }
    let is_float = matches!(pixels, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let (format, levels, bytes) = if is_float {
        let texels = pixels.to_rgba32f().into_raw();
        // Half floats end at 65504.
        let half = |value: f32| half::f16::from_f32(value.clamp(-65504.0, 65504.0)).to_le_bytes();
        (vk::Format::R16G16B16A16_SFLOAT, 1, texels.into_iter().flat_map(half).collect())
    } else {
        let mut bytes = pixels.to_rgba8().into_raw();
        let levels = if of.mips { mips::count(width, height) } else { 1 };
        if of.mips {
            let below = mips::below(&bytes, width, height, of.srgb);
            bytes.extend(below);
        }
        (if of.srgb { vk::Format::R8G8B8A8_SRGB } else { vk::Format::R8G8B8A8_UNORM }, levels, bytes)
    };
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let desc = ImageDesc { mips: levels, ..ImageDesc::new(width, height, format, usage) };
    let image = Image::new(gpu, &of.name, desc)?;
    upload_images(gpu, &[(&image, &bytes)])?;
    let wrap = match of.wrap {
        Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    let sampler = Sampler::new(gpu, &SamplerDesc { wrap_u: wrap, wrap_v: wrap, ..SamplerDesc::LINEAR })?;
    Ok(Uploaded { of: of.clone(), image, sampler })
}
