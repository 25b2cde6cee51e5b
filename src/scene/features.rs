//! Determines which shader features a material needs. Only features that change the picture count; the others cost
//! nothing.
//!
//! What a material uses are bits of a specialization constant, `FEATURES`; `frame/pipelines.rs` adds those that a whole
//! frame shares, and `spirv/hooks.rs` those that the author's hooks set for every lit material
//! (`PipelineRequest::hook_features`). A branch on an unset bit is gone before the driver compiles, so an extension
//! costs only the materials that have it.

use glam::{Affine2, Vec3};

use super::model::{Material, Model, TextureUse, Topology};
use crate::interface::{
    ATTRIBUTE_COLOR, ATTRIBUTE_NORMAL, ATTRIBUTE_TANGENT_FRAME, ATTRIBUTE_UV1, FEATURE_ANISOTROPY, FEATURE_CLEARCOAT,
    FEATURE_CLEARCOAT_NORMAL, FEATURE_CONDUCTOR, FEATURE_DIFFUSE_TRANSMISSION, FEATURE_DISPERSION, FEATURE_IRIDESCENCE,
    FEATURE_NORMAL_TEXTURE, FEATURE_PACKED_OCCLUSION, FEATURE_SHEEN, FEATURE_SPECULAR, FEATURE_SPECULAR_GLOSSINESS,
    FEATURE_TEXTURE_COORDINATES, FEATURE_TRANSMISSION, FEATURE_UNLIT, FEATURE_UV1, FEATURE_VERTEX_COLOR,
    FEATURE_VOLUME, TEXTURE_CLEARCOAT_NORMAL, TEXTURE_IRIDESCENCE_THICKNESS, TEXTURE_METALLIC_ROUGHNESS,
    TEXTURE_NORMAL, TEXTURE_OCCLUSION, TEXTURE_SPECULAR, TEXTURE_SPECULAR_COLOR,
};

/// The `interface::FEATURE_*` bits of a material of `model`, on a mesh with these `interface::ATTRIBUTE_*` bits and this
/// topology. Bits that depend on the frame (environment, rectangular lights) are not included.
pub fn features(model: &Model, material: &Material, attributes: u32, topology: Topology) -> u32 {
    let has_frame = attributes & ATTRIBUTE_TANGENT_FRAME != 0;
    let has = |texture: u32| material.textures[texture as usize].is_some();
    let is_moved = |used: &TextureUse| used.uv_set != 0 || used.uv_from_mesh != Affine2::IDENTITY;
    let moved = if material.textures.iter().flatten().any(is_moved) { FEATURE_TEXTURE_COORDINATES } else { 0 };
    let uv1 = if attributes & ATTRIBUTE_UV1 != 0 { FEATURE_UV1 } else { 0 };
    let color = if attributes & ATTRIBUTE_COLOR != 0 { FEATURE_VERTEX_COLOR } else { 0 };
    let read = moved | uv1 | color;
    let normal = if has_frame && has(TEXTURE_NORMAL) { FEATURE_NORMAL_TEXTURE } else { 0 };
    // Points and lines without normals have no direction to be lit from, so they are drawn without lighting (glTF 2.0, section 3.9).
    let has_faces = matches!(topology, Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan);
    if material.unlit || (!has_faces && attributes & ATTRIBUTE_NORMAL == 0) {
        return FEATURE_UNLIT | normal | read;
    }
    let clearcoat = material.clearcoat.factor > 0.0;
    let specular = &material.specular;
    let film = &material.iridescence;
    let has_film = film.thickness_max_nm > 0.0 || (has(TEXTURE_IRIDESCENCE_THICKNESS) && film.thickness_min_nm > 0.0);
    let transmission = material.transmission_factor > 0.0;
    let diffuse_transmission = material.diffuse_transmission.factor > 0.0;
    let volume = material.volume.thickness > 0.0 && (transmission || diffuse_transmission);
    let conditions = [
        (FEATURE_CLEARCOAT, clearcoat),
        (FEATURE_CLEARCOAT_NORMAL, clearcoat && has_frame && has(TEXTURE_CLEARCOAT_NORMAL)),
        (FEATURE_ANISOTROPY, material.anisotropy.strength > 0.0),
        (FEATURE_SHEEN, material.sheen.color.max_element() > 0.0),
        (
            FEATURE_SPECULAR,
            !material.specular_glossiness
                && (specular.factor != 1.0
                    || specular.color != Vec3::ONE
                    || has(TEXTURE_SPECULAR)
                    || has(TEXTURE_SPECULAR_COLOR)),
        ),
        (FEATURE_IRIDESCENCE, film.factor > 0.0 && has_film),
        (FEATURE_TRANSMISSION, transmission),
        (FEATURE_VOLUME, volume),
        // Diffusely transmitted light has no direction left, so dispersion is invisible in it.
        (FEATURE_DISPERSION, volume && transmission && material.dispersion > 0.0),
        (FEATURE_DIFFUSE_TRANSMISSION, diffuse_transmission),
        (FEATURE_SPECULAR_GLOSSINESS, material.specular_glossiness),
        (FEATURE_CONDUCTOR, !material.specular_glossiness && material.conductor.is_some()),
        // Without an occlusion texture the strength is 0, so the value does not matter; this saves a texture read.
        (FEATURE_PACKED_OCCLUSION, !has(TEXTURE_OCCLUSION) || packs_occlusion(model, material)),
    ];
    conditions.iter().filter(|(_, used)| *used).fold(normal | read, |bits, (bit, _)| bits | bit)
}

/// Whether the red channel of the metallic-roughness texture, which that texture does not use, can hold occlusion. Both
/// textures must have the same coordinates and sampler, and the same image or two of equal size, which the upload
/// merges.
pub fn packs_occlusion(model: &Model, material: &Material) -> bool {
    let slot = |texture: u32| material.textures[texture as usize];
    let (Some(roughness), Some(occlusion)) = (slot(TEXTURE_METALLIC_ROUGHNESS), slot(TEXTURE_OCCLUSION)) else {
        return false;
    };
    // Specular-glossiness has a color in that slot; an unlit material reads neither.
    if material.specular_glossiness || material.unlit {
        return false;
    }
    let [a, b] = [roughness, occlusion].map(|used| model.textures[used.texture]);
    let size = |image: usize| (model.images[image].width, model.images[image].height);
    (roughness.uv_set, roughness.uv_from_mesh) == (occlusion.uv_set, occlusion.uv_from_mesh)
        && a.sampler == b.sampler
        && size(a.image) == size(b.image)
}
