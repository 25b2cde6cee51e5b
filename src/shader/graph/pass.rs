//! A pass in its place in the graph, and what it reads.

use std::collections::BTreeMap;

use serde::Serialize;

use super::pre_rasterization::PreRasterization;
use super::textures::TextureKind;
use crate::interface::StageRole;
use crate::shader::annotation::PATHS_STAGE;
use crate::shader::annotation::pass::{MODEL, PassDesc};

/// The resource that a pass reads or writes at a binding of `interface::SET_PASS`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Input {
    /// The picture before this pass.
    Picture,
    /// The samples of the picture's pixels.
    Samples,
    /// Color of the opaque scene, with mip levels, which transmissive surfaces look up (`behind` in GLSL).
    OpaqueScene,
    /// Depth of the last layer of blended surfaces, with one sample per pixel or several.
    Peeled,
    /// Depth of the model: 1 near, 0 at infinity or where there is nothing.
    Depth,
    /// The image of another pass.
    Image(String),
    /// The image of a pass one frame ago.
    Before(String),
    /// A texture of the tree, as the kind that the stage declares.
    Texture(String, TextureKind),
    /// The image of this pass, written by a compute shader.
    Output,
    /// A storage buffer that all passes share by the name of its block, with its size in bytes, and whether the stage may write it. It
    /// lasts from frame to frame.
    Buffer(String, u32, bool),
    /// The block `Pass` of pass.glsl and toy.glsl: its size in bytes, and its members with their offsets.
    Pass(u32, Vec<(u32, String)>),
    /// The pass's own uniform block: its size in bytes, and its members with their offsets.
    Parameters(u32, Vec<(u32, String)>),
}

/// Inputs by their binding in `interface::SET_PASS`.
pub type Inputs = BTreeMap<u32, Input>;

/// The phase of a frame in which a pass is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RenderPhase {
    /// Before the model, which reads its image.
    BeforeModel,
    /// The model and the background.
    Model,
    /// The depth of the next layer of blended surfaces.
    Peel,
    /// One color from the samples of each pixel.
    Resolve,
    /// The mean of all frames.
    Mean,
    /// Between the model and the tone map: the picture is linear light.
    #[default]
    Light,
    /// The tone map.
    Tonemap,
    /// After the tone map: the picture is as the display shows it.
    Display,
}

/// A pass in its place in the graph.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct GraphPass {
    /// The parsed `//@pass`.
    pub desc: PassDesc,
    /// Whether its stage is a compute shader. Otherwise it is a fragment shader over the whole image.
    pub is_compute: bool,
    /// The stages before the rasterizer, of a pass that is no compute pass.
    pub pre_rasterization: PreRasterization,
    /// When it is drawn.
    pub phase: RenderPhase,
    /// The images, textures and buffers that it reads and writes.
    pub inputs: Inputs,
    /// Invocations of a workgroup, of a compute pass.
    pub local_size: [u32; 3],
    /// Whether its image may change while the settings do not: it reads the previous frame, a buffer, or the clock in the block
    /// `Pass`. The clock in the block `Frame` does not count: the compiled modules tell which pipelines read that.
    pub moves: bool,
}

impl GraphPass {
    /// The name of the pass and its image.
    pub fn name(&self) -> &str {
        &self.desc.name
    }

    /// The paths of its stages, in the order in which they run.
    pub fn stages(&self) -> impl Iterator<Item = &str> {
        let pre_rasterization = (!self.is_compute).then(|| self.pre_rasterization.stages());
        pre_rasterization.into_iter().flatten().chain([self.desc.stage.as_str()])
    }

    /// The purpose that its stages are run for.
    pub fn role(&self) -> StageRole {
        match () {
            () if self.is_compute => StageRole::Compute,
            () if self.desc.quads => StageRole::Quads,
            () if self.desc.stage == PATHS_STAGE => StageRole::Paths,
            () if self.desc.model.is_some() => StageRole::Model,
            () => StageRole::Screen,
        }
    }

    /// Whether this is its name or that of one of its images.
    pub fn is_called(&self, name: &str) -> bool {
        self.name() == name || self.desc.draws(name)
    }

    /// Whether the user can switch it on and off.
    pub fn has_switch(&self) -> bool {
        self.desc.watches.is_none() && (self.desc.name == MODEL || !self.desc.is_built_in())
    }

    /// Whether it draws the model to the picture besides the model's own pass.
    pub fn adds_to_model(&self) -> bool {
        self.phase == RenderPhase::Model && self.desc.model.is_some() && !self.desc.is_built_in()
    }

    /// Whether its own uniform block has a member of this name.
    pub fn has_parameter(&self, name: &str) -> bool {
        self.inputs.values().any(|input| match input {
            Input::Parameters(_, members) => members.iter().any(|(_, member)| member == name),
            _ => false,
        })
    }

    /// Whether it makes a displayed picture without reading the one before.
    pub fn covers(&self) -> bool {
        let reads_picture = || self.inputs.values().any(|input| *input == Input::Picture);
        self.desc.to_picture() && self.phase == RenderPhase::Display && !reads_picture()
    }

    /// Whether the user wants the pass. `switched`: the passes that she switched on or off, by name.
    pub fn is_wanted(&self, switched: &BTreeMap<String, bool>) -> bool {
        switched.get(self.name()).copied().unwrap_or(self.desc.on)
    }
}
