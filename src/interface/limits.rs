//! Numbers of the contract: its version, descriptor sets, sizes and counts.

/// Version of the contract. It increases whenever a shader tree for the previous version would misread memory, or lack a stage.
pub const VERSION: u32 = 11;

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

/// The largest variable of an invocation, bytes.
pub const LARGEST_VARIABLE: u64 = 256 << 10;

/// Size in bytes of the author's parameter block `Params`, whose members have `//@ui` annotations.
pub const PARAMS_SIZE: u32 = 4096;

/// Maximum number of suns of an environment map that light the scene as directional lights.
pub const MAX_SUNS: usize = 4;

/// Number of colors in `Frame::colormap`.
pub const COLORMAP_STEPS: usize = 17;

/// Number of lights whose view of the model is in the block [`Frame`](super::Frame).
pub const MAX_LIGHT_VIEWS: usize = 16;

/// First id of the author's specialization constants (`//@ui` on a `constant_id`).
pub const USER_CONSTANTS: u32 = 32;
