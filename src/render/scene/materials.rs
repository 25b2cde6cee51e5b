//! Materials on the device: a uniform buffer, textures and samplers in a descriptor set each.

use std::collections::HashMap;
use std::sync::Arc;

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Image, Memory, Sampler, SamplerDesc, SetLayouts, SetWriter, vk,
};
use crate::interface::{self, TEXTURE_COUNT, TEXTURE_OCCLUSION};
use crate::scene::{self as model, Model, TextureSource};

/// The images on the device.
pub(crate) type Textures = HashMap<TextureSource, Arc<Image>>;

/// A descriptor set for each material of the model.
pub(crate) fn materials(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    model: &Model,
    textures: &Textures,
) -> Result<Vec<Arc<DescriptorSet>>, GpuError> {
    let mut samplers: HashMap<model::Sampler, Arc<Sampler>> = HashMap::new();
    let mut sets = Vec::new();
    for (id, material) in (0u32..).zip(&model.materials) {
        let packed = pack(material, id);
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

/// A material as the shader reads it.
pub(crate) fn pack(material: &model::Material, id: u32) -> interface::Material {
    let conductor = material.conductor.unwrap_or(model::Conductor { n: glam::Vec3::ONE, k: glam::Vec3::ZERO });
    // As `model::features` relies on.
    let has_occlusion = material.textures[TEXTURE_OCCLUSION as usize].is_some();
    let (sin, cos) = material.anisotropy.rotation.sin_cos();
    let mut packed = interface::Material {
        base_color_factor: material.base_color_factor.to_array(),
        emissive_factor: material.emissive_factor.to_array(),
        metallic_factor: material.metallic_factor,
        roughness_factor: material.roughness_factor,
        normal_scale: material.normal_scale,
        occlusion_strength: if has_occlusion { material.occlusion_strength } else { 0.0 },
        alpha_cutoff: material.alpha_cutoff,
        texture_mask: 0,
        uv1_mask: 0,
        id,
        clearcoat_factor: material.clearcoat.factor,
        clearcoat_roughness: material.clearcoat.roughness,
        clearcoat_normal_scale: material.clearcoat.normal_scale,
        anisotropy_strength: material.anisotropy.strength,
        anisotropy_rotation: [cos, sin],
        sheen_roughness: material.sheen.roughness,
        sheen_color: material.sheen.color.to_array(),
        specular_factor: material.specular.factor,
        specular_color: material.specular.color.to_array(),
        ior: material.ior,
        iridescence_factor: material.iridescence.factor,
        iridescence_ior: material.iridescence.ior,
        iridescence_thickness_nm: [material.iridescence.thickness_min_nm, material.iridescence.thickness_max_nm],
        transmission_factor: material.transmission_factor,
        thickness: material.volume.thickness,
        attenuation_color: material.volume.attenuation_color.to_array(),
        attenuation_distance: material.volume.attenuation_distance,
        dispersion: material.dispersion,
        diffuse_transmission_factor: material.diffuse_transmission.factor,
        diffuse_transmission_color: material.diffuse_transmission.color.to_array(),
        conductor_n: conductor.n.to_array(),
        conductor_k: conductor.k.to_array(),
        uv_from_texture: [[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]; TEXTURE_COUNT],
    };
    for (slot, used) in material.textures.iter().enumerate() {
        let Some(used) = used else { continue };
        packed.texture_mask |= 1 << slot;
        packed.uv1_mask |= used.uv_set << slot;
        let m = used.uv_from_mesh;
        packed.uv_from_texture[slot] =
            [m.matrix2.x_axis.to_array(), m.matrix2.y_axis.to_array(), m.translation.to_array()];
    }
    packed
}

fn make_sampler(gpu: &Arc<Gpu>, sampler: &model::Sampler) -> Result<Arc<Sampler>, GpuError> {
    let filter = |linear| if linear { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
    let wrap = |wrap| match wrap {
        model::Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        model::Wrap::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
        model::Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    // A software device pays for each texel: it reads the nearest of two mip levels, and no anisotropic samples. A GPU
    // hardly notices either.
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
            anisotropy,
        },
    )
}
