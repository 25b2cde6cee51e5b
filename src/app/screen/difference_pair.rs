//! The pictures whose difference is measured.

use std::sync::Arc;

use crate::frame::FrameState;
use crate::gpu::Rect;
use crate::threads::Side;

/// Both pictures, by their numbers and states.
pub(super) struct Pair {
    pub(super) numbers: [u64; 3],
    pub(super) states: [Arc<FrameState>; 2],
}

impl Pair {
    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.numbers == other.numbers && self.states.iter().zip(&other.states).all(|(a, b)| a.is_same(b))
    }
}

/// Copies of both pictures that a frame in this slot makes, and their part that is measured.
pub(super) struct Copied {
    pub(super) slot: usize,
    pub(super) pictures: [Side; 2],
    pub(super) part: Rect,
}

/// The pictures that are measured.
#[derive(Default)]
pub(super) struct ErrorMap {
    /// The pictures of the last frame.
    pub(super) last: Option<Pair>,
    /// The pictures that were measured last, or are being measured.
    pub(super) measured: Option<Pair>,
    /// The slot of the frame that copies both pictures.
    pub(super) copied: Option<Copied>,
    /// The number of the last measurement.
    pub(super) number: u64,
}

impl ErrorMap {
    /// Whether copies are still in flight.
    pub(super) fn awaits_copies(&self) -> bool {
        self.copied.is_some()
    }
}
