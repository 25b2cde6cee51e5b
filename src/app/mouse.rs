//! State of the mouse.

use std::time::Instant;

use glam::Vec2;
use winit::keyboard::ModifiersState;

/// State of the mouse.
#[derive(Default)]
pub(super) struct Mouse {
    /// Position in pixels of the window.
    pub(super) at: Vec2,
    /// Whether the mouse is over the picture, not over a panel.
    pub(super) over: bool,
    pub(super) left: bool,
    pub(super) middle: bool,
    pub(super) right: bool,
    pub(super) modifiers: ModifiersState,
    /// Time and place of the last press of the left button, for double clicks.
    pub(super) last_press: Option<(Instant, Vec2)>,
    /// Where the left button went down, while the press may still become a click: the mouse has not been dragged.
    pub(super) click: Option<Vec2>,
}
