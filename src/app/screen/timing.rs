//! Measures frames for the panel Timing.

use super::Screen;
use crate::app::engine::Engine;
use crate::app::frames::progress::is_settled;
use crate::app::state::State;
use crate::app::state::timing::{DeviceTimes, Shown};
use crate::frame::FrameState;
use crate::render::{BoundFrame, Redraw};

impl Screen {
    /// Collects the times of the newest frame that the device has finished.
    pub(super) fn take_times(&self, state: &mut State, engine: &mut Engine) {
        let Some(ms) = self.frames.last_device_ms() else { return };
        let (passes, counts) = (self.frames.pass_times(), self.frames.draw_counts());
        let compiles_in_frame = !engine.gpu_is_fast();
        let serial = self.frames.timed();
        state.timing.finished(&DeviceTimes { serial, ms, passes, counts, compiles_in_frame });
    }

    /// How much of the frame to draw. While the panel Timing is open, new shaders get a few more frames than they need, to be
    /// measured.
    pub(super) fn redraw(state: &mut State, engine: &mut Engine, frame: Option<&BoundFrame>) -> Redraw {
        let Some(frame_state) = frame.map(|frame| &frame.state) else { return Redraw::IfChanged };
        let is_measurable =
            state.workspace.sight.timing && is_settled(state, engine) && !frame_state.pipelines.accumulates;
        match is_measurable && state.timing.wants_frame(&shown(frame_state)) {
            true => Redraw::Always,
            false => Redraw::IfChanged,
        }
    }

    /// Records the frame that has just been submitted.
    pub(super) fn note_frame(&self, state: &mut State, frame: Option<&BoundFrame>) {
        if let Some(frame) = frame {
            state.timing.submitted(self.frames.submitted(), shown(&frame.state), self.cpu);
        }
    }
}

/// Returns the inputs that decide whether times of frames can be compared.
fn shown(frame_state: &FrameState) -> Shown {
    Shown {
        generation: frame_state.shaders.generation,
        mode: frame_state.mode().map(|mode| mode.slug.clone()).unwrap_or_default(),
        size: frame_state.size,
        model: frame_state.scene.as_ref().map(|scene| scene.model().name.clone()).unwrap_or_default(),
    }
}
