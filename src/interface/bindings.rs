//! Every binding of the contract, numbered here.

use super::access::Resource;
use super::binding::{Binding, BindingKind};
use super::blocks::{Frame, Light, Task};
use super::limits::{MAX_LIGHT_VIEWS, MAX_SUNS, PARAMS_SIZE, SET_FRAME, SET_MATERIAL, SET_PASS, SET_TASK};
use super::material::{Material, TEXTURE_COUNT, TEXTURES};

/// Maximum number of lights in a frame. A loop with at most so many rounds needs no budget of rounds (`shader::spirv::loops`), and lavapipe
/// ends all loops of an invocation after twice as many.
pub const MAX_LIGHTS: usize = 32_768;

/// Up to this many lights, a loop over all of them reads a uniform block. More lights are in the cells of a grid, from which lavapipe needs
/// as much time for some five lights a pixel as for 40 to 50 of the loop, since it reads a buffer separately for each pixel of a group.
pub const FEW_LIGHTS: usize = 96;
// Lights with a shadow map are the first of many.
const _: () = assert!(FEW_LIGHTS >= MAX_LIGHT_VIEWS);

/// Sets and bindings of the buffer that Specula adds to a stage with loops that might not end: see `shader::spirv::loops`.
/// Compute stages have it in [`SET_TASK`], the others in [`SET_FRAME`].
pub const LOOPS: [(u32, u32); 2] = [(SET_FRAME, BINDING_LOOPS), (SET_TASK, BINDING_TASK_LOOPS)];

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

/// Bytes of the uniform block of few lights and the suns.
pub(crate) const FEW_LIGHT_BYTES: usize = (FEW_LIGHTS + MAX_SUNS) * size_of::<Light>();

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
    /// The lights, if they are few, and the suns. A software device reads a storage buffer separately for each pixel of a group, a uniform
    /// block once.
    BINDING_FEW_LIGHTS = SET_FRAME, 1, UniformBuffer(FEW_LIGHT_BYTES), Some(Resource::Lights);
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
    /// The report of endless loops of a graphics stage: see [`LOOPS`].
    BINDING_LOOPS = SET_FRAME, 20, StorageBuffer(), None;
    /// All lights, and the suns after them.
    BINDING_LIGHTS = SET_FRAME, 21, StorageBuffer(), Some(Resource::Lights);
    /// The [`LightGrid`](super::LightGrid): lists of the lights that reach each cell.
    BINDING_LIGHT_GRID = SET_FRAME, 22, StorageBuffer(), Some(Resource::Lights);
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
    /// The instances whose vertices a task moves, each a `Deformation`.
    BINDING_DEFORMATIONS = SET_TASK, 11, StorageBuffer(), Some(Resource::Deformations);
    /// The report of endless loops of a compute dispatch: see [`LOOPS`].
    BINDING_TASK_LOOPS = SET_TASK, 8, StorageBuffer(), None;
}

impl Resource {
    /// The resource at a place of the contract. `None` for a descriptor that Specula itself adds to stages.
    pub fn at(set: u32, binding: u32) -> Option<Self> {
        if set == SET_PASS {
            return Some(Self::Pass);
        }
        BINDINGS.iter().find(|known| (known.set, known.binding) == (set, binding))?.resource
    }
}
