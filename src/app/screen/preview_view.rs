//! The view that draws previews.

use std::sync::Arc;

use crate::gpu::Image;
use crate::render::tools::Outline;
use crate::render::{BoundFrame, View};

/// The view of previews, the image that it draws to, and the frame.
pub(super) struct Preview {
    pub(super) view: View,
    pub(super) image: Arc<Image>,
    pub(super) frame: BoundFrame,
    /// The frame of the whole picture.
    pub(super) of: BoundFrame,
    pub(super) outline: Option<Outline>,
}

/// The pass that scales a preview.
pub(in crate::app) const ENLARGE: &str = "enlarge";
