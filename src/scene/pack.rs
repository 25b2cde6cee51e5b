//! Packs materials into the uniform block that the shader reads.

use super::material::Material;
use crate::interface::{self, TEXTURE_OCCLUSION};

/// The uniform block of a material. `id` is its index in the model.
pub fn pack_material(material: &Material, id: u32) -> interface::Material {
    let mut packed = interface::Material { id, ..material.numbers };
    // KHR_materials_unlit ignores emission; points and lines without normals, which are unlit as well, add it.
    if material.unlit {
        packed.emissive_factor = [0.0; 3];
    }
    // `features` relies on this.
    if !material.has(TEXTURE_OCCLUSION) {
        packed.occlusion_strength = 0.0;
    }
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
