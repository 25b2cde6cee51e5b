//! Determines which shader features a material needs. Only features that change the picture count; the others cost
//! nothing.
//!
//! The features that a material uses are bits of a specialization constant, `FEATURES`; `frame/pipelines.rs` adds those that a whole
//! frame shares, and `spirv/hooks.rs` those that the author's hooks set for every lit material
//! (`PipelineRequest::hook_features`). A branch on an unset bit is gone before the driver compiles, so an extension
//! costs only the materials that have it.

use glam::Affine2;

use super::extensions::{EXTENSIONS, bit_if};
use super::images::TexelForm;
use super::model::{Material, Model, TextureUse, Topology};
use crate::interface::{
    ATTRIBUTE_COLOR, ATTRIBUTE_NORMAL, ATTRIBUTE_TANGENT_FRAME, ATTRIBUTE_UV1, FEATURE_CONDUCTOR,
    FEATURE_NORMAL_TEXTURE, FEATURE_PACKED_OCCLUSION, FEATURE_TEXTURE_COORDINATES, FEATURE_UNLIT, FEATURE_UV1,
    FEATURE_VERTEX_COLOR, TEXTURE_METALLIC_ROUGHNESS, TEXTURE_NORMAL, TEXTURE_OCCLUSION,
};

/// The `interface::FEATURE_*` bits of a material of `model`, on a mesh with these `interface::ATTRIBUTE_*` bits and this
/// topology. Bits that depend on the frame (environment, rectangular lights) are not included.
pub fn features(model: &Model, material: &Material, attributes: u32, topology: Topology) -> u32 {
    let has_frame = attributes & ATTRIBUTE_TANGENT_FRAME != 0;
    let is_moved = |used: &TextureUse| used.uv_set != 0 || used.uv_from_mesh != Affine2::IDENTITY;
    let moved = bit_if(FEATURE_TEXTURE_COORDINATES, material.textures.iter().flatten().any(is_moved));
    let uv1 = bit_if(FEATURE_UV1, attributes & ATTRIBUTE_UV1 != 0);
    let color = bit_if(FEATURE_VERTEX_COLOR, attributes & ATTRIBUTE_COLOR != 0);
    let read = moved | uv1 | color;
    let normal = bit_if(FEATURE_NORMAL_TEXTURE, has_frame && material.has(TEXTURE_NORMAL));
    // Points and lines without normals have no direction to be lit from, so they are drawn without lighting (glTF 2.0, section 3.9).
    let has_faces = matches!(topology, Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan);
    if material.unlit || (!has_faces && attributes & ATTRIBUTE_NORMAL == 0) {
        return FEATURE_UNLIT | normal | read;
    }
    // Without an occlusion texture the strength is 0, so the value does not matter; this saves a texture read.
    let packs = bit_if(FEATURE_PACKED_OCCLUSION, !material.has(TEXTURE_OCCLUSION) || packs_occlusion(model, material));
    let conductor = bit_if(FEATURE_CONDUCTOR, !material.specular_glossiness && material.conductor);
    EXTENSIONS
        .iter()
        .fold(normal | read | packs | conductor, |bits, extension| bits | (extension.features)(material, has_frame))
}

/// Whether the red channel of the metallic-roughness texture, which that texture does not use, can hold occlusion. Both
/// textures must have the same coordinates and sampler, and the same image or two of equal size and without compression, which the
/// upload merges.
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
    // Channels of blocks cannot be merged.
    let is_plain = |image: usize| model.images[image].form == TexelForm::Rgba8;
    (roughness.uv_set, roughness.uv_from_mesh) == (occlusion.uv_set, occlusion.uv_from_mesh)
        && a.sampler == b.sampler
        && size(a.image) == size(b.image)
        && (a.image == b.image || (is_plain(a.image) && is_plain(b.image)))
}
