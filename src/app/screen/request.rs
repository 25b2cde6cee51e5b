//! The request of a frame, extracted from the state as plain values, and its results.

use std::sync::Arc;

use crate::app::state::adaptive::plan::Plan;
use crate::app::state::workspace::TextureRequest;
use crate::gpu::Image;
use crate::render::tools::{OutlineStyle, Tools};
use crate::render::{BoundFrame, Redraw};

/// The CPU prepares a frame while the device draws the previous one.
pub(super) const FRAMES_IN_FLIGHT: usize = 2;

/// Everything of a frame that has targets already: the picture, what lies over it, and the panels.
pub(in crate::app) struct FrameRequest<'a> {
    pub(in crate::app) frame: Option<&'a BoundFrame>,
    pub(in crate::app) redraw: Redraw,
    /// Whether to show it, or the preview that was prepared in place of it.
    pub(in crate::app) plan: Plan,
    /// The outline of the selection, if there is one to draw.
    pub(in crate::app) outline: Option<OutlineRequest>,
    /// The texture that a panel shows.
    pub(in crate::app) texture: Option<TextureDraw>,
    pub(in crate::app) primitives: &'a [egui::ClippedPrimitive],
    pub(in crate::app) pixels_per_point: f32,
    /// Whether to copy the finished window for a capture.
    pub(in crate::app) copies_window: bool,
}

/// The outline of selected instances.
pub(in crate::app) struct OutlineRequest {
    pub(in crate::app) tools: Arc<Tools>,
    /// Whether each instance of the scene is selected.
    pub(in crate::app) selected: Arc<[bool]>,
    pub(in crate::app) style: OutlineStyle,
}

/// A texture, and how it is shown.
pub(in crate::app) struct TextureDraw {
    pub(in crate::app) tools: Arc<Tools>,
    pub(in crate::app) texture: Arc<Image>,
    pub(in crate::app) request: TextureRequest,
}

/// The result of recording a frame.
#[derive(Default)]
pub(in crate::app) struct Recorded {
    /// Whether memory was short for the grid, which has ended.
    pub(in crate::app) grid_failed: bool,
    /// Why the window could not be copied.
    pub(in crate::app) copy_error: Option<String>,
}
