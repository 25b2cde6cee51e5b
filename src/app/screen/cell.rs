//! A mode of the grid beside the selected one.

use std::sync::Arc;

use crate::app::engine::last_complete::LastComplete;
use crate::app::state::grid::PictureRect;
use crate::gpu::Image;
use crate::render::View;

/// A mode beside the picture.
pub(super) struct Cell {
    pub(super) mode: String,
    pub(super) rect: PictureRect,
    pub(super) view: View,
    pub(super) image: Arc<Image>,
    /// The last complete frame; `None` until the pipelines are ready.
    pub(super) shown: Option<LastComplete>,
}
