//! The contract between Rust and GLSL: descriptor sets, bindings, specialization ids and the structs that both sides read.
//!
//! Rust writes this memory, so Rust owns its meaning. [`glsl`] prints the whole contract as `shaders/interface.glsl`;
//! `shader::contract` holds every compiled stage against [`BINDINGS`], [`SPECIALIZATION`] and the struct sizes below.
//!
//! All blocks use `scalar` layout, so a Rust `#[repr(C)]` struct of 4-byte fields and its GLSL twin agree byte for byte.

mod blocks;
mod print;

pub use blocks::{Draw, Frame, Light, Material, Task, Vertex};
pub use print::glsl;

/// Raised whenever a shader tree written for the previous contract would misread memory.
pub const VERSION: u32 = 3;

/// Set 0: bound once a frame.
pub const SET_FRAME: u32 = 0;
/// Set 1: bound once a material.
pub const SET_MATERIAL: u32 = 1;
/// Set 2: the images that a pass reads.
pub const SET_PASS: u32 = 2;
/// Set 3: what a compute task reads and writes.
pub const SET_TASK: u32 = 3;

/// Push constants available to every graphics pipeline, in bytes (lavapipe and the Vulkan minimum both give 128).
pub const PUSH_CONSTANT_SIZE: u32 = 128;
/// Size of the user's parameter block in bytes: what `//@ui` members of `Params` may fill together.
pub const PARAMS_SIZE: u32 = 4096;

/// Most lights of a frame: as many as fit into 16 KiB, the largest uniform block that every device has.
pub const MAX_LIGHTS: usize = 16384 / size_of::<Light>();

/// Specialization constants from this id on belong to the shader author (`//@ui` on a `constant_id`).
pub const USER_CONSTANTS: u32 = 32;

/// How a descriptor is used; printed into messages, so in GLSL's words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// `uniform` block.
    UniformBuffer,
    /// `buffer` block.
    StorageBuffer,
    /// `sampler2D`.
    Sampler2D,
    /// `samplerCube`.
    SamplerCube,
    /// `rgba16f image2DArray`: one level of an image, all its layers.
    StorageImage,
}

impl BindingKind {
    /// The GLSL spelling, for messages.
    pub fn glsl(self) -> &'static str {
        match self {
            Self::UniformBuffer => "uniform block",
            Self::StorageBuffer => "buffer block",
            Self::Sampler2D => "sampler2D",
            Self::SamplerCube => "samplerCube",
            Self::StorageImage => "rgba16f image2DArray",
        }
    }
}

/// Binding in [`SET_TASK`] of the buffer that a task leaves numbers in; it is as large as the stages declare it.
pub const BINDING_RESULTS: u32 = 5;

/// One descriptor of the contract. A shader may use any subset.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Descriptor set.
    pub set: u32,
    /// Binding within the set.
    pub binding: u32,
    /// The constant's name in GLSL, `BINDING_...`.
    pub name: &'static str,
    /// What is bound there.
    pub kind: BindingKind,
    /// For blocks: the largest size in bytes that a shader may declare.
    pub size: u32,
}

const fn binding(set: u32, binding: u32, name: &'static str, kind: BindingKind, size: usize) -> Binding {
    Binding { set, binding, name, kind, size: size as u32 }
}

/// Every descriptor of the contract, ordered by set and binding.
pub const BINDINGS: &[Binding] = &[
    binding(SET_FRAME, 0, "BINDING_FRAME", BindingKind::UniformBuffer, size_of::<Frame>()),
    // Uniform blocks where a storage buffer would do: a software device reads those for each pixel of a group apart.
    binding(SET_FRAME, 1, "BINDING_LIGHTS", BindingKind::UniformBuffer, MAX_LIGHTS * size_of::<Light>()),
    binding(SET_FRAME, 2, "BINDING_PARAMS", BindingKind::UniformBuffer, PARAMS_SIZE as usize),
    binding(SET_FRAME, 3, "BINDING_ENVIRONMENT", BindingKind::SamplerCube, 0),
    binding(SET_FRAME, 4, "BINDING_PREFILTERED", BindingKind::SamplerCube, 0),
    binding(SET_FRAME, 5, "BINDING_PREFILTERED_SHEEN", BindingKind::SamplerCube, 0),
    binding(SET_FRAME, 6, "BINDING_IRRADIANCE", BindingKind::SamplerCube, 0),
    binding(SET_FRAME, 7, "BINDING_DFG", BindingKind::Sampler2D, 0),
    binding(SET_FRAME, 8, "BINDING_LTC", BindingKind::Sampler2D, 0),
    binding(SET_FRAME, 9, "BINDING_MEASURED", BindingKind::StorageBuffer, 0),
    binding(SET_FRAME, 10, "BINDING_SHEEN_ALBEDO", BindingKind::Sampler2D, 0),
    // Nothing is there, and it must be the fourth uniform block that a stage can see: Mesa's lavapipe (22.3) notes which
    // uniforms branches depend on, and those of the fourth over its own counters, which ends the process.
    binding(SET_FRAME, 11, "BINDING_UNUSED", BindingKind::UniformBuffer, 16),
    binding(SET_MATERIAL, 0, "BINDING_MATERIAL", BindingKind::UniformBuffer, size_of::<Material>()),
    binding(SET_MATERIAL, 1, "BINDING_BASE_COLOR_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 2, "BINDING_METALLIC_ROUGHNESS_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 3, "BINDING_NORMAL_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 4, "BINDING_OCCLUSION_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 5, "BINDING_EMISSIVE_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 6, "BINDING_CLEARCOAT_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 7, "BINDING_CLEARCOAT_ROUGHNESS_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 8, "BINDING_CLEARCOAT_NORMAL_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 9, "BINDING_ANISOTROPY_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 10, "BINDING_SHEEN_COLOR_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 11, "BINDING_SHEEN_ROUGHNESS_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 12, "BINDING_SPECULAR_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 13, "BINDING_SPECULAR_COLOR_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 14, "BINDING_IRIDESCENCE_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 15, "BINDING_IRIDESCENCE_THICKNESS_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 16, "BINDING_TRANSMISSION_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 17, "BINDING_THICKNESS_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 18, "BINDING_DIFFUSE_TRANSMISSION_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_MATERIAL, 19, "BINDING_DIFFUSE_TRANSMISSION_COLOR_TEXTURE", BindingKind::Sampler2D, 0),
    binding(SET_PASS, 0, "BINDING_SCENE_COLOR", BindingKind::Sampler2D, 0),
    binding(SET_PASS, 1, "BINDING_BEHIND", BindingKind::Sampler2D, 0),
    binding(SET_TASK, 0, "BINDING_TASK", BindingKind::UniformBuffer, size_of::<Task>()),
    binding(SET_TASK, 1, "BINDING_SOURCE", BindingKind::Sampler2D, 0),
    binding(SET_TASK, 2, "BINDING_SOURCE_CUBE", BindingKind::SamplerCube, 0),
    binding(SET_TASK, 3, "BINDING_TARGET", BindingKind::StorageImage, 0),
    binding(SET_TASK, 4, "BINDING_LEVEL_ABOVE", BindingKind::StorageImage, 0),
    binding(SET_TASK, BINDING_RESULTS, "BINDING_RESULTS", BindingKind::StorageBuffer, 0),
];

/// A specialization constant that Rust sets.
#[derive(Clone, Copy, Debug)]
pub struct Specialization {
    /// `constant_id`.
    pub id: u32,
    /// Name in GLSL.
    pub name: &'static str,
    /// What it selects.
    pub doc: &'static str,
}

/// `constant_id` of [`SPECIALIZATION`]'s debug mode.
pub const SPEC_MODE: u32 = 0;
/// [`SPEC_MODE`]: the picture. The other modes are the tree's.
pub const MODE_FINAL: u32 = 0;
/// `constant_id` of the material's alpha mode: [`ALPHA_OPAQUE`], [`ALPHA_MASK`] or [`ALPHA_BLEND`].
pub const SPEC_ALPHA_MODE: u32 = 1;
/// `constant_id` of the material's features: the `FEATURE_*` bits.
pub const SPEC_FEATURES: u32 = 2;

/// `constant_id` of the tone map, `TONEMAP_*` in common/tonemap.glsl or [`TONEMAP_OFF`]; for the tone mapping pass.
pub const SPEC_TONEMAP: u32 = 3;
/// `constant_id` of the encoding, `ENCODE_*`; for the tone mapping pass.
pub const SPEC_ENCODE: u32 = 4;

/// `constant_id` of the number of lights, up to [`UNROLLED_LIGHTS`]; 0: only `Frame::light_count` knows.
pub const SPEC_LIGHT_COUNT: u32 = 5;
/// So many lights, or fewer, are worth pipelines of their own, in which the loop over them is unrolled.
pub const UNROLLED_LIGHTS: usize = 4;

/// The specialization constants that Rust sets for every stage; those from [`USER_CONSTANTS`] on are the author's.
pub const SPECIALIZATION: &[Specialization] = &[
    Specialization { id: SPEC_MODE, name: "MODE", doc: "debug mode, one of MODE_* in debug/modes.glsl" },
    Specialization { id: SPEC_ALPHA_MODE, name: "ALPHA_MODE", doc: "glTF alphaMode, one of ALPHA_*" },
    Specialization { id: SPEC_FEATURES, name: "FEATURES", doc: "what the material uses, FEATURE_* bits" },
    Specialization { id: SPEC_TONEMAP, name: "TONEMAP", doc: "tone map, one of TONEMAP_* in common/tonemap.glsl" },
    Specialization { id: SPEC_ENCODE, name: "ENCODE", doc: "how the picture stores values, one of ENCODE_*" },
    Specialization {
        id: SPEC_LIGHT_COUNT,
        name: "LIGHT_COUNT",
        doc: "lights, if they are few; 0: see frame.light_count",
    },
];

/// glTF `alphaMode` OPAQUE.
pub const ALPHA_OPAQUE: u32 = 0;
/// glTF `alphaMode` MASK.
pub const ALPHA_MASK: u32 = 1;
/// glTF `alphaMode` BLEND.
pub const ALPHA_BLEND: u32 = 2;

/// KHR_materials_unlit.
pub const FEATURE_UNLIT: u32 = 1;
/// The material has a normal texture and the mesh a tangent frame for it.
pub const FEATURE_NORMAL_TEXTURE: u32 = 2;
/// KHR_materials_clearcoat.
pub const FEATURE_CLEARCOAT: u32 = 1 << 2;
/// The clear coat has a normal texture of its own.
pub const FEATURE_CLEARCOAT_NORMAL: u32 = 1 << 3;
/// KHR_materials_anisotropy.
pub const FEATURE_ANISOTROPY: u32 = 1 << 4;
/// KHR_materials_sheen.
pub const FEATURE_SHEEN: u32 = 1 << 5;
/// KHR_materials_specular.
pub const FEATURE_SPECULAR: u32 = 1 << 6;
/// KHR_materials_iridescence.
pub const FEATURE_IRIDESCENCE: u32 = 1 << 7;
/// KHR_materials_transmission.
pub const FEATURE_TRANSMISSION: u32 = 1 << 8;
/// KHR_materials_volume.
pub const FEATURE_VOLUME: u32 = 1 << 9;
/// KHR_materials_dispersion.
pub const FEATURE_DISPERSION: u32 = 1 << 10;
/// KHR_materials_diffuse_transmission.
pub const FEATURE_DIFFUSE_TRANSMISSION: u32 = 1 << 11;
/// KHR_materials_pbrSpecularGlossiness: diffuse color, F0 and glossiness in place of metallic-roughness.
pub const FEATURE_SPECULAR_GLOSSINESS: u32 = 1 << 12;
/// The metal's complex index of refraction is given.
pub const FEATURE_CONDUCTOR: u32 = 1 << 13;
/// Occlusion is the red channel of the metallic-roughness texture, read once for both.
pub const FEATURE_PACKED_OCCLUSION: u32 = 1 << 14;
/// There is an environment: image-based light in place of `Frame::ambient`. The same for all materials of a frame.
pub const FEATURE_ENVIRONMENT: u32 = 1 << 15;
/// There are rectangular lights. The same for all materials of a frame.
pub const FEATURE_RECT_LIGHTS: u32 = 1 << 16;
/// Some texture is not read at TEXCOORD_0 as it is: at TEXCOORD_1, or moved by KHR_texture_transform.
pub const FEATURE_TEXTURE_COORDINATES: u32 = 1 << 17;
/// The mesh has TEXCOORD_1.
pub const FEATURE_UV1: u32 = 1 << 18;
/// The mesh has COLOR_0, and the material does not replace it.
pub const FEATURE_VERTEX_COLOR: u32 = 1 << LAST_FEATURE;
/// Number of the highest of these bits; all below it are features.
pub const LAST_FEATURE: u32 = 19;

/// Index of the base color texture in `Material::uv_from_texture` and in the bit masks. sRGB; glTF specular-glossiness: the diffuse texture.
pub const TEXTURE_BASE_COLOR: u32 = 0;
/// Index of the metallic-roughness texture (B, G). glTF specular-glossiness: specular color (sRGB) and glossiness (A).
pub const TEXTURE_METALLIC_ROUGHNESS: u32 = 1;
/// Index of the normal texture.
pub const TEXTURE_NORMAL: u32 = 2;
/// Index of the occlusion texture (R).
pub const TEXTURE_OCCLUSION: u32 = 3;
/// Index of the emissive texture (sRGB).
pub const TEXTURE_EMISSIVE: u32 = 4;
/// Index of the clear coat factor texture (R).
pub const TEXTURE_CLEARCOAT: u32 = 5;
/// Index of the clear coat roughness texture (G).
pub const TEXTURE_CLEARCOAT_ROUGHNESS: u32 = 6;
/// Index of the clear coat normal texture.
pub const TEXTURE_CLEARCOAT_NORMAL: u32 = 7;
/// Index of the anisotropy texture (RG direction, B strength).
pub const TEXTURE_ANISOTROPY: u32 = 8;
/// Index of the sheen color texture (sRGB).
pub const TEXTURE_SHEEN_COLOR: u32 = 9;
/// Index of the sheen roughness texture (A).
pub const TEXTURE_SHEEN_ROUGHNESS: u32 = 10;
/// Index of the specular factor texture (A).
pub const TEXTURE_SPECULAR: u32 = 11;
/// Index of the specular color texture (sRGB).
pub const TEXTURE_SPECULAR_COLOR: u32 = 12;
/// Index of the iridescence factor texture (R).
pub const TEXTURE_IRIDESCENCE: u32 = 13;
/// Index of the iridescence thickness texture (G).
pub const TEXTURE_IRIDESCENCE_THICKNESS: u32 = 14;
/// Index of the transmission texture (R).
pub const TEXTURE_TRANSMISSION: u32 = 15;
/// Index of the volume thickness texture (G).
pub const TEXTURE_THICKNESS: u32 = 16;
/// Index of the diffuse transmission factor texture (A).
pub const TEXTURE_DIFFUSE_TRANSMISSION: u32 = 17;
/// Index of the diffuse transmission color texture (sRGB).
pub const TEXTURE_DIFFUSE_TRANSMISSION_COLOR: u32 = 18;
/// How many textures a material has.
pub const TEXTURE_COUNT: usize = 19;

/// `Draw::attributes`: the mesh came with normals (else flat ones were made).
pub const ATTRIBUTE_NORMAL: u32 = 1;
/// `Draw::attributes`: the mesh came with tangents (else MikkTSpace made them).
pub const ATTRIBUTE_TANGENT: u32 = 2;
/// `Draw::attributes`: the mesh has TEXCOORD_0.
pub const ATTRIBUTE_UV0: u32 = 4;
/// `Draw::attributes`: the mesh has TEXCOORD_1.
pub const ATTRIBUTE_UV1: u32 = 8;
/// `Draw::attributes`: the mesh has COLOR_0.
pub const ATTRIBUTE_COLOR: u32 = 16;
/// `Draw::attributes`: a usable tangent frame exists, from the file or made.
pub const ATTRIBUTE_TANGENT_FRAME: u32 = 32;

/// `Light::kind`: parallel light, intensity in lux.
pub const LIGHT_DIRECTIONAL: u32 = 0;
/// `Light::kind`: point light, intensity in candela.
pub const LIGHT_POINT: u32 = 1;
/// `Light::kind`: spot light, intensity in candela.
pub const LIGHT_SPOT: u32 = 2;
/// `Light::kind`: one-sided rectangle, intensity is its radiance.
pub const LIGHT_RECT: u32 = 3;

/// First word of the measured BRDF's buffer: there is none.
pub const MEASURED_NONE: u32 = 0;
/// First word of the measured BRDF's buffer: MERL's grid follows.
pub const MEASURED_MERL: u32 = 1;
/// First word of the measured BRDF's buffer: UTIA's grid follows.
pub const MEASURED_UTIA: u32 = 2;

/// [`SPEC_ENCODE`]: colors, sRGB-encoded on output.
pub const ENCODE_COLOR: u32 = 0;
/// [`SPEC_ENCODE`]: numbers, stored as they are.
pub const ENCODE_DATA: u32 = 1;
/// [`SPEC_ENCODE`]: vectors, stored as v * 0.5 + 0.5.
pub const ENCODE_VECTOR: u32 = 2;

/// [`SPEC_TONEMAP`]: values that are not light (debug modes) skip exposure and tone mapping.
pub const TONEMAP_OFF: u32 = 0xffff_ffff;
