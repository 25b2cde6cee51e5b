//! The clock of animated shaders in a window, which can run, pause, advance by single frames, and restart.

use std::time::Instant;

use crate::frame::Clock;

/// Length of a single step, seconds.
const STEP_S: f32 = 1.0 / 60.0;

/// The clock of the window's frames.
pub(super) struct Playback {
    clock: Clock,
    /// The time of the last frame, while the clock runs.
    last: Option<Instant>,
    /// Whether the user has paused the clock.
    pub(super) paused: bool,
    /// Seconds of the clock per second of real time.
    pub(super) speed: f32,
    step: bool,
    restarted: bool,
}

impl Default for Playback {
    fn default() -> Self {
        Self { clock: Clock::default(), last: None, paused: false, speed: 1.0, step: false, restarted: false }
    }
}

impl Playback {
    /// Whether the clock runs.
    pub(super) fn runs(&self) -> bool {
        !self.paused || self.step
    }

    /// Advances the clock by one step in the next frame, and pauses it.
    pub(super) fn step(&mut self) {
        (self.paused, self.step) = (true, true);
    }

    /// Sets the clock back to 0.
    pub(super) fn restart(&mut self) {
        self.clock = Clock { mouse_px: self.clock.mouse_px, ..Clock::default() };
        (self.last, self.restarted) = (None, true);
    }

    /// Whether the clock was set back since the last call. The passes must then restart too.
    pub(super) fn take_restart(&mut self) -> bool {
        std::mem::take(&mut self.restarted)
    }

    /// Seconds of the clock since its start.
    pub(super) fn time_s(&self) -> f32 {
        self.clock.time_s
    }

    /// The clock of the next frame. It reads 0 while nothing is animated, so that a still picture need not be redrawn.
    pub(super) fn next(&mut self, is_animated: bool) -> Clock {
        let now = Instant::now();
        let before = self.last.replace(now);
        let step = std::mem::take(&mut self.step);
        if !is_animated || (self.paused && !step) {
            self.last = None;
            // An unchanged clock gives the same picture, which is not drawn again.
            return if is_animated { self.clock } else { Clock::default() };
        }
        // No time passes before the first frame, nor during a pause.
        let passed = before.map_or(0.0, |before| (now - before).as_secs_f32() * self.speed);
        self.clock.delta_s = if step { STEP_S } else { passed };
        self.clock.time_s += self.clock.delta_s;
        self.clock.frame_index = self.clock.frame_index.wrapping_add(1);
        self.clock
    }

    /// The left button went down over the picture.
    pub(super) fn press(&mut self, [x, y]: [f32; 2]) {
        self.clock.mouse_px = [x, y, x, y];
    }

    /// The mouse moved while the button is down.
    pub(super) fn drag(&mut self, [x, y]: [f32; 2]) {
        let [_, _, from_x, from_y] = self.clock.mouse_px;
        self.clock.mouse_px = [x, y, from_x, from_y];
    }

    /// The button went up.
    pub(super) fn release(&mut self) {
        let mouse = &mut self.clock.mouse_px;
        mouse[2] = -mouse[2].abs();
    }
}
