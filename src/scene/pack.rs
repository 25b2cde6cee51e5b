//! Packs materials into the uniform block that the shader reads.

use super::{Conductor, Material};
use crate::interface::{self, TEXTURE_COUNT, TEXTURE_OCCLUSION};

/// The uniform block of a material. `id` is its index in the model.
pub fn pack_material(material: &Material, id: u32) -> interface::Material {
    let conductor = material.conductor.unwrap_or(Conductor { n: glam::Vec3::ONE, k: glam::Vec3::ZERO });
    // `features` relies on this.
    let has_occlusion = material.textures[TEXTURE_OCCLUSION as usize].is_some();
    let (sin, cos) = material.anisotropy.rotation.sin_cos();
    let mut packed = interface::Material {
        base_color_factor: material.base_color_factor.to_array(),
        // KHR_materials_unlit ignores emission; points and lines without normals, which are unlit as well, add it.
        emissive_factor: if material.unlit { [0.0; 3] } else { material.emissive_factor.to_array() },
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
