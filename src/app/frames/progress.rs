//! Whether the picture is final, and what a finished frame means for the rest.

use crate::app::actions::compare::forget_references;
use crate::app::engine::Engine;
use crate::app::messages::reloads::report;
use crate::app::state::State;
use crate::events::{Event, ReloadEvent, emit};
use crate::gpu::GpuError;
use crate::render::BoundFrame;

/// Whether the next picture differs: the lights of a window orbit, a shader, a pass or the model moves while the time runs, or a key has
/// just been pressed.
pub(in crate::app) fn moves(state: &State) -> bool {
    let runs =
        if state.is_animated() { state.playback.runs() && !state.picture.rests() } else { state.playback.ends_press() };
    (state.has_window && state.session.settings.lights.spin != 0.0) || runs
}

/// Whether an edit is being compiled, or has not been drawn. Whatever else there is to draw waits for it.
pub(in crate::app) fn awaits_edit(state: &State, engine: &Engine) -> bool {
    is_compiling(state, engine) || state.times_next_frame()
}

/// Whether an edit is being compiled, or written before.
pub(in crate::app) fn is_compiling(state: &State, engine: &Engine) -> bool {
    engine.threads.worker.is_compiling() || state.text_writes.are_under_way()
}

/// Reports the first frame of a reload or of the model. `frame` has finished `ms` milliseconds after it began, and took the
/// device `device_ms`.
pub(in crate::app) fn frame_done(
    state: &mut State,
    engine: &mut Engine,
    frame: Option<&BoundFrame>,
    ms: f64,
    device_ms: Option<f64>,
) {
    let Some(frame_state) = frame.map(|frame| &frame.state) else { return };
    if let Some(first) = state.first_frame.take_if(|first| first.generation == frame_state.shaders.generation) {
        state.versions.time(first.generation, ms, device_ms);
        report(state, ReloadEvent { first_frame_ms: ms, ..first.event });
        engine.threads.worker.shown();
    }
    if !state.ready && frame_state.scene.is_some() {
        state.ready = true;
        let ms = state.start.elapsed().as_secs_f64() * 1e3;
        emit(&state.events, &Event::Ready { device: &engine.gpu.info().name, ms });
        // After this build the worker also builds the neighboring modes.
        if let Some(set) = engine.resources.pipelines() {
            engine.threads.worker.build(set, &frame_state.pipelines);
        }
    }
}

/// Shows a message while memory is short. Returns whether the message changes.
pub(in crate::app) fn set_shortage(state: &mut State, engine: &mut Engine, error: Option<&GpuError>) -> bool {
    let text = error.map(|error| format!("{error}. The last picture stays."));
    if state.shortage == text {
        return false;
    }
    if let Some(old) = std::mem::replace(&mut state.shortage, text.clone()) {
        state.notices.end(&old);
    }
    if let Some(text) = text {
        forget_references(state, engine);
        state.keep_saying(text);
    }
    true
}

/// Whether the last frame is final, so that the same inputs draw the same picture again: no edit and no model is on its way, the
/// light of the settings is baked, every stage is compiled, and the frame shows no preview. After an error, a stage that is missing stays
/// so until the next edit.
pub(in crate::app) fn is_settled(state: &State, engine: &Engine) -> bool {
    state.previews.is_whole() && lacks_nothing(state, engine)
}

/// Whether the window could show the final picture, whether or not the last frame has: it shows a preview while the picture moves.
pub(in crate::app) fn lacks_nothing(state: &State, engine: &Engine) -> bool {
    let is_complete = state.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
    let awaits = awaits_edit(state, engine) || state.model.loading;
    state.picture.shows_settings && !awaits && (is_complete || state.has_errors())
}
