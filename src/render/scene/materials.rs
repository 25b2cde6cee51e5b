//! Materials on the device: one descriptor set each, with a uniform buffer, textures and samplers.

use std::collections::HashMap;
use std::sync::Arc;

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Image, Memory, Sampler, SamplerDesc, SetLayouts, SetWriter, vk,
};
use crate::interface;
use crate::scene::{self as model, Model, TextureSource, pack_material};

/// The textures on the device, by source.
pub(crate) type Textures = HashMap<TextureSource, Arc<Image>>;

/// Creates a descriptor set for each material of the model.
pub(crate) fn materials(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    model: &Model,
    textures: &Textures,
) -> Result<Vec<Arc<DescriptorSet>>, GpuError> {
    let mut samplers: HashMap<model::Sampler, Arc<Sampler>> = HashMap::new();
    let mut sets = Vec::new();
    for (id, material) in (0u32..).zip(&model.materials) {
        let packed = pack_material(material, id);
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let buffer = Buffer::new(gpu, "material", size_of_val(&packed) as u64, usage, Memory::Upload)?;
        buffer.write(0, bytemuck::bytes_of(&packed));
        let mut writer = SetWriter::default().named(&format!("material `{}`", material.name)).buffer(0, &buffer);
        for (slot, used) in material.textures.iter().enumerate() {
            let wanted = used.map(|u| model.textures[u.texture].sampler).unwrap_or_default();
            let sampler = match samplers.get(&wanted) {
                Some(sampler) => sampler.clone(),
                None => samplers.entry(wanted).or_insert(make_sampler(gpu, &wanted)?).clone(),
            };
            if let Some(image) = textures.get(&TextureSource::of(model, material, slot)) {
                writer = writer.texture(1 + slot as u32, image, &sampler);
            }
        }
        sets.push(DescriptorSet::new(layouts, interface::SET_MATERIAL, writer)?);
    }
    Ok(sets)
}

fn make_sampler(gpu: &Arc<Gpu>, sampler: &model::Sampler) -> Result<Arc<Sampler>, GpuError> {
    let filter = |linear| if linear { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
    let wrap = |wrap| match wrap {
        model::Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        model::Wrap::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
        model::Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    // On a software device every texel costs time, so it reads only the nearest mip level and takes no anisotropic samples.
    // On a GPU both are nearly free.
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
