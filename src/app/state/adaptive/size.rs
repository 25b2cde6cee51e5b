//! The size of previews, which follows the measured times of frames.

/// The part of each side of the picture that a preview may have, the largest first.
const SIDES: [f32; 8] = [0.75, 0.625, 0.5, 0.375, 0.3125, 0.25, 0.1875, 0.125];
/// The size of the first preview.
const BEGIN: usize = 2;
/// The smallest size of a picture that one frame draws. Path tracing needs so much longer that its previews may be smaller.
const LEAST: usize = 5;
/// A preview that takes longer than this, milliseconds, becomes smaller. 10 frames a second have 100 ms, of which the CPU needs some.
const MOST_MS: f64 = 75.0;
/// The time that a smaller size aims at, milliseconds, and below which a larger one is tried.
const AIM_MS: f64 = 58.0;
/// So many previews in a row must be fast before the next one is larger. The time of vertices does not follow the size, so it is tried, not
/// computed.
const PATIENCE: u32 = 4;
/// So many previews pass before a size that was too slow is tried again.
const REMEMBERED: u32 = 100;

/// The part of the picture that a frame has drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) enum Drawn {
    /// The whole picture, after parts that took this long, milliseconds.
    Whole { parts_ms: f64 },
    Preview {
        /// Its [`PreviewSize::side`].
        side: f32,
        /// How often the time of its pixels goes into that of the whole picture.
        pixels_of_whole: f64,
        /// Whether the picture is the mean of many frames.
        accumulates: bool,
    },
}

/// The size of previews.
#[derive(Debug)]
pub(in crate::app) struct PreviewSize {
    /// Index in [`SIDES`].
    at: usize,
    /// How many previews in a row could have been larger.
    could_grow: u32,
    /// The smallest index that may be tried, since the size before it was too slow, and for how many previews that holds.
    limit: (usize, u32),
    /// Whether no preview of this picture has been timed. The first one may compile.
    is_first: bool,
}

impl Default for PreviewSize {
    fn default() -> Self {
        Self { at: BEGIN, could_grow: 0, limit: (0, 0), is_first: true }
    }
}

impl PreviewSize {
    /// The part of each side of the picture that a preview has.
    pub(in crate::app) fn side(&self) -> f32 {
        SIDES[self.at]
    }

    /// Begins a new picture, which may take another time. `accumulates`: whether it is the mean of many frames, which take long.
    pub(super) fn begin(&mut self, accumulates: bool) {
        (self.could_grow, self.limit, self.is_first) = (0, (0, 0), true);
        if accumulates {
            self.at = SIDES.len() - 1;
        } else if self.at > LEAST {
            self.at = BEGIN;
        }
    }

    /// A preview was drawn that is not timed.
    pub(super) fn warmed(&mut self) {
        self.is_first = false;
    }

    /// Takes the time of a preview with this `side`, milliseconds: of the whole frame, and of what no size changes.
    pub(super) fn took(&mut self, (side, accumulates): (f32, bool), ms: f64, fixed_ms: f64) {
        // Frames in flight may have had another size.
        if std::mem::take(&mut self.is_first) || side != self.side() {
            return;
        }
        let of_pixels = (ms - fixed_ms).max(0.0);
        let expected = |at: usize| fixed_ms + of_pixels * f64::from(SIDES[at] / side).powi(2);
        let least = if accumulates { SIDES.len() - 1 } else { LEAST };
        if ms > MOST_MS && self.at < least {
            let fits = (self.at + 1..=least).find(|at| expected(*at) <= AIM_MS);
            (self.limit, self.could_grow) = ((self.at + 1, REMEMBERED), 0);
            self.at = fits.unwrap_or(least);
            return;
        }
        self.limit.1 = self.limit.1.saturating_sub(1);
        let smallest = if self.limit.1 > 0 { self.limit.0 } else { 0 };
        self.could_grow = if self.at > smallest && ms <= AIM_MS { self.could_grow + 1 } else { 0 };
        if self.could_grow >= PATIENCE {
            (self.at, self.could_grow) = (self.at - 1, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Previews of a picture whose whole pixels take `whole_ms`, beside `fixed_ms` for all else.
    fn draw(size: &mut PreviewSize, frames: u32, whole_ms: f64, fixed_ms: f64) -> f32 {
        for _ in 0..frames {
            let side = size.side();
            size.took((side, false), fixed_ms + whole_ms * f64::from(side).powi(2), fixed_ms);
        }
        size.side()
    }

    #[test]
    fn a_slow_picture_gets_smaller_at_once_and_a_fast_one_larger_in_steps() {
        let mut size = PreviewSize::default();
        assert_eq!(draw(&mut size, 1, 900.0, 10.0), 0.5, "the first one compiles");
        assert_eq!(draw(&mut size, 1, 900.0, 10.0), 0.25);
        assert_eq!(draw(&mut size, 100, 900.0, 10.0), 0.25, "the smallest");
        size.begin(false);
        assert_eq!(draw(&mut size, PATIENCE, 50.0, 10.0), 0.25);
        assert_eq!(draw(&mut size, 1, 50.0, 10.0), 0.3125);
        assert_eq!(draw(&mut size, 100, 50.0, 10.0), 0.75, "the largest");
    }

    #[test]
    fn a_size_that_was_too_slow_is_not_tried_again_soon() {
        for whole_ms in (20..1500).step_by(20) {
            let mut size = PreviewSize::default();
            draw(&mut size, 60, f64::from(whole_ms), 10.0);
            let sides: Vec<f32> = (0..40).map(|_| draw(&mut size, 1, f64::from(whole_ms), 10.0)).collect();
            let changes = sides.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!(changes <= 2, "{whole_ms} ms: {sides:?}");
        }
    }

    #[test]
    fn path_tracing_may_be_smaller() {
        let mut size = PreviewSize::default();
        size.begin(true);
        assert_eq!(size.side(), 0.125);
        for _ in 0..3 {
            size.took((0.125, true), 1000.0, 10.0);
        }
        assert_eq!(size.side(), 0.125);
        size.begin(false);
        assert_eq!(size.side(), 0.5);
        size.took((0.5, true), 1000.0, 10.0);
        size.took((0.5, true), 1000.0, 10.0);
        assert_eq!(size.side(), 0.125);
    }
}
