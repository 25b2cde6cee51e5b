//! Keeps the table of stages up to date, and lets the worker ask the driver about their code.

use crate::app::engine::Engine;
use crate::app::frames::progress::is_settled;
use crate::app::state::State;

/// Updates the table of stages, if the shaders or the picture have changed.
pub(in crate::app) fn update_stages(state: &mut State, engine: &mut Engine) {
    let Some(frame_state) = engine.shown.as_ref().map(|shown| shown.frame.state.clone()) else { return };
    let is_settled = is_settled(state, engine);
    let Some(set) = engine.resources.pipelines() else { return };
    // Until the newest shaders are on screen, the table describes the current ones.
    if set.shaders.generation != frame_state.shaders.generation {
        return;
    }
    if state.stages.is_outdated(set, &frame_state.pipelines) {
        let before = state.versions.last_before(frame_state.shaders.generation);
        let before = before.and_then(|version| engine.generations.set(version.generation));
        state.stages.update(set, &frame_state.pipelines, before, &state.shader.log);
    }
    if state.shader.asks_driver && is_settled && state.shader.told.as_ref() != Some(&frame_state.pipelines) {
        state.shader.told = Some(frame_state.pipelines.clone());
        engine.threads.worker.ask_driver(set, &frame_state.pipelines);
    }
}
