//! The textures of a material: index, binding and content of each, declared once.

use super::{Binding, BindingKind, SET_MATERIAL};

/// One of a material's textures. Its place in [`TEXTURES`] is its index.
#[derive(Clone, Copy, Debug)]
pub struct Texture {
    /// The name of its index in GLSL, `TEXTURE_...`.
    pub name: &'static str,
    /// Its descriptor.
    pub binding: Binding,
}

macro_rules! textures {
    ($(#[doc = $doc:literal] $name:ident, $binding:literal;)+) => {
        // Counts the textures in the order of their declaration.
        #[expect(non_camel_case_types, reason = "the variants are named like the constants that they number")]
        enum Index { $($name,)+ }

        $(
            #[doc = concat!("Index of the", $doc, " texture in `Material::uv_from_texture` and in the bit masks.")]
            pub const $name: u32 = Index::$name as u32;
        )+

        /// Every texture of a material. Binding 0 of the set is the material's block, so a texture's binding is its index + 1.
        pub const TEXTURES: &[Texture] = &[$(Texture {
            name: stringify!($name),
            binding: super::binding(super::Resource::Material, SET_MATERIAL, 1 + $name, $binding, BindingKind::Sampler2D, 0),
        },)+];
    };
}

textures! {
    /// base color (sRGB) or, in specular-glossiness materials, diffuse color (sRGB)
    TEXTURE_BASE_COLOR, "BINDING_BASE_COLOR_TEXTURE";
    /// metallic (B) and roughness (G) or, in specular-glossiness materials, specular color (sRGB) and glossiness (A)
    TEXTURE_METALLIC_ROUGHNESS, "BINDING_METALLIC_ROUGHNESS_TEXTURE";
    /// normal
    TEXTURE_NORMAL, "BINDING_NORMAL_TEXTURE";
    /// occlusion (R)
    TEXTURE_OCCLUSION, "BINDING_OCCLUSION_TEXTURE";
    /// emissive (sRGB)
    TEXTURE_EMISSIVE, "BINDING_EMISSIVE_TEXTURE";
    /// clear coat factor (R)
    TEXTURE_CLEARCOAT, "BINDING_CLEARCOAT_TEXTURE";
    /// clear coat roughness (G)
    TEXTURE_CLEARCOAT_ROUGHNESS, "BINDING_CLEARCOAT_ROUGHNESS_TEXTURE";
    /// clear coat normal
    TEXTURE_CLEARCOAT_NORMAL, "BINDING_CLEARCOAT_NORMAL_TEXTURE";
    /// anisotropy direction (RG) and strength (B)
    TEXTURE_ANISOTROPY, "BINDING_ANISOTROPY_TEXTURE";
    /// sheen color (sRGB)
    TEXTURE_SHEEN_COLOR, "BINDING_SHEEN_COLOR_TEXTURE";
    /// sheen roughness (A)
    TEXTURE_SHEEN_ROUGHNESS, "BINDING_SHEEN_ROUGHNESS_TEXTURE";
    /// specular factor (A)
    TEXTURE_SPECULAR, "BINDING_SPECULAR_TEXTURE";
    /// specular color (sRGB)
    TEXTURE_SPECULAR_COLOR, "BINDING_SPECULAR_COLOR_TEXTURE";
    /// iridescence factor (R)
    TEXTURE_IRIDESCENCE, "BINDING_IRIDESCENCE_TEXTURE";
    /// iridescence thickness (G)
    TEXTURE_IRIDESCENCE_THICKNESS, "BINDING_IRIDESCENCE_THICKNESS_TEXTURE";
    /// transmission factor (R)
    TEXTURE_TRANSMISSION, "BINDING_TRANSMISSION_TEXTURE";
    /// volume thickness (G)
    TEXTURE_THICKNESS, "BINDING_THICKNESS_TEXTURE";
    /// diffuse transmission factor (A)
    TEXTURE_DIFFUSE_TRANSMISSION, "BINDING_DIFFUSE_TRANSMISSION_TEXTURE";
    /// diffuse transmission color (sRGB)
    TEXTURE_DIFFUSE_TRANSMISSION_COLOR, "BINDING_DIFFUSE_TRANSMISSION_COLOR_TEXTURE";
}

/// Number of textures of a material.
pub const TEXTURE_COUNT: usize = TEXTURES.len();
