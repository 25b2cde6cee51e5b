//! When the next frame follows, and the times of frames that are measured.

use std::time::Instant;

use super::Screen;
use crate::app::control::has_unanswered;
use crate::app::engine::Engine;
use crate::app::frames::progress::{frame_done, moves};
use crate::app::state::State;
use crate::events::{Event, emit};
use crate::gpu::GpuError;
use crate::render::{BoundFrame, View};

impl Screen {
    /// Whether another frame must follow at once: the picture improves or is animated, a result is in flight, a command waits for
    /// its answer, or the clock runs.
    pub(super) fn has_more(&self, state: &State, engine: &Engine, frame: Option<&BoundFrame>) -> bool {
        let moving = self.reference.as_ref().filter(|reference| !reference.is_still());
        let reference = moving.map(|reference| (&reference.view, &reference.frame));
        let cells = self.cells.iter().filter_map(|cell| Some((&cell.view, &cell.shown.as_ref()?.frame)));
        let mut views = frame.map(|frame| (&self.view, frame)).into_iter().chain(reference).chain(cells);
        let is_unfinished = |(view, frame): (&View, &BoundFrame)| {
            let gets_better = frame.state.pipelines.accumulates && view.accumulated() < View::MOST_ACCUMULATED;
            gets_better || view.is_moving(frame) || view.awaits_range_sample()
        };
        self.awaits_pixel()
            || self.window_shot.is_some()
            || self.error_map.awaits_copies()
            || has_unanswered(state, engine)
            || moves(state)
            || views.any(is_unfinished)
    }

    /// Measures and reports the first frame of the window, of a reload and of the model. Returns whether panels must be
    /// redrawn.
    pub(super) fn finished(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        frame: Option<&BoundFrame>,
        begin: Instant,
    ) -> Result<bool, GpuError> {
        if std::mem::take(&mut self.first) {
            // SYNC: once, so that the time includes the device's work.
            self.frames.wait_all()?;
            emit(&state.events, &Event::Window { ms: state.start.elapsed().as_secs_f64() * 1e3 });
        }
        if !state.times_next_frame() {
            return Ok(false);
        }
        // SYNC: once per reload, so that the time includes the device's work.
        self.frames.wait_all()?;
        // A frame with an older picture does not show the time of the newest one.
        let device_ms = self.frames.last_device_ms().filter(|_| self.reference.is_none() && self.cells.is_empty());
        frame_done(state, engine, frame, begin.elapsed().as_secs_f64() * 1e3, device_ms);
        Ok(!state.times_next_frame())
    }
}
