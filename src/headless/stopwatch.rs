//! Times of two frames that are drawn in turn.

use std::sync::Arc;
use std::time::Instant;

use super::HeadlessError;
use super::offscreen_view::OffscreenView;
use crate::gpu::{Gpu, SetLayouts};
use crate::render::{BoundFrame, Redraw};
use crate::statistics::{Difference, PairedTimes};

/// Draws frames and tells how long they take. It has a view of its own, so the picture and its history stay as they are.
pub struct Stopwatch {
    pub(super) own: OffscreenView,
}

/// Two frames that are drawn in turn.
pub struct Contest<'a> {
    /// Each is bound to its pipelines.
    pub frames: [&'a BoundFrame; 2],
    /// The passes whose time counts; without one of them, the whole frame's.
    pub passes: &'a [String],
    /// Most pairs of frames.
    pub most: usize,
    /// Whether the result is no longer needed.
    pub is_canceled: &'a dyn Fn() -> bool,
}

impl Stopwatch {
    /// Creates the view.
    ///
    /// # Errors
    /// No memory left.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>) -> Result<Self, HeadlessError> {
        Ok(Self { own: OffscreenView::new(gpu, layouts)? })
    }

    /// Draws the frame from the beginning, and returns the time of these passes, or of the whole frame if it has none of them.
    ///
    /// # Errors
    /// A device error.
    pub fn time(&mut self, frame: &BoundFrame, passes: &[String]) -> Result<f64, HeadlessError> {
        Ok(self.times(frame, passes)?[0])
    }

    /// [`Self::time`], and that of the whole frame: the device's times, or, of a device that does not measure, the time until the frame is
    /// done. Milliseconds.
    pub(super) fn times(&mut self, frame: &BoundFrame, passes: &[String]) -> Result<[f64; 2], HeadlessError> {
        // Passes whose image would be the same are drawn again.
        self.own.view.forget();
        self.own.view.restart_passes();
        self.own.view.restart_mean();
        let begin = Instant::now();
        self.own.draw(frame, Redraw::Always, |_, _, _| Ok(()))?;
        let wall_ms = begin.elapsed().as_secs_f64() * 1e3;
        let times = self.own.frames.pass_times().iter();
        let of_passes: f64 = times.filter(|pass| !pass.kept && passes.contains(&pass.name)).map(|pass| pass.ms).sum();
        let of_frame = self.own.frames.last_device_ms().unwrap_or(wall_ms);
        Ok([if of_passes > 0.0 { of_passes } else { of_frame }, of_frame])
    }

    /// Draws two frames in turn until their difference is known, or to the end. `None` if a loop of one of them does not end.
    ///
    /// # Errors
    /// A device error; canceled.
    pub fn compare(&mut self, contest: &Contest<'_>) -> Result<Option<Difference>, HeadlessError> {
        let Contest { frames, passes, most, is_canceled } = *contest;
        // A driver may compile in the first frame, and a device may wake up.
        for frame in frames {
            self.time(frame, passes)?;
            if self.own.endless_loop().is_some() {
                return Ok(None);
            }
        }
        let mut times = PairedTimes::default();
        loop {
            if is_canceled() {
                return Err(HeadlessError::Canceled);
            }
            // Each side is the first as often as the second.
            let order = if times.len().is_multiple_of(2) { [0, 1] } else { [1, 0] };
            let mut pair = [0.0; 2];
            for side in order {
                pair[side] = self.time(frames[side], passes)?;
            }
            times.push(pair[0], pair[1]);
            if let Some(found) = times.difference(most) {
                return Ok(Some(found));
            }
        }
    }
}
