//! The clock of animated shaders in a window, which can run, pause, advance by single frames, and restart; and the mouse and
//! the keys that shaders read.

use std::time::Instant;

use crate::frame::{BEYOND, Clock, Date, Keys};

/// Length of a single step, seconds.
const STEP_S: f32 = 1.0 / 60.0;

/// The mouse over the picture, as the block `Frame` has it.
#[derive(Clone, Copy, Debug)]
struct Mouse {
    px: [f32; 4],
    cursor_px: [f32; 2],
    buttons: u32,
}

/// The clock of the window's frames.
pub(in crate::app) struct Playback {
    clock: Clock,
    /// The time of the last frame, while the clock runs.
    last: Option<Instant>,
    /// Whether the user has paused the clock.
    pub(in crate::app) paused: bool,
    /// Whether the clock of every picture stands until a command starts it.
    awaits_start: bool,
    /// Seconds of the clock per second of real time.
    pub(in crate::app) speed: f32,
    step: bool,
    restarted: bool,
    /// The keys now. The clock has those of the last frame.
    keys: Keys,
    /// The mouse now. The clock has that of the last frame; while it is paused, only drags change it.
    mouse: Mouse,
    /// Whether a frame has shown the last click.
    shows_click: bool,
    /// The date of still pictures: when the window was opened.
    opened: Date,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            clock: Clock::default(),
            last: None,
            paused: false,
            awaits_start: false,
            speed: 1.0,
            step: false,
            restarted: false,
            keys: Keys::default(),
            mouse: Mouse { px: [0.0; 4], cursor_px: BEYOND, buttons: 0 },
            shows_click: false,
            opened: Date::now(),
        }
    }
}

impl Playback {
    /// Whether the clock runs.
    pub(in crate::app) fn runs(&self) -> bool {
        !self.paused || self.step
    }

    /// Advances the clock by one step in the next frame, and pauses it.
    pub(in crate::app) fn step(&mut self) {
        (self.paused, self.step) = (true, true);
    }

    /// Pauses the clock of this picture and of those that follow, for a session without a window.
    pub(in crate::app) fn await_start(&mut self) {
        (self.paused, self.awaits_start) = (true, true);
    }

    /// Begins the clock of another picture. In a window it runs: pause and speed were those of the picture before.
    pub(in crate::app) fn begin(&mut self) {
        self.restart();
        if !self.awaits_start {
            (self.paused, self.speed) = (false, 1.0);
        }
    }

    /// Sets the clock back to 0.
    pub(in crate::app) fn restart(&mut self) {
        let Clock { mouse_px, cursor_px, mouse_buttons, date, .. } = self.clock;
        self.clock = Clock { mouse_px, cursor_px, mouse_buttons, date, ..Clock::default() };
        (self.last, self.restarted) = (None, true);
    }

    /// Sets the clock to a time. Passes continue from their last images.
    pub(in crate::app) fn seek(&mut self, time_s: f32) {
        (self.clock.time_s, self.last) = (time_s, None);
    }

    /// Whether the clock was set back since the last call. The passes must then restart too.
    pub(in crate::app) fn take_restart(&mut self) -> bool {
        std::mem::take(&mut self.restarted)
    }

    /// Seconds of the clock since its start.
    pub(in crate::app) fn time_s(&self) -> f32 {
        self.clock.time_s
    }

    /// The clock of the next frame. While nothing is animated, the time stands still and the frame gets the clock of the start,
    /// so that a still picture need not be redrawn. Its keys are those that are down now, unless the clock is paused. A picture
    /// that does not read keys gets none.
    pub(in crate::app) fn next(&mut self, is_animated: bool, reads_keys: bool) -> Clock {
        self.next_at(is_animated, reads_keys, (Instant::now(), Date::now()))
    }

    fn next_at(&mut self, is_animated: bool, reads_keys: bool, (now, date): (Instant, Date)) -> Clock {
        let before = self.last.replace(now);
        let step = std::mem::take(&mut self.step);
        if is_animated && self.paused && !step {
            return self.stay();
        }
        self.clock.keys = if reads_keys { self.keys.in_frame() } else { Keys::default() };
        self.keys = self.keys.held();
        // A click counts in one frame.
        if std::mem::take(&mut self.shows_click) {
            self.mouse.px[3] = -self.mouse.px[3].abs();
        }
        self.shows_click = self.mouse.px[3] > 0.0;
        let Mouse { px, cursor_px, buttons } = self.mouse;
        (self.clock.mouse_px, self.clock.cursor_px, self.clock.mouse_buttons) = (px, cursor_px, buttons);
        if !is_animated {
            self.last = None;
            return Clock { date: self.opened, keys: self.clock.keys, ..Clock::default() };
        }
        self.clock.date = date;
        self.clock.delta_s = match before {
            _ if step => STEP_S,
            Some(before) => (now - before).as_secs_f32() * self.speed,
            // The clock has just started, so no time has passed: this is the last frame again.
            None => return self.clock,
        };
        self.clock.time_s += self.clock.delta_s;
        self.clock.frame_index = self.clock.frame_index.wrapping_add(1);
        self.clock
    }

    /// The clock of the last frame again, while it is paused or the animation has ended. An unchanged clock gives the same picture, which
    /// is not drawn again.
    pub(in crate::app) fn stay(&mut self) -> Clock {
        (self.last, self.step) = (None, false);
        self.clock.mouse_px = self.mouse.px;
        self.clock
    }

    /// Whether the next frame differs from the last one because a key press counts in one frame only. Ignores animation.
    pub(in crate::app) fn ends_press(&self) -> bool {
        self.clock.keys.any_pressed()
    }

    /// The keys, which events change.
    pub(in crate::app) fn keys(&mut self) -> &mut Keys {
        &mut self.keys
    }

    /// The mouse moved, with or without a button.
    pub(in crate::app) fn hover(&mut self, at: [f32; 2]) {
        self.mouse.cursor_px = at;
    }

    /// The button of this bit went down over the picture, or up.
    pub(in crate::app) fn set_button(&mut self, bit: u32, is_down: bool) {
        let buttons = &mut self.mouse.buttons;
        *buttons = if is_down { *buttons | bit } else { *buttons & !bit };
    }

    /// No button is down any more: the window has lost the focus.
    pub(in crate::app) fn release_buttons(&mut self) {
        self.mouse.buttons = 0;
    }

    /// The left button went down over the picture.
    pub(in crate::app) fn press(&mut self, [x, y]: [f32; 2]) {
        // The sign of w marks the frame of a click, so w is never 0.
        (self.mouse.px, self.shows_click) = ([x, y, x, y.max(0.5)], false);
    }

    /// The mouse moved while the button is down.
    pub(in crate::app) fn drag(&mut self, [x, y]: [f32; 2]) {
        let [_, _, from_x, from_y] = self.mouse.px;
        self.mouse.px = [x, y, from_x, from_y];
    }

    /// The button went up.
    pub(in crate::app) fn release(&mut self) {
        self.mouse.px[2] = -self.mouse.px[2].abs();
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// A playback whose frames are a quarter of a second apart, which floats hold exactly.
    struct Frames {
        playback: Playback,
        now: Instant,
    }

    impl Frames {
        fn new() -> Self {
            Self { playback: Playback { opened: Date::default(), ..Playback::default() }, now: Instant::now() }
        }

        fn next(&mut self, is_animated: bool) -> Clock {
            self.now += Duration::from_millis(250);
            self.playback.next_at(is_animated, true, (self.now, Date::default()))
        }

        /// Time and index of the next frame of an animated picture.
        fn animated(&mut self) -> (f32, u32) {
            let clock = self.next(true);
            (clock.time_s, clock.frame_index)
        }
    }

    #[test]
    fn the_first_frame_has_index_0_at_0_s() {
        let mut frames = Frames::new();
        assert_eq!(frames.next(true), Clock::default());
        assert_eq!(frames.animated(), (0.25, 1));
        let third = frames.next(true);
        assert_eq!((third.time_s, third.delta_s, third.frame_index), (0.5, 0.25, 2));
    }

    #[test]
    fn a_pause_keeps_the_time_and_does_not_count_when_it_ends() {
        let mut frames = Frames::new();
        frames.animated();
        let last = frames.next(true);
        frames.playback.paused = true;
        assert!(!frames.playback.runs());
        for _ in 0..10 {
            assert_eq!(frames.next(true), last, "the same clock, so the picture is not drawn again");
        }
        frames.playback.paused = false;
        assert_eq!(frames.next(true), last);
        assert_eq!(frames.animated(), (0.5, 2));
    }

    #[test]
    fn the_clock_stays_at_the_end_of_an_animation_and_goes_on_from_there() {
        let mut frames = Frames::new();
        frames.animated();
        let last = frames.next(true);
        frames.playback.step = true;
        for _ in 0..10 {
            frames.now += Duration::from_millis(250);
            assert_eq!(frames.playback.stay(), last);
        }
        assert_eq!(frames.next(true), last, "neither the time since then nor a step counts");
        assert_eq!(frames.animated(), (0.5, 2));
    }

    #[test]
    fn a_step_goes_on_by_one_sixtieth_and_pauses() {
        let mut frames = Frames::new();
        frames.animated();
        frames.playback.speed = 4.0;
        frames.playback.step();
        assert!(frames.playback.runs(), "the step is still to be drawn");
        let stepped = frames.next(true);
        assert_eq!((stepped.time_s, stepped.delta_s, stepped.frame_index), (STEP_S, STEP_S, 1));
        assert!(frames.playback.paused && !frames.playback.runs());
        assert_eq!(frames.next(true), stepped);
        frames.playback.step();
        assert_eq!(frames.animated(), (2.0 * STEP_S, 2));
    }

    #[test]
    fn a_restart_begins_at_the_first_frame_once_and_keeps_the_mouse() {
        for paused in [false, true] {
            let mut frames = Frames::new();
            frames.playback.press([3.0, 4.0]);
            frames.animated();
            frames.animated();
            frames.playback.paused = paused;
            frames.playback.restart();
            let first = Clock { mouse_px: [3.0, 4.0, 3.0, -4.0], ..Clock::default() };
            assert_eq!(frames.next(true), first);
            assert!(frames.playback.take_restart(), "passes begin again");
            assert!(!frames.playback.take_restart(), "they begin again once");
            assert_eq!(frames.animated().0, if paused { 0.0 } else { 0.25 });
        }
    }

    #[test]
    fn another_picture_runs_in_a_window_and_waits_without_one() {
        for awaits_start in [false, true] {
            let mut frames = Frames::new();
            if awaits_start {
                frames.playback.await_start();
            }
            (frames.playback.paused, frames.playback.speed) = (true, 0.0);
            frames.playback.begin();
            assert!(frames.playback.take_restart(), "passes begin again");
            assert_eq!(frames.animated(), (0.0, 0));
            assert_eq!(frames.animated().0, if awaits_start { 0.0 } else { 0.25 });
        }
    }

    #[test]
    fn the_speed_scales_the_time_from_the_next_frame_on() {
        let mut frames = Frames::new();
        frames.animated();
        frames.animated();
        frames.playback.speed = 2.0;
        assert_eq!(frames.animated(), (0.75, 2));
        frames.playback.speed = 0.0;
        assert_eq!(frames.animated(), (0.75, 3));
    }

    /// A reload may take the animation away and bring it back.
    #[test]
    fn time_without_an_animation_does_not_count() {
        for paused in [false, true] {
            let mut frames = Frames::new();
            frames.animated();
            let last = frames.next(true);
            frames.playback.paused = paused;
            assert_eq!(frames.next(false), Clock::default(), "a still picture has one clock");
            assert_eq!(frames.next(false), Clock::default());
            assert_eq!(frames.next(true), last);
            assert_eq!(frames.animated().0, if paused { 0.25 } else { 0.5 });
        }
    }

    #[test]
    fn a_press_lasts_one_frame() {
        for is_animated in [false, true] {
            let mut frames = Frames::new();
            frames.next(is_animated);
            frames.playback.keys().press(65);
            frames.playback.keys().release(65);
            let keys = frames.next(is_animated).keys;
            let bit = [0, 0, 2, 0, 0, 0, 0, 0];
            assert_eq!(keys, Keys { down: bit, pressed: bit, toggled: bit });
            assert!(frames.playback.ends_press());
            let keys = frames.next(is_animated).keys;
            assert_eq!(keys, Keys { toggled: bit, ..Keys::default() });
            assert!(!frames.playback.ends_press());
            // A picture that does not read keys is the same whatever they are.
            frames.playback.keys().press(66);
            let clock = frames.playback.next_at(is_animated, false, (frames.now, Date::default()));
            assert_eq!(clock.keys, Keys::default());
        }
    }

    /// While the clock is paused, keys change nothing. The next step shows what was pressed meanwhile.
    #[test]
    fn a_pause_keeps_the_keys() {
        let mut frames = Frames::new();
        frames.animated();
        let last = frames.next(true);
        frames.playback.paused = true;
        frames.playback.keys().press(32);
        assert_eq!(frames.next(true), last);
        frames.playback.step();
        let stepped = frames.next(true);
        assert!(stepped.keys.any_pressed());
        assert_eq!(frames.next(true), stepped);
    }

    #[test]
    fn the_date_runs_with_an_animated_picture_only() {
        let mut playback = Playback::default();
        let (now, opened, later) = (Instant::now(), playback.opened, playback.opened.after(5.0));
        assert!(opened > Date::default());
        assert_eq!(playback.next_at(false, false, (now, later)).date, opened);
        assert_eq!(playback.next_at(true, false, (now, later)).date, later, "from the first frame on");
    }

    #[test]
    fn the_mouse_keeps_where_it_was_pressed() {
        let mut frames = Frames::new();
        frames.playback.press([1.0, 2.0]);
        frames.playback.drag([5.0, 6.0]);
        frames.animated();
        assert_eq!(frames.next(true).mouse_px, [5.0, 6.0, 1.0, -2.0], "down since an earlier frame");
        frames.playback.release();
        assert_eq!(frames.next(true).mouse_px, [5.0, 6.0, -1.0, -2.0], "not down");
        frames.playback.press([7.0, 8.0]);
        assert_eq!(frames.next(true).mouse_px, [7.0, 8.0, 7.0, 8.0], "the frame of a click");
    }

    #[test]
    fn a_paused_shader_follows_drags_alone() {
        let mut frames = Frames::new();
        frames.animated();
        frames.playback.paused = true;
        let still = frames.next(true);
        frames.playback.hover([9.0, 9.0]);
        assert_eq!(frames.next(true), still, "a paused picture is not drawn again because the mouse moves over it");
        frames.playback.press([1.0, 2.0]);
        frames.playback.drag([3.0, 4.0]);
        assert_eq!(frames.next(true), Clock { mouse_px: [3.0, 4.0, 1.0, 2.0], ..still });
    }

    #[test]
    fn the_mouse_is_told_without_a_button_and_so_is_each_button() {
        let mut frames = Frames::new();
        frames.playback.hover([1.0, 2.0]);
        frames.playback.set_button(1, true);
        frames.playback.set_button(2, true);
        let clock = frames.next(true);
        assert_eq!((clock.cursor_px, clock.mouse_buttons), ([1.0, 2.0], 3));
        frames.playback.set_button(1, false);
        assert_eq!(frames.next(true).mouse_buttons, 2);
        assert_eq!(frames.next(false).mouse_buttons, 0, "a still picture does not know the mouse");
    }
}
