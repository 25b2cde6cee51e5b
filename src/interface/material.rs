//! Materials in the contract: their features, textures and numbers. A material extension of glTF adds its own here;
//! what it does with them is in `scene::extensions`.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};

use super::access::Resource;
use super::binding::{Binding, BindingKind};
use super::blocks::{Block, Member, blocks, types::*};
use super::constants::constants;
use super::limits::SET_MATERIAL;

constants! {
    /// Alpha modes and features.
    MATERIAL_CONSTANTS:

    /// glTF `alphaMode` OPAQUE.
    ALPHA_OPAQUE = 0;
    /// glTF `alphaMode` MASK.
    ALPHA_MASK = 1;
    /// glTF `alphaMode` BLEND.
    ALPHA_BLEND = 2;

    /// Drawn without lighting: KHR_materials_unlit, and points and lines without normals (glTF 2.0, section 3.9).
    FEATURE_UNLIT = 1;
    /// The material has a normal texture, and the mesh has a tangent frame for it.
    FEATURE_NORMAL_TEXTURE = 1 << 1;
    /// KHR_materials_clearcoat.
    FEATURE_CLEARCOAT = 1 << 2;
    /// The clear coat has a normal texture of its own.
    FEATURE_CLEARCOAT_NORMAL = 1 << 3;
    /// KHR_materials_anisotropy.
    FEATURE_ANISOTROPY = 1 << 4;
    /// KHR_materials_sheen.
    FEATURE_SHEEN = 1 << 5;
    /// KHR_materials_specular.
    FEATURE_SPECULAR = 1 << 6;
    /// KHR_materials_iridescence.
    FEATURE_IRIDESCENCE = 1 << 7;
    /// KHR_materials_transmission.
    FEATURE_TRANSMISSION = 1 << 8;
    /// KHR_materials_volume.
    FEATURE_VOLUME = 1 << 9;
    /// KHR_materials_dispersion.
    FEATURE_DISPERSION = 1 << 10;
    /// KHR_materials_diffuse_transmission.
    FEATURE_DIFFUSE_TRANSMISSION = 1 << 11;
    /// KHR_materials_pbrSpecularGlossiness: diffuse color, F0 and glossiness replace metallic-roughness.
    FEATURE_SPECULAR_GLOSSINESS = 1 << 12;
    /// The model gives the metal's complex index of refraction.
    FEATURE_CONDUCTOR = 1 << 13;
    /// Occlusion is the red channel of the metallic-roughness texture, so one read serves both.
    FEATURE_PACKED_OCCLUSION = 1 << 14;
    /// Image-based light replaces `Frame::ambient`. The same for all materials of a frame.
    FEATURE_ENVIRONMENT = 1 << 15;
    /// There are rectangular lights. The same for all materials of a frame.
    FEATURE_RECT_LIGHTS = 1 << 16;
    /// Some texture is read at TEXCOORD_1, or moved by KHR_texture_transform.
    FEATURE_TEXTURE_COORDINATES = 1 << 17;
    /// The mesh has TEXCOORD_1.
    FEATURE_UV1 = 1 << 18;
    /// The mesh has COLOR_0, and the material does not replace it.
    FEATURE_VERTEX_COLOR = 1 << 19;
}

/// Number of the highest `FEATURE_*` bit. All bits below it are features.
pub const LAST_FEATURE: u32 = FEATURE_VERTEX_COLOR.ilog2();

/// One of a material's textures. Its place in [`TEXTURES`] is its index.
#[derive(Clone, Copy, Debug)]
pub struct Texture {
    /// The name of its index in GLSL, `TEXTURE_...`.
    pub name: &'static str,
    /// Its descriptor.
    pub binding: Binding,
    /// The meaning of its texels.
    pub content: TextureContent,
}

/// The meaning of a texture's texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureContent {
    /// Colors, sRGB-encoded.
    Color,
    /// Numbers.
    Data,
    /// Normals.
    Normal,
}

macro_rules! textures {
    ($(#[doc = $doc:literal] $name:ident, $binding:literal, $content:ident;)+) => {
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
            binding: Binding {
                set: SET_MATERIAL,
                binding: 1 + $name,
                name: $binding,
                kind: BindingKind::Sampler2D,
                size: 0,
                resource: Some(Resource::Material),
            },
            content: TextureContent::$content,
        },)+];
    };
}

textures! {
    /// base color (sRGB) or, in specular-glossiness materials, diffuse color (sRGB)
    TEXTURE_BASE_COLOR, "BINDING_BASE_COLOR_TEXTURE", Color;
    /// metallic (B) and roughness (G) or, in specular-glossiness materials, specular color (sRGB) and glossiness (A)
    TEXTURE_METALLIC_ROUGHNESS, "BINDING_METALLIC_ROUGHNESS_TEXTURE", Data;
    /// normal
    TEXTURE_NORMAL, "BINDING_NORMAL_TEXTURE", Normal;
    /// occlusion (R)
    TEXTURE_OCCLUSION, "BINDING_OCCLUSION_TEXTURE", Data;
    /// emissive (sRGB)
    TEXTURE_EMISSIVE, "BINDING_EMISSIVE_TEXTURE", Color;
    /// clear coat factor (R)
    TEXTURE_CLEARCOAT, "BINDING_CLEARCOAT_TEXTURE", Data;
    /// clear coat roughness (G)
    TEXTURE_CLEARCOAT_ROUGHNESS, "BINDING_CLEARCOAT_ROUGHNESS_TEXTURE", Data;
    /// clear coat normal
    TEXTURE_CLEARCOAT_NORMAL, "BINDING_CLEARCOAT_NORMAL_TEXTURE", Normal;
    /// anisotropy direction (RG) and strength (B)
    TEXTURE_ANISOTROPY, "BINDING_ANISOTROPY_TEXTURE", Data;
    /// sheen color (sRGB)
    TEXTURE_SHEEN_COLOR, "BINDING_SHEEN_COLOR_TEXTURE", Color;
    /// sheen roughness (A)
    TEXTURE_SHEEN_ROUGHNESS, "BINDING_SHEEN_ROUGHNESS_TEXTURE", Data;
    /// specular factor (A)
    TEXTURE_SPECULAR, "BINDING_SPECULAR_TEXTURE", Data;
    /// specular color (sRGB)
    TEXTURE_SPECULAR_COLOR, "BINDING_SPECULAR_COLOR_TEXTURE", Color;
    /// iridescence factor (R)
    TEXTURE_IRIDESCENCE, "BINDING_IRIDESCENCE_TEXTURE", Data;
    /// iridescence thickness (G)
    TEXTURE_IRIDESCENCE_THICKNESS, "BINDING_IRIDESCENCE_THICKNESS_TEXTURE", Data;
    /// transmission factor (R)
    TEXTURE_TRANSMISSION, "BINDING_TRANSMISSION_TEXTURE", Data;
    /// volume thickness (G)
    TEXTURE_THICKNESS, "BINDING_THICKNESS_TEXTURE", Data;
    /// diffuse transmission factor (A)
    TEXTURE_DIFFUSE_TRANSMISSION, "BINDING_DIFFUSE_TRANSMISSION_TEXTURE", Data;
    /// diffuse transmission color (sRGB)
    TEXTURE_DIFFUSE_TRANSMISSION_COLOR, "BINDING_DIFFUSE_TRANSMISSION_COLOR_TEXTURE", Color;
}

/// Number of textures of a material.
pub const TEXTURE_COUNT: usize = TEXTURES.len();

blocks! {
    /// The blocks of a material.
    MATERIAL_BLOCKS:

    /// A material's numbers.
    Material: "layout(set = SET_MATERIAL, binding = BINDING_MATERIAL, scalar) uniform Material", "material" {
        /// Linear RGBA.
        base_color_factor: vec4,
        /// Linear RGB times cd/m^2, KHR_materials_emissive_strength included.
        emissive_factor: vec3,
        /// 0 dielectric .. 1 metal.
        metallic_factor: float,
        /// Perceptual roughness 0..1.
        roughness_factor: float,
        /// Scale of the normal texture's x and y.
        normal_scale: float,
        /// 0 no occlusion .. 1 as in the texture.
        occlusion_strength: float,
        /// ALPHA_MASK: a fragment with less coverage is discarded.
        alpha_cutoff: float,
        /// Bit TEXTURE_*: the material has this texture; else a default one is bound.
        texture_mask: uint,
        /// Bit TEXTURE_*: the texture is read at TEXCOORD_1.
        uv1_mask: uint,
        /// Index of the material, for the id mode.
        id: uint,
        /// Clear coat factor 0..1.
        clearcoat_factor: float,
        /// Perceptual roughness of the clear coat.
        clearcoat_roughness: float,
        /// Scale of the clear coat normal texture's x and y.
        clearcoat_normal_scale: float,
        /// Anisotropy strength 0..1.
        anisotropy_strength: float,
        /// Cosine and sine of the rotation from the tangent towards the bitangent.
        anisotropy_rotation: vec2,
        /// Perceptual roughness of the sheen.
        sheen_roughness: float,
        /// Linear RGB.
        sheen_color: vec3,
        /// Weight of the dielectric's specular reflection 0..1 (KHR_materials_specular).
        specular_factor: float,
        /// Linear RGB, tints the dielectric's F0; specular-glossiness: F0 itself.
        specular_color: vec3,
        /// Index of refraction, at least 1; 0 stands for infinity.
        ior: float,
        /// Iridescence factor 0..1.
        iridescence_factor: float,
        /// Index of refraction of the thin film.
        iridescence_ior: float,
        /// Thickness of the film where its texture is 0 and where it is 1, nanometers.
        iridescence_thickness_nm: vec2,
        /// Transmission factor 0..1.
        transmission_factor: float,
        /// Thickness of the volume below the surface, meters in object space; 0: thin wall.
        thickness: float,
        /// Color of white light after attenuation_distance.
        attenuation_color: vec3,
        /// Meters; infinite without attenuation.
        attenuation_distance: float,
        /// 20 / Abbe number (KHR_materials_dispersion).
        dispersion: float,
        /// Part of the diffuse light that is transmitted, 0..1.
        diffuse_transmission_factor: float,
        /// Linear RGB.
        diffuse_transmission_color: vec3,
        /// Real part of the metal's index of refraction at about 650, 550 and 450 nm.
        conductor_n: vec3,
        /// Imaginary part (extinction coefficient), positive.
        conductor_k: vec3,
        /// KHR_texture_transform of each texture, applied to (u, v, 1).
        uv_from_texture: [mat3x2; TEXTURE_COUNT],
    }
}

/// The numbers of glTF's default material: a white, rough metal without extensions.
pub fn default_material() -> Material {
    Material {
        base_color_factor: [1.0; 4],
        metallic_factor: 1.0,
        roughness_factor: 1.0,
        normal_scale: 1.0,
        occlusion_strength: 1.0,
        alpha_cutoff: 0.5,
        clearcoat_normal_scale: 1.0,
        anisotropy_rotation: [1.0, 0.0],
        specular_factor: 1.0,
        specular_color: [1.0; 3],
        ior: 1.5,
        iridescence_ior: 1.3,
        iridescence_thickness_nm: [100.0, 400.0],
        attenuation_color: [1.0; 3],
        attenuation_distance: f32::INFINITY,
        diffuse_transmission_color: [1.0; 3],
        conductor_n: [1.0; 3],
        uv_from_texture: [[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]; TEXTURE_COUNT],
        ..Material::default()
    }
}
