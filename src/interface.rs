//! The contract between Rust and GLSL: descriptor sets, bindings, specialization ids and the structs that both sides use.
//!
//! Rust writes this memory, so Rust declares it. [`glsl`] prints the contract as `shaders/interface.glsl`, and
//! `shader::contract` checks every compiled stage against [`BINDINGS`], [`SPECIALIZATION`] and [`BLOCKS`].
//!
//! All blocks use `scalar` layout, so a Rust `#[repr(C)]` struct of 4-byte fields and its GLSL twin agree byte for byte.
//!
//! Pipeline layouts are fixed by the contract, so a reload never changes one. A shader may use any subset of what is
//! bound for it. A tree whose `interface.glsl` is of another version is refused by name. The test
//! `interface_glsl_is_current` compares the printed file with the committed one.

mod access;
mod blocks;
mod constants;
mod print;
mod textures;

use std::mem::offset_of;
use std::ops::Range;

pub use access::{Resource, StageRole, table as access_table};
pub use blocks::{
    BLOCKS, Block, BvhNode, Draw, EnvironmentCell, Frame, Light, Material, Member, Task, TracedCorners, TracedMaterial,
    TracedTriangle, Vertex, block,
};
pub use constants::*;
pub use print::glsl;
pub use textures::*;

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

/// Binding in [`SET_FRAME`] of the block [`Frame`].
pub const BINDING_FRAME: u32 = 0;
/// Binding in [`SET_FRAME`] of the lights.
pub const BINDING_LIGHTS: u32 = 1;
/// Binding in [`SET_FRAME`] of the author's parameters.
pub const BINDING_PARAMS: u32 = 2;
/// Binding in [`SET_TASK`] of the buffer that a task writes numbers to. It is as large as the stages declare.
pub const BINDING_RESULTS: u32 = 5;
/// Binding in [`SET_TASK`] of the small lights of an environment, for the tasks that read them.
pub const BINDING_SMALL_LIGHTS: u32 = 9;
/// Binding in [`SET_TASK`] of the texels that a task writes with a shared exponent, a word each.
pub const BINDING_PACKED: u32 = 10;
/// Binding in [`SET_TASK`] of the samples of a pair of specular levels, for the task that chooses them.
pub const BINDING_LOBE_TARGET: u32 = 6;
/// Binding in [`SET_TASK`] of the same samples, for the task that reads them.
pub const BINDING_LOBE: u32 = 7;
/// Binding in [`SET_TASK`] of the block [`Task`].
pub const BINDING_TASK: u32 = 0;
/// Binding in [`SET_TASK`] of the image that a task reads.
pub const BINDING_SOURCE: u32 = 1;
/// Binding in [`SET_TASK`] of the cube map that a task reads.
pub const BINDING_SOURCE_CUBE: u32 = 2;
/// Binding in [`SET_TASK`] of the mip level that a task writes.
pub const BINDING_TARGET: u32 = 3;
/// Binding in [`SET_TASK`] of a mip level that a task reads.
pub const BINDING_LEVEL_ABOVE: u32 = 4;

/// Sets and bindings of the buffer that Specula adds to a stage with loops that might not end: see `shader::spirv::loops`.
/// Compute stages have it in [`SET_TASK`], the others in [`SET_FRAME`].
pub const LOOPS: [(u32, u32); 2] = [(SET_FRAME, 20), (SET_TASK, 8)];

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

const fn binding(
    resource: Resource,
    set: u32,
    binding: u32,
    name: &'static str,
    kind: BindingKind,
    size: usize,
) -> Binding {
    Binding { set, binding, name, kind, size: size as u32, resource: Some(resource) }
}

/// A descriptor that Specula itself adds to stages.
const fn added((set, binding): (u32, u32), name: &'static str, kind: BindingKind, size: usize) -> Binding {
    Binding { set, binding, name, kind, size: size as u32, resource: None }
}

/// Every descriptor of the contract.
pub const BINDINGS: &[Binding] = &{
    let mut all = [OTHERS[0]; OTHERS.len() + TEXTURE_COUNT];
    let mut at = 0;
    while at < all.len() {
        all[at] = if at < OTHERS.len() { OTHERS[at] } else { TEXTURES[at - OTHERS.len()].binding };
        at += 1;
    }
    all
};

/// Bytes of the block of lights and suns.
pub(crate) const LIGHT_BYTES: usize = (MAX_LIGHTS + MAX_SUNS) * size_of::<Light>();

/// Every descriptor that is not a material's texture.
const OTHERS: &[Binding] = &[
    binding(Resource::Frame, SET_FRAME, BINDING_FRAME, "BINDING_FRAME", BindingKind::UniformBuffer, size_of::<Frame>()),
    // Lights are a uniform block because a software device reads a storage buffer separately for each pixel of a group.
    binding(Resource::Lights, SET_FRAME, BINDING_LIGHTS, "BINDING_LIGHTS", BindingKind::UniformBuffer, LIGHT_BYTES),
    binding(
        Resource::Params,
        SET_FRAME,
        BINDING_PARAMS,
        "BINDING_PARAMS",
        BindingKind::UniformBuffer,
        PARAMS_SIZE as usize,
    ),
    binding(Resource::Environment, SET_FRAME, 3, "BINDING_ENVIRONMENT", BindingKind::SamplerCube, 0),
    binding(Resource::Environment, SET_FRAME, 4, "BINDING_PREFILTERED", BindingKind::Sampler2D, 0),
    binding(Resource::Environment, SET_FRAME, 5, "BINDING_PREFILTERED_SHEEN", BindingKind::SamplerCube, 0),
    binding(Resource::Environment, SET_FRAME, 6, "BINDING_IRRADIANCE", BindingKind::Sampler2D, 0),
    binding(Resource::Tables, SET_FRAME, 7, "BINDING_DFG", BindingKind::Sampler2D, 0),
    binding(Resource::Tables, SET_FRAME, 8, "BINDING_LTC", BindingKind::Sampler2D, 0),
    binding(Resource::Tables, SET_FRAME, 9, "BINDING_MEASURED", BindingKind::StorageBuffer, 0),
    binding(Resource::Tables, SET_FRAME, 10, "BINDING_SHEEN_ALBEDO", BindingKind::Sampler2D, 0),
    // Works around a crash of Mesa's lavapipe (22.3), which records the uniforms that branches depend on and overwrites its
    // own counters with those of a stage's fourth uniform block. So the fourth block is this one, which nothing reads.
    added((SET_FRAME, 11), "BINDING_UNUSED", BindingKind::UniformBuffer, 16),
    binding(Resource::Tables, SET_FRAME, 12, "BINDING_DIFFUSE_ALBEDO", BindingKind::Sampler2D, 0),
    // Two channels of BINDING_DFG, for lamps: a software device reads them in two thirds of the time that four take.
    binding(Resource::Tables, SET_FRAME, 13, "BINDING_LAMP_DFG", BindingKind::Sampler2D, 0),
    binding(Resource::Scene, SET_FRAME, 14, "BINDING_BVH", BindingKind::StorageBuffer, 0),
    binding(Resource::Scene, SET_FRAME, 15, "BINDING_TRACED_TRIANGLES", BindingKind::StorageBuffer, 0),
    binding(Resource::Scene, SET_FRAME, 16, "BINDING_TRACED_CORNERS", BindingKind::StorageBuffer, 0),
    binding(Resource::Scene, SET_FRAME, 17, "BINDING_TRACED_MATERIALS", BindingKind::StorageBuffer, 0),
    binding(Resource::Scene, SET_FRAME, 18, "BINDING_TRACED_TEXTURES", BindingKind::Sampler2DArray, 0),
    binding(Resource::Scene, SET_FRAME, 19, "BINDING_ENVIRONMENT_CELLS", BindingKind::StorageBuffer, 0),
    added(LOOPS[0], "BINDING_LOOPS", BindingKind::StorageBuffer, 0),
    binding(Resource::Material, SET_MATERIAL, 0, "BINDING_MATERIAL", BindingKind::UniformBuffer, size_of::<Material>()),
    binding(Resource::Task, SET_TASK, BINDING_TASK, "BINDING_TASK", BindingKind::UniformBuffer, size_of::<Task>()),
    binding(Resource::Task, SET_TASK, BINDING_SOURCE, "BINDING_SOURCE", BindingKind::Sampler2D, 0),
    binding(Resource::Task, SET_TASK, BINDING_SOURCE_CUBE, "BINDING_SOURCE_CUBE", BindingKind::SamplerCube, 0),
    binding(Resource::Task, SET_TASK, BINDING_TARGET, "BINDING_TARGET", BindingKind::StorageImage, 0),
    binding(Resource::Task, SET_TASK, BINDING_LEVEL_ABOVE, "BINDING_LEVEL_ABOVE", BindingKind::StorageImage, 0),
    binding(Resource::Task, SET_TASK, BINDING_RESULTS, "BINDING_RESULTS", BindingKind::StorageBuffer, 0),
    binding(Resource::Task, SET_TASK, BINDING_LOBE_TARGET, "BINDING_LOBE_TARGET", BindingKind::StorageBuffer, 0),
    // 16 KiB is the largest uniform block that every device has.
    binding(Resource::Task, SET_TASK, BINDING_LOBE, "BINDING_LOBE", BindingKind::UniformBuffer, 16384),
    binding(Resource::Task, SET_TASK, BINDING_SMALL_LIGHTS, "BINDING_SMALL_LIGHTS", BindingKind::UniformBuffer, 16384),
    binding(Resource::Task, SET_TASK, BINDING_PACKED, "BINDING_PACKED", BindingKind::StorageBuffer, 0),
    added(LOOPS[1], "BINDING_TASK_LOOPS", BindingKind::StorageBuffer, 0),
];

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
