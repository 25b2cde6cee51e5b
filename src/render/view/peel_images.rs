//! The depth images with which blended surfaces are sorted in each pixel: see `peeling.rs`.

use std::sync::Arc;

use super::declared::{DeclaredPasses, FrameImages, PassContext, PassSets};
use super::targets::Targets;
use crate::gpu::{GpuError, Image};

/// The depth images of the last layer and the next one, and the sets to read them.
pub(super) struct PeelImages<'a> {
    pub(super) layers: &'a [Arc<Image>; 2],
    /// To read the depth of the opaque scene, and that of each image.
    pub(super) sets: [PassSets; 3],
}

impl<'a> PeelImages<'a> {
    /// Those of a frame; `None` if it does not sort blended surfaces in each pixel.
    ///
    /// # Errors
    /// Out of memory.
    pub(super) fn new(
        declared: &mut DeclaredPasses,
        context: &PassContext<'_>,
        targets: &'a Targets,
    ) -> Result<Option<Self>, GpuError> {
        let Some(layers) = &targets.peeled else { return Ok(None) };
        let mut sets = |image: &Arc<Image>| {
            let images = FrameImages { peeled: Some(image), ..FrameImages::default() };
            declared.sets_of(context, &images, context.frame.state.pipelines.peel_keys())
        };
        let sets = [sets(&targets.depth)?, sets(&layers[0])?, sets(&layers[1])?];
        Ok(Some(Self { layers, sets }))
    }
}

/// The depth target of a part of the draws.
pub(super) struct PeelTarget<'a> {
    pub(super) depth: &'a Arc<Image>,
    /// Clears it to this value; `None` keeps its content.
    pub(super) clear_depth: Option<f32>,
    /// Whether the draws write color; otherwise they have the first color target alone.
    pub(super) is_shaded: bool,
}
