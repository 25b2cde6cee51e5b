//! The contract between Rust and GLSL: descriptor sets, bindings, specialization ids and the structs that both sides use.
//!
//! Rust writes this memory, so Rust declares it. [`glsl`] prints the contract as `shaders/interface.glsl`, and
//! `shader::contract` checks every compiled stage against [`BINDINGS`], [`SPECIALIZATION`] and [`blocks`].
//!
//! All blocks use `scalar` layout, so a Rust `#[repr(C)]` struct of 4-byte fields and its GLSL twin agree byte for byte.
//!
//! Pipeline layouts are fixed by the contract, so a reload never changes one. A shader may use any subset of what is
//! bound for it. A tree whose `interface.glsl` is of another version is refused by name. The test
//! `interface_glsl_is_current` compares the printed file with the committed one.

mod access;
mod blocks;
mod constants;
mod material;
mod print;

use std::mem::offset_of;
use std::ops::Range;

pub use access::{Resource, StageRole, table as access_table};
pub use blocks::{
    Block, BvhNode, Draw, EnvironmentCell, Frame, Light, Member, Task, TracedCorners, TracedMaterial, TracedTriangle,
    Vertex,
};
use blocks::{FRAME_BLOCKS, OTHER_BLOCKS};
pub use constants::*;
pub use material::*;
pub use print::glsl;

/// Every struct of the contract, in the order in which GLSL needs them.
pub fn blocks() -> impl Iterator<Item = &'static Block> {
    FRAME_BLOCKS.iter().chain(MATERIAL_BLOCKS).chain(OTHER_BLOCKS)
}

/// The struct of this name.
pub fn block(name: &str) -> Option<&'static Block> {
    blocks().find(|block| block.name == name)
}

/// Name and value of every constant that GLSL compares with.
pub fn constants() -> impl Iterator<Item = (&'static str, u32)> {
    MODE_CONSTANTS.iter().chain(MATERIAL_CONSTANTS).chain(OTHER_CONSTANTS).copied()
}

/// Version of the contract. It increases whenever a shader tree for the previous version would misread memory.
pub const VERSION: u32 = 9;

/// Set 0: bound once per frame.
pub const SET_FRAME: u32 = 0;
/// Set 1: bound once per material.
pub const SET_MATERIAL: u32 = 1;
/// Set 2: the images and buffers that a stage declares by name. It has no bindings in the contract.
pub const SET_PASS: u32 = 2;
/// The first binding in [`SET_PASS`] of a vertex stage. Those of tessellation control, tessellation evaluation, geometry, task and
/// mesh stages begin at two to six times this number, those of other stages at 0, so that the stages of a pipeline share a set.
pub const VERTEX_BINDINGS: u32 = 256;
/// Set 3: the inputs and outputs of a compute task.
pub const SET_TASK: u32 = 3;

/// Bytes of push constants of every graphics pipeline: the minimum that Vulkan guarantees, and lavapipe's limit.
pub const PUSH_CONSTANT_SIZE: u32 = 128;
/// Size in bytes of the author's parameter block `Params`, whose members have `//@ui` annotations.
pub const PARAMS_SIZE: u32 = 4096;

/// Maximum number of suns of an environment map that light the scene as directional lights.
pub const MAX_SUNS: usize = 4;

/// Maximum number of lights in a frame: as many as fit into 16 KiB, the uniform block size that Vulkan guarantees, with the suns of
/// the environment after them.
pub const MAX_LIGHTS: usize = 16384 / size_of::<Light>() - MAX_SUNS;

/// Number of colors in `Frame::colormap`.
pub const COLORMAP_STEPS: usize = 17;

/// Number of lights whose view of the model is in the block [`Frame`].
pub const MAX_LIGHT_VIEWS: usize = 16;

/// First id of the author's specialization constants (`//@ui` on a `constant_id`).
pub const USER_CONSTANTS: u32 = 32;

/// Kind of a descriptor, in GLSL's terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// `uniform` block.
    UniformBuffer,
    /// `buffer` block.
    StorageBuffer,
    /// `sampler2D`.
    Sampler2D,
    /// `sampler2DArray`.
    Sampler2DArray,
    /// `samplerCube`.
    SamplerCube,
    /// `rgba16f image2DArray`: one mip level of an image with all its layers.
    StorageImage,
}

impl BindingKind {
    /// The GLSL spelling, for messages.
    pub fn glsl(self) -> &'static str {
        match self {
            Self::UniformBuffer => "uniform block",
            Self::StorageBuffer => "buffer block",
            Self::Sampler2D => "sampler2D",
            Self::Sampler2DArray => "sampler2DArray",
            Self::SamplerCube => "samplerCube",
            Self::StorageImage => "rgba16f image2DArray",
        }
    }
}

/// Sets and bindings of the buffer that Specula adds to a stage with loops that might not end: see `shader::spirv::loops`.
/// Compute stages have it in [`SET_TASK`], the others in [`SET_FRAME`].
pub const LOOPS: [(u32, u32); 2] = [(SET_FRAME, BINDING_LOOPS), (SET_TASK, BINDING_TASK_LOOPS)];

/// The bytes of [`Frame`] that change while the time runs.
pub const CLOCK: [Range<usize>; 7] = [
    offset_of!(Frame, time_s)..offset_of!(Frame, time_s) + size_of::<f32>(),
    offset_of!(Frame, delta_s)..offset_of!(Frame, delta_s) + size_of::<f32>(),
    offset_of!(Frame, frame_index)..offset_of!(Frame, frame_index) + size_of::<u32>(),
    offset_of!(Frame, mouse_px)..offset_of!(Frame, mouse_px) + size_of::<[f32; 4]>(),
    offset_of!(Frame, cursor_px)..offset_of!(Frame, cursor_px) + size_of::<[f32; 2]>(),
    offset_of!(Frame, mouse_buttons)..offset_of!(Frame, mouse_buttons) + size_of::<u32>(),
    offset_of!(Frame, date)..offset_of!(Frame, date) + size_of::<[f32; 4]>(),
];

/// The bytes of [`Frame`] that change when a key is pressed or released.
pub const KEYS: Range<usize> = offset_of!(Frame, keys)..offset_of!(Frame, keys) + size_of::<[u32; 24]>();

/// The bytes of [`Frame`] that tell how the camera has moved.
pub const MOTION: Range<usize> =
    offset_of!(Frame, clip_from_world_before)..offset_of!(Frame, clip_from_world_before) + size_of::<[[f32; 4]; 4]>();

/// One descriptor of the contract. A shader may use any subset.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Descriptor set.
    pub set: u32,
    /// Binding within the set.
    pub binding: u32,
    /// The constant's name in GLSL, `BINDING_...`.
    pub name: &'static str,
    /// The kind of resource bound there.
    pub kind: BindingKind,
    /// For blocks: the largest size in bytes that a shader may declare.
    pub size: u32,
    /// The group of resources that it is bound with; `None` for a descriptor that no shader of a tree reads.
    pub resource: Option<Resource>,
}

/// Every descriptor of the contract.
pub const BINDINGS: &[Binding] = &{
    let mut all = [OTHER_BINDINGS[0]; OTHER_BINDINGS.len() + TEXTURE_COUNT];
    let mut at = 0;
    while at < all.len() {
        let others = OTHER_BINDINGS.len();
        all[at] = if at < others { OTHER_BINDINGS[at] } else { TEXTURES[at - others].binding };
        at += 1;
    }
    all
};

/// Bytes of the block of lights and suns.
pub(crate) const LIGHT_BYTES: usize = (MAX_LIGHTS + MAX_SUNS) * size_of::<Light>();

/// Declares bindings as constants and as a table. A row is `NAME = set, binding, kind(size), resource`; `size`: the largest in bytes that a
/// shader may declare.
macro_rules! bindings {
    ($($(#[doc = $doc:literal])+ $name:ident = $set:ident, $binding:literal, $kind:ident($($size:expr)?), $resource:expr;)+) => {
        $($(#[doc = $doc])+ pub const $name: u32 = $binding;)+

        /// Every descriptor that is not a material's texture.
        const OTHER_BINDINGS: &[Binding] = &[$(Binding {
            set: $set,
            binding: $binding,
            name: stringify!($name),
            kind: BindingKind::$kind,
            size: 0 $(+ $size as u32)?,
            resource: $resource,
        },)+];
    };
}

bindings! {
    /// The block [`Frame`].
    BINDING_FRAME = SET_FRAME, 0, UniformBuffer(size_of::<Frame>()), Some(Resource::Frame);
    /// The lights. They are a uniform block because a software device reads a storage buffer separately for each pixel of a group.
    BINDING_LIGHTS = SET_FRAME, 1, UniformBuffer(LIGHT_BYTES), Some(Resource::Lights);
    /// The author's parameters.
    BINDING_PARAMS = SET_FRAME, 2, UniformBuffer(PARAMS_SIZE), Some(Resource::Params);
    /// The environment's cube map.
    BINDING_ENVIRONMENT = SET_FRAME, 3, SamplerCube(), Some(Resource::Environment);
    /// The environment's prefiltered radiance.
    BINDING_PREFILTERED = SET_FRAME, 4, Sampler2D(), Some(Resource::Environment);
    /// The environment's radiance, prefiltered for sheen.
    BINDING_PREFILTERED_SHEEN = SET_FRAME, 5, SamplerCube(), Some(Resource::Environment);
    /// The environment's irradiance.
    BINDING_IRRADIANCE = SET_FRAME, 6, Sampler2D(), Some(Resource::Environment);
    /// Directional albedo of the BRDF.
    BINDING_DFG = SET_FRAME, 7, Sampler2D(), Some(Resource::Tables);
    /// Linearly transformed cosines, for rectangular lights.
    BINDING_LTC = SET_FRAME, 8, Sampler2D(), Some(Resource::Tables);
    /// The measured BRDF.
    BINDING_MEASURED = SET_FRAME, 9, StorageBuffer(), Some(Resource::Tables);
    /// Directional albedo of the sheen.
    BINDING_SHEEN_ALBEDO = SET_FRAME, 10, Sampler2D(), Some(Resource::Tables);
    /// Works around a crash of Mesa's lavapipe (22.3), which records the uniforms that branches depend on and overwrites its
    /// own counters with those of a stage's fourth uniform block. So the fourth block is this one, which nothing reads.
    BINDING_UNUSED = SET_FRAME, 11, UniformBuffer(16_u32), None;
    /// Directional albedo of the diffuse lobe.
    BINDING_DIFFUSE_ALBEDO = SET_FRAME, 12, Sampler2D(), Some(Resource::Tables);
    /// Two channels of [`BINDING_DFG`], for lamps: a software device reads them in two thirds of the time that four take.
    BINDING_LAMP_DFG = SET_FRAME, 13, Sampler2D(), Some(Resource::Tables);
    /// The bounding volume hierarchy that random paths trace.
    BINDING_BVH = SET_FRAME, 14, StorageBuffer(), Some(Resource::Scene);
    /// The triangles that random paths can hit.
    BINDING_TRACED_TRIANGLES = SET_FRAME, 15, StorageBuffer(), Some(Resource::Scene);
    /// Attributes at the corners of these triangles.
    BINDING_TRACED_CORNERS = SET_FRAME, 16, StorageBuffer(), Some(Resource::Scene);
    /// Their materials.
    BINDING_TRACED_MATERIALS = SET_FRAME, 17, StorageBuffer(), Some(Resource::Scene);
    /// The textures of these materials.
    BINDING_TRACED_TEXTURES = SET_FRAME, 18, Sampler2DArray(), Some(Resource::Scene);
    /// The environment's cells, as an alias table.
    BINDING_ENVIRONMENT_CELLS = SET_FRAME, 19, StorageBuffer(), Some(Resource::Scene);
    /// What loops of a graphics stage report: see [`LOOPS`].
    BINDING_LOOPS = SET_FRAME, 20, StorageBuffer(), None;
    /// The block [`Material`].
    BINDING_MATERIAL = SET_MATERIAL, 0, UniformBuffer(size_of::<Material>()), Some(Resource::Material);
    /// The block [`Task`].
    BINDING_TASK = SET_TASK, 0, UniformBuffer(size_of::<Task>()), Some(Resource::Task);
    /// The image that a task reads.
    BINDING_SOURCE = SET_TASK, 1, Sampler2D(), Some(Resource::Task);
    /// The cube map that a task reads.
    BINDING_SOURCE_CUBE = SET_TASK, 2, SamplerCube(), Some(Resource::Task);
    /// The mip level that a task writes.
    BINDING_TARGET = SET_TASK, 3, StorageImage(), Some(Resource::Task);
    /// A mip level that a task reads.
    BINDING_LEVEL_ABOVE = SET_TASK, 4, StorageImage(), Some(Resource::Task);
    /// The buffer that a task writes numbers to. It is as large as the stages declare.
    BINDING_RESULTS = SET_TASK, 5, StorageBuffer(), Some(Resource::Task);
    /// The samples of a pair of specular levels, for the task that chooses them.
    BINDING_LOBE_TARGET = SET_TASK, 6, StorageBuffer(), Some(Resource::Task);
    /// The same samples, for the task that reads them. 16 KiB is the largest uniform block that every device has.
    BINDING_LOBE = SET_TASK, 7, UniformBuffer(16384_u32), Some(Resource::Task);
    /// The small lights of an environment, for the tasks that read them.
    BINDING_SMALL_LIGHTS = SET_TASK, 9, UniformBuffer(16384_u32), Some(Resource::Task);
    /// The texels that a task writes with a shared exponent, a word each.
    BINDING_PACKED = SET_TASK, 10, StorageBuffer(), Some(Resource::Task);
    /// What loops of a task report: see [`LOOPS`].
    BINDING_TASK_LOOPS = SET_TASK, 8, StorageBuffer(), None;
}

/// A specialization constant that Rust sets.
#[derive(Clone, Copy, Debug)]
pub struct Specialization {
    /// `constant_id`.
    pub id: u32,
    /// Name in GLSL.
    pub name: &'static str,
    /// Its meaning.
    pub doc: &'static str,
}

/// `constant_id` of the debug mode.
pub const SPEC_MODE: u32 = 0;
/// Value of [`SPEC_MODE`] for the final picture. The shader tree defines all other modes.
pub const MODE_FINAL: u32 = 0;
/// `constant_id` of the material's alpha mode: [`ALPHA_OPAQUE`], [`ALPHA_MASK`] or [`ALPHA_BLEND`].
pub const SPEC_ALPHA_MODE: u32 = 1;
/// `constant_id` of the material's features: the `FEATURE_*` bits.
pub const SPEC_FEATURES: u32 = 2;

/// `constant_id` of the tone map, `TONEMAP_*` in common/tonemap.glsl or [`TONEMAP_OFF`]; for the tone mapping pass.
pub const SPEC_TONEMAP: u32 = 3;
/// `constant_id` of the encoding, `ENCODE_*`; for the tone mapping pass.
pub const SPEC_ENCODE: u32 = 4;

/// `constant_id` of the number of lights, up to [`UNROLLED_LIGHTS`]. 0 means that `Frame::light_count` has the number.
pub const SPEC_LIGHT_COUNT: u32 = 5;
/// Up to this many lights, a pipeline is specialized for their number, so that the loop over them is unrolled.
pub const UNROLLED_LIGHTS: usize = 4;

/// `constant_id` of whether the display maps values by range, channels or colormap; for the tone mapping pass.
pub const SPEC_MAPS_VALUES: u32 = 6;

/// `constant_id` of the number of suns of the environment, up to [`MAX_SUNS`].
pub const SPEC_SUN_COUNT: u32 = 7;

/// `constant_id` of the samples of a pixel; for the pass that makes one color from them.
pub const SPEC_SAMPLES: u32 = 8;

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
    Specialization {
        id: SPEC_MAPS_VALUES,
        name: "MAPS_VALUES",
        doc: "not 0: the display maps values by range, channels or colormap",
    },
    Specialization {
        id: SPEC_SUN_COUNT,
        name: "SUN_COUNT",
        doc: "suns of the environment, which its irradiance and specular levels leave out",
    },
    Specialization { id: SPEC_SAMPLES, name: "SAMPLES", doc: "samples of a pixel; for the pass with to=resolve" },
];
