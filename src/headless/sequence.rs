//! The times of the frames that a command renders, and the keys that are down in them.

use crate::frame::{Clock, Date, Keys};

/// Frames at equal intervals of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sequence {
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Time of the first, seconds.
    pub start_s: f32,
    /// Frames a second.
    pub fps: f32,
    /// The date at time 0.
    pub date: Date,
    /// The keys that are down in all frames. They go down in the first.
    pub keys: Keys,
    /// Where the left mouse button is down in all frames, pixels from the upper left corner. It goes down in the first.
    pub mouse_px: Option<[f32; 2]>,
}

impl Default for Sequence {
    fn default() -> Self {
        Self { frames: 1, start_s: 0.0, fps: 60.0, date: Date::default(), keys: Keys::default(), mouse_px: None }
    }
}

impl Sequence {
    pub(super) fn clock(&self, frame_index: u32) -> Clock {
        let delta_s = if frame_index == 0 { 0.0 } else { 1.0 / self.fps };
        let time_s = self.start_s + frame_index as f32 / self.fps;
        let keys = if frame_index == 0 { self.keys } else { self.keys.held() };
        let clock = Clock { time_s, delta_s, frame_index, date: self.date.after(time_s), keys, ..Clock::default() };
        let Some([x, y]) = self.mouse_px else { return clock };
        let from_y = if frame_index == 0 { y.max(0.5) } else { -y.max(0.5) };
        Clock { mouse_px: [x, y, x, from_y], cursor_px: [x, y], mouse_buttons: 1, ..clock }
    }
}
