//! The times of the frames that a command renders.

use crate::frame::Clock;

/// Frames at even distances in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sequence {
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Time of the first, seconds.
    pub start_s: f32,
    /// Frames a second.
    pub fps: f32,
}

impl Default for Sequence {
    fn default() -> Self {
        Self { frames: 1, start_s: 0.0, fps: 60.0 }
    }
}

impl Sequence {
    pub(super) fn clock(&self, frame_index: u32) -> Clock {
        let delta_s = if frame_index == 0 { 0.0 } else { 1.0 / self.fps };
        Clock { time_s: self.start_s + frame_index as f32 / self.fps, delta_s, frame_index, ..Clock::default() }
    }
}
