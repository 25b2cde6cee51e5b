//! Resources for the other picture of a comparison.

use std::sync::Arc;

use super::last_complete::LastComplete;
use crate::frame::FrameState;
use crate::picture_difference::{Picture, Still};
use crate::pipeline::PipelineSet;
use crate::threads::second_tree::SecondTree;
use crate::threads::worker::Snapshot;

/// Resources for the picture that `state.compare.with` names. A version needs nothing else than its pipelines.
#[derive(Default)]
pub(in crate::app) enum Compared {
    #[default]
    Nothing,
    Kept(Box<LastComplete>),
    File(ScaledPicture),
    Tree(Box<TreePicture>),
}

/// A picture from a file, and the same scaled to the size of the view.
pub(in crate::app) struct ScaledPicture {
    pub(in crate::app) picture: Arc<Picture>,
    /// The number of the request that has read it.
    pub(in crate::app) number: u64,
    /// The newest scaled picture, with the number of the request that made it.
    pub(in crate::app) still: Option<(u64, Arc<Still>)>,
    /// [`Self::number`] and the size for which `still` was made, or for which scaling failed.
    pub(in crate::app) scaled: Option<(u64, (u32, u32))>,
    /// The number of the scaling that is under way.
    pub(in crate::app) scaling: Option<u64>,
}

/// The picture of a second shader tree.
pub(in crate::app) struct TreePicture {
    pub(in crate::app) tree: SecondTree,
    /// The pipelines of its last good shaders.
    pub(in crate::app) set: Option<Arc<PipelineSet>>,
    /// Its last frame from the thread, with its own light.
    pub(in crate::app) like: Option<LastComplete>,
    /// The frame that the thread was last asked for.
    pub(in crate::app) asked: Option<LastAsked>,
}

/// The inputs of a picture that the thread was asked for.
pub(in crate::app) struct LastAsked {
    /// A picture without resources.
    pub(in crate::app) state: Arc<FrameState>,
    pub(in crate::app) snapshot: Snapshot,
}

impl LastAsked {
    /// Whether a frame needs the same resources.
    pub(in crate::app) fn has_needs_of(&self, state: &FrameState) -> bool {
        let asked = &*self.state;
        Arc::ptr_eq(&asked.shaders, &state.shaders)
            && asked.pipelines == state.pipelines
            && match (&asked.scene, &state.scene) {
                (Some(asked), Some(scene)) => asked.has_same_draws(scene),
                (asked, scene) => asked.is_none() && scene.is_none(),
            }
            && asked.environment == state.environment
            && asked.tables == state.tables
            && asked.measured == state.measured
    }
}
