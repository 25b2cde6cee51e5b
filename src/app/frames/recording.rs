//! Records the session for the process that replaces this one after a loss of the device.

use std::sync::Arc;

use crate::app::engine::Engine;
use crate::app::state::State;
use crate::frame::FrameState;
use crate::recovery::Geometry;

/// Records what the next frame shows, for the process that replaces this one if the frame loses the device. `geometry`: of the window.
/// Returns the attempt's number, unless the frame is the fallback.
pub(in crate::app) fn record(state: &State, engine: &Engine, geometry: impl FnOnce() -> Geometry) -> Option<u64> {
    let work = state.session_state();
    let attempt = engine.recorder.begin(&work, geometry);
    let shown = engine.shown.as_ref().filter(|_| !state.model.loading)?;
    (Arc::ptr_eq(&shown.settings, &work.settings) || shown.settings == work.settings).then_some(attempt)
}

/// Records that the device has drawn the frame of `attempt`, and if the frame was complete, its shaders.
pub(in crate::app) fn drawn(state: &State, engine: &Engine, frame_state: &FrameState, attempt: Option<u64>) {
    attempt.into_iter().for_each(|attempt| engine.recorder.drawn(attempt));
    if state.picture.settled == Some(frame_state.shaders.generation) && frame_state.shaders.is_complete() {
        engine.recorder.drawn_all(frame_state.shaders.generation, &frame_state.shaders.texts);
    }
}
