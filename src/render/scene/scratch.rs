//! Memory that sorting the draws of a frame needs, kept from frame to frame.

use crate::gpu::DrawCommand;

/// Values by the numbers of draws, and the commands of the last frame.
#[derive(Default)]
pub(super) struct Scratch {
    /// Squares of the distances from the eye.
    pub(super) distances: Vec<f32>,
    /// Whether the camera does not see the draw.
    pub(super) beyond: Vec<bool>,
    /// Steps of the distance.
    pub(super) depths: Vec<u8>,
    pub(super) commands: Vec<DrawCommand>,
}
