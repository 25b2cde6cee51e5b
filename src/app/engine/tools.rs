//! The pipelines of outlines and pictures of textures: made on a thread when they are first needed.

use std::sync::Arc;

use crate::render::tools::Tools;

/// The pipelines of outlines and pictures of textures.
#[derive(Default)]
pub(in crate::app) struct ToolsState {
    pub(in crate::app) made: Option<Arc<Tools>>,
    /// Whether they were asked for.
    pub(in crate::app) is_asked: bool,
}
