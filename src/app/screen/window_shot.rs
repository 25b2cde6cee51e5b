//! A picture of the window on its way from the device.

use std::sync::Arc;

use crate::app::state::waiting::Shot;
use crate::gpu::Buffer;

/// A capture of the window in flight.
pub(super) struct WindowShot {
    /// The frame that it was copied with.
    pub(super) slot: usize,
    pub(super) pixels: Arc<Buffer>,
    pub(super) size: (u32, u32),
    pub(super) shot: Shot,
}
