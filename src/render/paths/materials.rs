//! Materials as random paths see them after the first hit: metallic-roughness, and three textures of one small size.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Affine2;

use crate::gpu::{Gpu, GpuError, Image, ImageDesc, Use, one_shot, vk};
use crate::interface::{
    ALPHA_BLEND, ALPHA_MASK, ALPHA_OPAQUE, NO_TEXTURE, TEXTURE_BASE_COLOR, TEXTURE_EMISSIVE,
    TEXTURE_METALLIC_ROUGHNESS, TracedMaterial,
};
use crate::render::scene::GpuModel;
use crate::scene::{AlphaMode, Material, TextureSource};
use crate::settings::MaterialChannel;

/// Width and height of a layer, texels. Materials after the first hit are blurred by the next bounce, so lower detail is enough.
const SIDE: u32 = 256;
/// Layers at most: 64 MiB, and as many as every Vulkan device has. Textures beyond them are left out.
const MOST_LAYERS: usize = 256;

/// The textures that path tracing reads, in the order of `TracedMaterial::layers`.
const SLOTS: [u32; 3] = [TEXTURE_BASE_COLOR, TEXTURE_METALLIC_ROUGHNESS, TEXTURE_EMISSIVE];

/// The TEXCOORD set of a material's textures: the set of its base color, or of its first texture. Textures that use the other set
/// are left out.
pub(super) fn uv_set(material: &Material) -> u32 {
    SLOTS.iter().find_map(|slot| material.textures[*slot as usize]).map_or(0, |used| used.uv_set)
}

/// The materials of a model and their textures as layers of one array.
pub(super) struct Materials<'a> {
    model: &'a GpuModel,
    layers: Vec<Arc<Image>>,
    known: HashMap<TextureSource, u32>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(model: &'a GpuModel) -> Self {
        Self { model, layers: Vec::new(), known: HashMap::new() }
    }

    /// A material of the model, or the material override.
    pub(super) fn pack(&mut self, material: &Material) -> TracedMaterial {
        let numbers = &material.numbers;
        // F0 = ((n - 1) / (n + 1))^2; ior 0 stands for infinity (KHR_materials_ior).
        let from_ior = if numbers.ior > 0.0 { ((numbers.ior - 1.0) / (numbers.ior + 1.0)).powi(2) } else { 1.0 };
        let f0 = match material.specular_glossiness {
            true => numbers.specular_color,
            false => numbers.specular_color.map(|color| (color * from_ior).min(1.0) * numbers.specular_factor),
        };
        let uses = SLOTS.map(|slot| material.textures[slot as usize].filter(|used| used.uv_set == uv_set(material)));
        let mut layers = [NO_TEXTURE; 3];
        for ((layer, slot), used) in layers.iter_mut().zip(SLOTS).zip(uses) {
            // With specular-glossiness, the metallic-roughness slot holds other data.
            let is_other = material.specular_glossiness && slot == TEXTURE_METALLIC_ROUGHNESS;
            if used.is_some() && !is_other && !is_constant(material, slot) {
                *layer = self.layer(material, slot);
            }
        }
        TracedMaterial {
            base_color_factor: numbers.base_color_factor,
            emissive_factor: if material.unlit { [0.0; 3] } else { numbers.emissive_factor },
            metallic_factor: if material.specular_glossiness { 0.0 } else { numbers.metallic_factor },
            roughness_factor: match material.specular_glossiness {
                true => 1.0 - numbers.roughness_factor,
                false => numbers.roughness_factor,
            },
            alpha_cutoff: numbers.alpha_cutoff,
            alpha_mode: match material.alpha_mode {
                AlphaMode::Opaque => ALPHA_OPAQUE,
                AlphaMode::Mask => ALPHA_MASK,
                AlphaMode::Blend => ALPHA_BLEND,
            },
            unlit: material.unlit.into(),
            transmission: numbers.transmission_factor * (1.0 - numbers.metallic_factor),
            ior: numbers.ior,
            f0,
            f90: numbers.specular_factor,
            layers,
            uv_from_texture: uses.map(|used| columns(used.map_or(Affine2::IDENTITY, |used| used.uv_from_mesh))),
        }
    }

    /// The layer of a material's texture. A texture that several materials use has one layer.
    fn layer(&mut self, material: &Material, slot: u32) -> u32 {
        let source = TextureSource::of(self.model.model(), material, slot as usize);
        if let Some(layer) = self.known.get(&source) {
            return *layer;
        }
        let Some(image) = self.model.texture(&source).filter(|_| self.layers.len() < MOST_LAYERS) else {
            return NO_TEXTURE;
        };
        let layer = self.layers.len() as u32;
        self.layers.push(image.clone());
        self.known.insert(source, layer);
        layer
    }

    /// The textures of the layers.
    pub(super) fn layers(&self) -> &[Arc<Image>] {
        &self.layers
    }
}

/// Scales textures to the layers of one array. All layers are stored as sRGB whatever they hold: the copy encodes and the sampler
/// decodes, so shaders read linear values.
pub(super) fn layers(gpu: &Arc<Gpu>, textures: &[Arc<Image>]) -> Result<Arc<Image>, GpuError> {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let side = if textures.is_empty() { 1 } else { SIDE };
    let desc = ImageDesc::new(side, side, vk::Format::R8G8B8A8_SRGB, usage).array(textures.len().max(1) as u32);
    let array = Image::new(gpu, "traced textures", desc)?;
    one_shot(gpu, |encoder| {
        encoder.transition(&array, Use::Undefined, Use::CopyTo);
        for (image, layer) in textures.iter().zip(0..) {
            encoder.transition(image, Use::Sampled, Use::CopyFrom);
            encoder.scale_to_layer(image, level_above(image, SIDE), &array, layer);
            encoder.transition(image, Use::CopyFrom, Use::Sampled);
        }
        encoder.transition(&array, Use::CopyTo, Use::Sampled);
        Ok(())
    })?;
    Ok(array)
}

/// The smallest mip level that has at least `side` texels along its longer edge, so that linear filtering skips none.
fn level_above(image: &Image, side: u32) -> u32 {
    let desc = image.desc();
    let longer = desc.width.max(desc.height);
    (0..desc.mips).take_while(|level| longer >> level >= side).last().unwrap_or(0)
}

/// Whether a texture reads as 1 in all channels that path tracing uses. If it replaces metallic or roughness alone, the texture
/// still multiplies the other value.
fn is_constant(material: &Material, slot: u32) -> bool {
    let has = |channel| material.constant.has(channel);
    match slot {
        // The texture also has the coverage.
        TEXTURE_BASE_COLOR => has(MaterialChannel::BaseColor) && material.alpha_mode == AlphaMode::Opaque,
        TEXTURE_METALLIC_ROUGHNESS => has(MaterialChannel::Metallic) && has(MaterialChannel::Roughness),
        _ => false,
    }
}

fn columns(m: Affine2) -> [[f32; 2]; 3] {
    [m.matrix2.x_axis.to_array(), m.matrix2.y_axis.to_array(), m.translation.to_array()]
}
