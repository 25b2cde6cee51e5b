//! Materials on the device: one descriptor set each, with a uniform buffer, textures and samplers.

use std::collections::HashMap;
use std::sync::Arc;

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Image, Memory, Sampler, SamplerDesc, SetLayouts, SetWriter, vk,
};
use crate::interface::{self, TEXTURE_BASE_COLOR, TEXTURE_METALLIC_ROUGHNESS};
use crate::scene::{self as model, Material, Model, TextureSource, pack_material};
use crate::settings::MaterialChannel;

/// The textures on the device, by source.
pub(crate) type Textures = HashMap<TextureSource, Arc<Image>>;

/// Resources that bind the materials of a model.
pub(super) struct MaterialSets<'a> {
    pub(super) gpu: &'a Arc<Gpu>,
    pub(super) layouts: &'a Arc<SetLayouts>,
    pub(super) model: &'a Model,
    pub(super) textures: &'a Textures,
    pub(super) samplers: HashMap<model::Sampler, Arc<Sampler>>,
}

impl MaterialSets<'_> {
    /// The descriptor set of a material, which may differ from the model's material with this index. A texture that must read as
    /// 1 in some channels becomes a view of the same image.
    pub(super) fn set(&mut self, material: &Material, id: u32) -> Result<Arc<DescriptorSet>, GpuError> {
        let Self { gpu, layouts, model, textures, samplers } = self;
        let packed = pack_material(material, id);
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let buffer = Buffer::new(gpu, "material", size_of_val(&packed) as u64, usage, Memory::Upload)?;
        buffer.write(0, bytemuck::bytes_of(&packed));
        let mut writer = SetWriter::default()
            .named(&format!("material `{}`", material.name))
            .buffer(interface::BINDING_MATERIAL, &buffer);
        for (slot, used) in material.textures.iter().enumerate() {
            let wanted = used.map(|used| model.textures[used.texture].sampler).unwrap_or_default();
            let sampler = match samplers.get(&wanted) {
                Some(sampler) => sampler.clone(),
                None => samplers.entry(wanted).or_insert(make_sampler(gpu, &wanted)?).clone(),
            };
            if let Some(image) = textures.get(&TextureSource::of(model, material, slot)) {
                let ones = constant_channels(material, slot);
                let image = if ones == [false; 4] { image.clone() } else { image.with_ones(ones)? };
                writer = writer.texture(interface::TEXTURES[slot].binding.binding, &image, &sampler);
            }
        }
        DescriptorSet::new(layouts, interface::SET_MATERIAL, writer)
    }
}

/// The channels of a texture, red first, that must read as 1.
fn constant_channels(material: &Material, slot: usize) -> [bool; 4] {
    let is_constant = |channel| material.constant.has(channel);
    let (metallic, roughness) = (is_constant(MaterialChannel::Metallic), is_constant(MaterialChannel::Roughness));
    match u32::try_from(slot) {
        Ok(TEXTURE_BASE_COLOR) if is_constant(MaterialChannel::BaseColor) => [true, true, true, false],
        // Its alpha is the glossiness.
        Ok(TEXTURE_METALLIC_ROUGHNESS) if material.specular_glossiness => [false, false, false, roughness],
        Ok(TEXTURE_METALLIC_ROUGHNESS) => [false, roughness, metallic, false],
        _ => [false; 4],
    }
}

fn make_sampler(gpu: &Arc<Gpu>, sampler: &model::Sampler) -> Result<Arc<Sampler>, GpuError> {
    let filter = |linear| if linear { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
    let wrap = |wrap| match wrap {
        model::Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        model::Wrap::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
        model::Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    // On a software device every texel costs time, so only the nearest mip level is read, without anisotropy. On a GPU both are
    // nearly free.
    let software = gpu.info().kind == "cpu";
    let smooth = sampler.mag_linear && sampler.min_linear && sampler.mip == model::Mip::Linear;
    let anisotropy = if smooth && !software { 8 } else { 1 };
    Sampler::new(
        gpu,
        &SamplerDesc {
            mag: filter(sampler.mag_linear),
            min: filter(sampler.min_linear),
            mip: match sampler.mip {
                model::Mip::Linear if !software => vk::SamplerMipmapMode::LINEAR,
                _ => vk::SamplerMipmapMode::NEAREST,
            },
            mips: sampler.mip != model::Mip::None,
            wrap_u: wrap(sampler.wrap_u),
            wrap_v: wrap(sampler.wrap_v),
            wrap_w: vk::SamplerAddressMode::CLAMP_TO_EDGE,
            anisotropy,
        },
    )
}
