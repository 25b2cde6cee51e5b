//! The contract between Rust and GLSL: descriptor sets, bindings, specialization ids and the structs that both sides read.
//!
//! Rust writes this memory, so Rust owns its meaning. [`glsl`] prints the whole contract as `shaders/interface.glsl`;
//! `shader::contract` holds every compiled stage against [`BINDINGS`], [`SPECIALIZATION`] and the struct sizes below.
//!
//! All blocks use `scalar` layout, so a Rust `#[repr(C)]` struct of 4-byte fields and its GLSL twin agree byte for byte.

mod print;

use bytemuck::{Pod, Zeroable};

pub use print::glsl;

/// Raised whenever a shader tree written for the previous contract would misread memory.
pub const VERSION: u32 = 2;

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
pub const MAX_LIGHTS: usize = 215;
/// Size of the irradiance block in bytes: nine RGB coefficients.
pub const IRRADIANCE_SIZE: usize = 9 * 12;

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
    binding(SET_FRAME, 6, "BINDING_IRRADIANCE", BindingKind::UniformBuffer, IRRADIANCE_SIZE),
    binding(SET_FRAME, 7, "BINDING_DFG", BindingKind::Sampler2D, 0),
    binding(SET_FRAME, 8, "BINDING_LTC", BindingKind::Sampler2D, 0),
    binding(SET_FRAME, 9, "BINDING_MEASURED", BindingKind::StorageBuffer, 0),
    binding(SET_FRAME, 10, "BINDING_SHEEN_ALBEDO", BindingKind::Sampler2D, 0),
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
    binding(SET_TASK, 5, "BINDING_RESULTS", BindingKind::StorageBuffer, 0),
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
/// `constant_id` of the material's alpha mode: [`ALPHA_OPAQUE`], [`ALPHA_MASK`] or [`ALPHA_BLEND`].
pub const SPEC_ALPHA_MODE: u32 = 1;
/// `constant_id` of the material's features: the `FEATURE_*` bits.
pub const SPEC_FEATURES: u32 = 2;

/// `constant_id` of the tone map, `TONEMAP_*` in common/tonemap.glsl or [`TONEMAP_OFF`]; for the tone mapping pass.
pub const SPEC_TONEMAP: u32 = 3;
/// `constant_id` of the encoding, `ENCODE_*`; for the tone mapping pass.
pub const SPEC_ENCODE: u32 = 4;

/// The specialization constants that Rust sets for every stage; those from [`USER_CONSTANTS`] on are the author's.
pub const SPECIALIZATION: &[Specialization] = &[
    Specialization { id: SPEC_MODE, name: "MODE", doc: "debug mode, one of MODE_* in debug/modes.glsl" },
    Specialization { id: SPEC_ALPHA_MODE, name: "ALPHA_MODE", doc: "glTF alphaMode, one of ALPHA_*" },
    Specialization { id: SPEC_FEATURES, name: "FEATURES", doc: "what the material uses, FEATURE_* bits" },
    Specialization { id: SPEC_TONEMAP, name: "TONEMAP", doc: "tone map, one of TONEMAP_* in common/tonemap.glsl" },
    Specialization { id: SPEC_ENCODE, name: "ENCODE", doc: "how the picture stores values, one of ENCODE_*" },
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

/// What a frame shares: camera, output, counts. `SET_FRAME`, `BINDING_FRAME`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Frame {
    /// World (meters, +Y up) to Vulkan clip space (+Y down, depth 0 far to 1 near: reversed).
    pub clip_from_world: [[f32; 4]; 4],
    /// Inverse of `clip_from_world`.
    pub world_from_clip: [[f32; 4]; 4],
    /// World to view space (camera looks along -Z).
    pub view_from_world: [[f32; 4]; 4],
    /// Camera position, world space.
    pub eye_ws: [f32; 3],
    /// Factor from luminance (cd/m^2) to the display's 0..1: 1 / (1.2 * 2^EV100).
    pub exposure: f32,
    /// Radiance that arrives from everywhere, linear RGB.
    pub ambient: [f32; 3],
    /// Seconds since the start; 0 in headless renderings.
    pub time_s: f32,
    /// Linear RGB behind the model, and its alpha.
    pub background: [f32; 4],
    /// Center of the model's bounds, world space.
    pub scene_center_ws: [f32; 3],
    /// Radius of the model's bounds, meters.
    pub scene_radius: f32,
    /// Width and height of the picture in pixels.
    pub viewport_px: [f32; 2],
    /// Upper left corner of the picture in the output image, pixels.
    pub viewport_origin_px: [f32; 2],
    /// Near plane distance, meters.
    pub near: f32,
    /// Far plane distance, meters (debug views only: the projection is infinite).
    pub far: f32,
    /// Lights in `BINDING_LIGHTS`.
    pub light_count: u32,
    /// Which light the BRDF term modes show: 0 all, else 1-based.
    pub chosen_light: u32,
    /// Debug mode on screen, for passes that are not specialized by mode.
    pub mode: u32,
    /// Largest value that the HDR target holds: 65504 for half floats.
    pub largest_value: f32,
    /// Cosine and sine of the environment's rotation around +Y: its map's center column is seen looking down -Z turned by it.
    pub environment_rotation: [f32; 2],
    /// Factor from what the environment's images hold to radiance.
    pub environment_intensity: f32,
    /// Blur of the environment behind the model: 0 sharp .. 1, as a roughness.
    pub environment_blur: f32,
    /// For modes that accumulate: number of this frame since the picture changed.
    pub sample_index: u32,
    /// For modes that accumulate: paths a pixel in each frame.
    pub sample_count: u32,
}

/// A light, in world space. `SET_FRAME`, `BINDING_LIGHTS`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Light {
    /// World position (point, spot).
    pub position_ws: [f32; 3],
    /// `LIGHT_*`.
    pub kind: u32,
    /// Where the light shines to, unit (directional, spot).
    pub direction_ws: [f32; 3],
    /// Distance at which it ends, meters; 0 is without end.
    pub range: f32,
    /// Linear RGB times candela (point, spot), lux (directional) or radiance (rectangle).
    pub intensity: [f32; 3],
    /// Spot: cosine of the angle where the falloff starts.
    pub cos_inner: f32,
    /// Spot: cosine of the angle where it ends.
    pub cos_outer: f32,
    /// Rectangle: from its center to the middle of one edge, meters.
    pub half_x_ws: [f32; 3],
    /// Rectangle: from its center to the middle of a neighboring edge, meters.
    pub half_y_ws: [f32; 3],
}

/// A material's numbers. `SET_MATERIAL`, `BINDING_MATERIAL`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Material {
    /// Linear RGBA factor.
    pub base_color_factor: [f32; 4],
    /// Linear RGB factor, KHR_materials_emissive_strength multiplied in.
    pub emissive_factor: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic_factor: f32,
    /// Perceptual roughness 0..1.
    pub roughness_factor: f32,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// 0 no occlusion .. 1 as in the texture.
    pub occlusion_strength: f32,
    /// ALPHA_MASK: below this a fragment is discarded.
    pub alpha_cutoff: f32,
    /// Bit `TEXTURE_*`: the texture exists (else a default one is bound).
    pub texture_mask: u32,
    /// Bit `TEXTURE_*`: the texture reads TEXCOORD_1.
    pub uv1_mask: u32,
    /// Index of the material, for the id view.
    pub id: u32,
    /// Clear coat factor 0..1.
    pub clearcoat_factor: f32,
    /// Perceptual roughness of the clear coat.
    pub clearcoat_roughness: f32,
    /// Scale of the clear coat normal texture's x and y.
    pub clearcoat_normal_scale: f32,
    /// Anisotropy strength 0..1.
    pub anisotropy_strength: f32,
    /// Cosine and sine of the anisotropy's rotation from the tangent towards the bitangent.
    pub anisotropy_rotation: [f32; 2],
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
    /// Linear RGB.
    pub sheen_color: [f32; 3],
    /// KHR_materials_specular: weight of the dielectric's specular reflection, 0..1.
    pub specular_factor: f32,
    /// Linear RGB, tints the dielectric's F0; specular-glossiness: F0 itself.
    pub specular_color: [f32; 3],
    /// Index of refraction, at least 1; 0 stands for infinity.
    pub ior: f32,
    /// Iridescence factor 0..1.
    pub iridescence_factor: f32,
    /// Index of refraction of the thin film.
    pub iridescence_ior: f32,
    /// Thickness of the film where its texture is 0 and 1, nanometers.
    pub iridescence_thickness_nm: [f32; 2],
    /// Transmission factor 0..1.
    pub transmission_factor: f32,
    /// Thickness of the volume beneath the surface, meters in object space; 0 is a thin wall.
    pub thickness: f32,
    /// Color that white light has after `attenuation_distance`.
    pub attenuation_color: [f32; 3],
    /// Meters; infinite without attenuation.
    pub attenuation_distance: f32,
    /// KHR_materials_dispersion: 20 / Abbe number.
    pub dispersion: f32,
    /// Part of the diffuse light that is transmitted, 0..1.
    pub diffuse_transmission_factor: f32,
    /// Linear RGB.
    pub diffuse_transmission_color: [f32; 3],
    /// Real part of the metal's index of refraction at about 650, 550 and 450 nm.
    pub conductor_n: [f32; 3],
    /// Imaginary part (extinction), positive.
    pub conductor_k: [f32; 3],
    /// KHR_texture_transform of each texture: columns of a mat3x2 applied to (u, v, 1).
    pub uv_from_texture: [[[f32; 2]; 3]; TEXTURE_COUNT],
}

/// Push constants of one draw. Vertices are read by address (`buffer_reference`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Draw {
    /// Device address of the first [`Vertex`].
    pub vertices: u64,
    /// Columns of the object-to-world matrix, without the last row.
    pub world_from_object: [[f32; 3]; 4],
    /// Inverse transpose of its upper 3x3.
    pub normal_ws_from_object: [[f32; 3]; 3],
    /// `ATTRIBUTE_*` bits of the mesh.
    pub attributes: u32,
    /// Index of the primitive, for the id views.
    pub primitive_id: u32,
    /// Index of the node, for the id views.
    pub node_id: u32,
}

/// What one compute dispatch works on. `SET_TASK`, `BINDING_TASK`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Task {
    /// Width and height of what is written: texels, or columns and rows of `BINDING_RESULTS`.
    pub size: [u32; 2],
    /// Mip level that is written.
    pub level: u32,
    /// How many levels the image has.
    pub levels: u32,
    /// Samples for each texel or result.
    pub samples: u32,
    /// What radiance is multiplied by to fit into half floats.
    pub radiance_scale: f32,
    /// Roughness of the first row.
    pub roughness_first: f32,
    /// Roughness of the last row.
    pub roughness_last: f32,
    /// Angle to the normal of the first column, degrees.
    pub theta_first: f32,
    /// Angle to the normal of the last column, degrees.
    pub theta_last: f32,
    /// Linear RGB of the measured surface.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
}

/// A vertex as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Vertex {
    /// Object space, meters.
    pub position: [f32; 3],
    /// Object space, unit.
    pub normal: [f32; 3],
    /// Object space, unit; w is the bitangent's sign.
    pub tangent: [f32; 4],
    /// TEXCOORD_0, or 0.
    pub uv0: [f32; 2],
    /// TEXCOORD_1, or `uv0`.
    pub uv1: [f32; 2],
    /// COLOR_0, linear RGBA, or 1.
    pub color: [f32; 4],
}

const _: () = assert!(size_of::<Draw>() <= PUSH_CONSTANT_SIZE as usize);
