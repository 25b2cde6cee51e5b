//! Measures frames for the panel Timing.

use super::Screen;
use crate::app::state::timing::{DeviceTimes, Shown};
use crate::app::viewer::Viewer;
use crate::frame::FrameState;
use crate::render::{BoundFrame, Redraw};

impl Screen {
    /// Collects the times of the newest frame that the device has finished.
    pub(super) fn take_times(&self, viewer: &mut Viewer) {
        let Some(ms) = self.frames.last_device_ms() else { return };
        let (passes, counts) = (self.frames.pass_times(), self.frames.draw_counts());
        let compiles_in_frame = !viewer.gpu_is_fast();
        let serial = self.frames.timed();
        viewer.timing.finished(&DeviceTimes { serial, ms, passes, counts, compiles_in_frame });
    }

    /// How much of the frame to draw. While the panel Timing is open, new shaders get a few more frames than they need, to be
    /// measured.
    pub(super) fn redraw(viewer: &mut Viewer, frame: Option<&BoundFrame>) -> Redraw {
        let Some(state) = frame.map(|frame| &frame.state) else { return Redraw::IfChanged };
        let is_measurable = viewer.workspace.sight.timing && viewer.is_settled() && !state.pipelines.accumulates;
        match is_measurable && viewer.timing.wants_frame(&shown(state)) {
            true => Redraw::Always,
            false => Redraw::IfChanged,
        }
    }

    /// Records the frame that has just been submitted.
    pub(super) fn note_frame(&self, viewer: &mut Viewer, frame: Option<&BoundFrame>) {
        if let Some(frame) = frame {
            viewer.timing.submitted(self.frames.submitted(), shown(&frame.state), self.cpu);
        }
    }
}

/// Returns the inputs that decide whether times of frames can be compared.
fn shown(state: &FrameState) -> Shown {
    Shown {
        generation: state.shaders.generation,
        mode: state.mode().map(|mode| mode.slug.clone()).unwrap_or_default(),
        size: state.size,
        model: state.scene.as_ref().map(|scene| scene.model().name.clone()).unwrap_or_default(),
    }
}
