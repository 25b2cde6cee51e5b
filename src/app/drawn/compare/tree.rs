//! The picture of a second shader tree, as a comparison shows it.

use std::sync::Arc;

use crate::app::drawn::last_complete::LastComplete;
use crate::frame::FrameState;
use crate::pipeline::PipelineSet;
use crate::threads::second_tree::SecondTree;
use crate::threads::worker::Snapshot;

/// The picture of a second shader tree.
pub(in crate::app) struct TreePicture {
    pub(in crate::app) name: String,
    pub(in crate::app) tree: SecondTree,
    /// The pipelines of its last good shaders.
    pub(in crate::app) set: Option<Arc<PipelineSet>>,
    /// Whether its files have errors.
    pub(in crate::app) has_errors: bool,
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
            && asked.scene == state.scene
            && asked.environment == state.environment
            && asked.tables == state.tables
            && asked.measured == state.measured
    }
}

impl TreePicture {
    pub(in crate::app) fn label(&self) -> String {
        match self.has_errors {
            true => format!("{}, before its last edit, which does not compile", self.name),
            false => self.name.clone(),
        }
    }
}
