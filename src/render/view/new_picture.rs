//! The picture that a view begins, and one whose model is being drawn in parts.

use glam::Mat4;

use super::declared::DeclaredPasses;
use crate::gpu::Rect;
use crate::render::bound_frame::BoundFrame;

/// A picture that a view begins.
#[derive(Clone, Copy)]
pub(super) struct NewPicture {
    /// [`View::cameras`].
    pub(super) cameras: [Mat4; 2],
    /// The number of its frame in the accumulation buffer.
    pub(super) sample_index: u32,
}

/// A picture whose model is being drawn in parts.
pub(super) struct InParts {
    pub(super) frame: BoundFrame,
    pub(super) new: NewPicture,
    /// How many rows of the model are drawn.
    pub(super) rows: u32,
}

impl InParts {
    /// Whether these are the parts of a frame's next picture.
    pub(super) fn is_of(&self, frame: &BoundFrame) -> bool {
        self.frame.is_same(frame)
    }

    /// Whether the model is drawn.
    pub(super) fn is_whole(&self) -> bool {
        self.rows >= self.frame.state.size.1
    }
}

/// The rectangle that a frame's stages take for that of the picture, if its output is at `at`.
pub(super) fn picture_rect(frame: &BoundFrame, (x, y): (u32, u32)) -> Rect {
    let (width, height) = frame.state.size;
    let at_output = Rect { x, y, width, height };
    if DeclaredPasses::has_display_passes(frame) { Rect { x: 0, y: 0, ..at_output } } else { at_output }
}
