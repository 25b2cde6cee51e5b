//! The state that a view keeps for the declared passes, and the arguments of a frame.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::blocks::Blocks;
use super::images::Images;
use super::sets::Sets;
use crate::gpu::{DescriptorSet, Gpu, Image, Sampler, SetLayouts};
use crate::interface::Frame;
use crate::render::bound_frame::BoundFrame;
use crate::render::scene::PlacedScene;
use crate::shader::graph::TextureKind;

/// Draws the declared passes of a view, and keeps their images, buffers and descriptor sets between frames.
pub(in crate::render::view) struct DeclaredPasses {
    pub(super) gpu: Arc<Gpu>,
    pub(super) layouts: Arc<SetLayouts>,
    /// Interpolates between texels and between levels.
    pub(super) linear: Arc<Sampler>,
    pub(super) nearest: Arc<Sampler>,
    /// Reads as 0. Replaces a missing image, such as that of a pass that is switched off.
    pub(super) blank: Arc<Image>,
    /// Replaces missing textures, by their kind.
    pub(super) blanks: BTreeMap<TextureKind, Arc<Image>>,
    /// Descriptor set 3, through which compute stages report endless loops.
    pub(super) task_set: Arc<DescriptorSet>,
    pub(super) images: Images,
    pub(super) sets: Sets,
    /// The HDR image after the passes before the tone map, or the image of the shown pass.
    pub(super) picture: Option<Arc<Image>>,
    /// The LDR output, after the passes that follow the tone map.
    pub(super) display: Option<Arc<Image>>,
}

/// The arguments of a frame's passes.
pub(in crate::render::view) struct PassContext<'a> {
    pub(in crate::render::view) frame: &'a BoundFrame,
    /// The model in the pose of the frame.
    pub(in crate::render::view) placed: Option<&'a Arc<PlacedScene>>,
    pub(in crate::render::view) frame_set: &'a Arc<DescriptorSet>,
    pub(in crate::render::view) blocks: &'a Blocks,
    /// The content of the block `Frame`.
    pub(in crate::render::view) constants: &'a Frame,
    /// Depth of the model, one sample a pixel.
    pub(in crate::render::view) depth: Option<&'a Arc<Image>>,
}
