//! The picture to draw: the one that the settings describe once it is complete, until then the last complete one.

use std::sync::Arc;

use crate::app::actions::edits::watch_expression;
use crate::app::actions::exercises::check_exercise;
use crate::app::actions::files::follow_added;
use crate::app::actions::inspect::follow_pin;
use crate::app::engine::Engine;
use crate::app::engine::last_complete::{LastComplete, target};
use crate::app::frames::progress::{is_settled, lacks_nothing, moves};
use crate::app::state::State;
use crate::app::state::waits::Waits;
use crate::events::{Event, emit};
use crate::frame::{Clock, FrameState};
use crate::gpu::GpuError;
use crate::recovery::SessionState;
use crate::render::{BoundFrame, Missing};
use crate::settings::Settings;
use crate::threads::worker::Snapshot;

/// Slug of the mode of thumbnails.
const FINAL: &str = "final";

/// The frame to draw: the one that the settings describe if it is complete, otherwise the last good frame with the current
/// camera. Requests the missing resources from the threads. `None` before the first shaders. `prepare` allocates the targets;
/// a frame for which that fails does not count as shown.
pub(in crate::app) fn next_frame(
    state: &mut State,
    engine: &mut Engine,
    size: (u32, u32),
    prepare: impl FnMut(&BoundFrame) -> Result<(), GpuError>,
) -> Result<Option<BoundFrame>, GpuError> {
    let preview = state.workspace.sight.preview.clone().filter(|_| !engine.recorder.is_safe_mode());
    let Some(preview) = preview else {
        return frame_of_settings(state, engine, size, prepare);
    };
    // Hover previews are transient: not recorded, and dropped when the pointer leaves.
    let selected = std::mem::replace(&mut state.session.settings.mode, preview);
    let frame = frame_of_settings(state, engine, size, prepare);
    state.session.settings.mode = selected;
    // Commands that wait for the settings wait until the preview ends.
    state.picture.shows_settings = false;
    frame
}

fn frame_of_settings(
    state: &mut State,
    engine: &mut Engine,
    size: (u32, u32),
    mut prepare: impl FnMut(&BoundFrame) -> Result<(), GpuError>,
) -> Result<Option<BoundFrame>, GpuError> {
    follow_added(state, engine);
    let is_animated = state.is_animated();
    let clock = match is_animated && state.picture.rests() {
        true => state.playback.stay(),
        false => state.playback.next(is_animated, state.reads_keys()),
    };
    let target = target(&engine.gpu, &state.session.settings, !state.has_window);
    let Some(frame_state) = state.session.frame_state(clock, size, target) else { return Ok(None) };
    follow_settings(state, engine, &frame_state);
    (state.picture.clock, state.picture.is_complete, state.picture.shows_settings) = (clock, false, false);
    // The first frame of a model does not wait for its environment.
    let is_first = engine.shown.as_ref().is_none_or(|shown| shown.scene().is_none());
    let (frame, missing) = engine.resources.bind(&frame_state, is_first)?;
    let lacks_nothing = request_missing(state, engine, missing, &frame_state);
    let is_complete = lacks_nothing && frame_state.shaders.is_complete();
    state.picture.is_complete = is_complete;
    if let Some(frame) = frame {
        prepare(&frame)?;
        let generation = frame_state.shaders.generation;
        // A reload is reported first.
        let is_whole = frame_state.scene.as_ref().is_some_and(|scene| !scene.model().awaits_textures);
        let settles = is_complete && is_whole && state.first_frame.is_none();
        if settles && state.picture.settled.replace(generation) != Some(generation) {
            emit(&state.events, &Event::Settled { generation });
            check_exercise(state, engine);
        }
        let shown = LastComplete { settings: state.session.shared_settings(), frame: frame.clone() };
        follow_pin(state, &frame_state);
        state.picture.shown = Some(shown.description());
        let last = engine.shown.replace(shown);
        keep_version(state, engine, last);
        state.picture.shows_settings = lacks_nothing;
        return Ok(Some(frame));
    }
    let interim = engine.shown.as_ref().map(|shown| interim(state, shown, clock, size));
    interim.iter().try_for_each(prepare)?;
    Ok(interim)
}

/// The frame of another mode, drawn beside the selected one. Until its resources are there, it is `last` with the current
/// camera.
pub(in crate::app) fn frame_of_mode(
    state: &mut State,
    engine: &mut Engine,
    mode: &str,
    size: (u32, u32),
    last: Option<LastComplete>,
) -> Result<Option<LastComplete>, GpuError> {
    let selected = std::mem::replace(&mut state.session.settings.mode, mode.to_owned());
    let target = target(&engine.gpu, &state.session.settings, !state.has_window);
    let frame_state = state.session.frame_state(state.picture.clock, size, target);
    let settings = state.session.shared_settings();
    state.session.settings.mode = selected;
    let Some(frame_state) = frame_state else { return Ok(last) };
    let (frame, missing) = engine.resources.bind(&frame_state, false)?;
    if let Some(frame) = frame {
        return Ok(Some(LastComplete { settings, frame }));
    }
    // The main picture comes first.
    if state.picture.is_complete
        && !frame_state.pipelines.needs_pending(&frame_state.shaders)
        && missing.pipelines
        && let Some(set) = engine.resources.pipelines()
    {
        engine.threads.worker.build(set, &frame_state.pipelines);
    }
    Ok(last.map(|last| {
        let frame = interim(state, &last, state.picture.clock, size);
        LastComplete { frame, ..last }
    }))
}

/// Adds the shaders on screen to the versions if they are new, and keeps the last frame of the previous ones.
fn keep_version(state: &mut State, engine: &mut Engine, last: Option<LastComplete>) {
    let generation = state.shown_generation();
    let has_model = engine.shown.as_ref().is_some_and(|shown| shown.scene().is_some());
    if let Some(last) = last.filter(|last| last.scene().is_some() && last.frame.state.shaders.generation != generation)
    {
        let number = last.frame.state.shaders.generation;
        if state.versions.of_generation(number).is_some_and(|version| !version.is_cut_short()) {
            engine.generations.retire(last);
        }
    }
    let Some(set) = engine.resources.pipelines() else { return };
    if state.edits.restored.is_some() {
        state.versions.shows_again(&set.shaders);
    } else if has_model && state.versions.is_new(&set.shaders) {
        let edit = state.first_frame.as_ref().filter(|first| first.generation == generation);
        let reload = edit.map(|first| first.event.clone()).or_else(|| state.shader.last.clone()).unwrap_or_default();
        state.versions.add(&set.shaders, reload, state.edits.draft.is_some());
        engine.generations.add(set, &state.versions);
    }
}

/// The last good frame at this size and time. While the model is the same, camera and orbiting lights follow the current
/// settings, since they need no new resources. Everything else is unchanged.
pub(in crate::app) fn interim(state: &State, shown: &LastComplete, clock: Clock, size: (u32, u32)) -> BoundFrame {
    let same_model = match (shown.scene(), state.session.model()) {
        (Some(scene), Some(model)) => Arc::ptr_eq(scene.loaded(), model),
        (scene, model) => scene.is_none() && model.is_none(),
    };
    let frame_state = &shown.frame.state;
    shown.frame.with_state(match same_model {
        true => frame_state.moved(&shown.settings.placed_as(&state.session.settings), clock, size),
        false => frame_state.moved(&shown.settings, clock, size),
    })
}

/// The generation and picture, at `size`, of a version that lacks a thumbnail while the panel that shows them is open. All are the final
/// picture, so that they can be compared at a glance.
///
/// # Errors
/// No memory left.
pub(in crate::app) fn missing_thumbnail(
    state: &mut State,
    engine: &mut Engine,
    size: (u32, u32),
) -> Result<Option<(u64, BoundFrame)>, GpuError> {
    if !state.workspace.sight.timeline {
        return Ok(None);
    }
    let newest = state.shown_generation();
    // The thumbnail of the newest version waits until its lighting is complete.
    // A picture that moves has that of a moment.
    let is_complete = is_settled(state, engine) || moves(state) && lacks_nothing(state, engine);
    let shown = engine.shown.clone().filter(|shown| is_complete && shown.scene().is_some());
    let lacks: Vec<u64> = state.versions.without_thumbnail().map(|version| version.generation).collect();
    for generation in lacks {
        let picture =
            if generation == newest { shown.clone() } else { engine.generations.picture(generation).cloned() };
        let Some(picture) = picture else { continue };
        let last = interim(state, &picture, state.picture.clock, size);
        if picture.frame.state.mode().is_none_or(|mode| mode.slug == FINAL) {
            return Ok(Some((generation, last)));
        }
        let Some(set) = engine.generations.set(generation).cloned() else { continue };
        let settings = Settings { mode: FINAL.to_owned(), ..(*picture.settings).clone() };
        let settings = settings.placed_as(&state.session.settings);
        let now = std::mem::replace(&mut state.session.settings, settings);
        let target = picture.frame.state.pipelines.target;
        let final_state = state.session.frame_state_of(&set.shaders, state.picture.clock, size, target);
        state.session.settings = now;
        if let Some(frame) = engine.resources.bind_older(&set, &final_state, Some(&picture.frame))? {
            return Ok(Some((generation, frame)));
        }
        if set.bind(&final_state.pipelines).is_some() {
            // Its light is gone, so it has its last picture.
            return Ok(Some((generation, last)));
        }
        if state.picture.is_complete && !final_state.pipelines.needs_pending(&set.shaders) {
            engine.threads.worker.build(&set, &final_state.pipelines);
        }
    }
    Ok(None)
}

/// Tells the worker what the next reload is for.
fn follow_settings(state: &mut State, engine: &mut Engine, frame_state: &FrameState) {
    let (settings, scene) = (state.session.shared_settings(), frame_state.scene.clone());
    let suns = state.session.revisions.suns_of(&settings);
    engine.threads.worker.set_snapshot(Snapshot { settings, scene, target: frame_state.pipelines.target, suns });
    watch_expression(state, engine);
}

/// Requests the resources that a state lacks from the threads. Returns whether it is complete.
fn request_missing(state: &mut State, engine: &mut Engine, missing: Missing, frame_state: &FrameState) -> bool {
    let Some(set) = engine.resources.pipelines() else { return false };
    let is_empty = missing.is_empty();
    let baked = engine.resources.baked_environment();
    let of_edit = match (&missing.environment, baked) {
        (Some(wanted), Some((baked, _))) => baked.is_edit_of(wanted),
        (environment, _) => environment.is_none() && engine.resources.tables().is_some(),
    };
    // The stages that bake are compiled once the picture of an edit is on screen.
    let is_pending = frame_state.shaders.pending.iter().any(|path| path.starts_with("ibl/")) && !state.has_errors();
    let follows = is_pending && frame_state.environment.is_some();
    let waits = Waits::of(&missing, of_edit);
    state.picture.wait_for(waits.or(follows.then_some(Waits::Light { of_edit: true })));
    if missing.pipelines {
        engine.threads.worker.build(set, &frame_state.pipelines);
    }
    engine.threads.baker.bake_tables(set, missing.tables, &engine.resources);
    engine.threads.baker.bake(set, missing.environment, &engine.resources);
    engine.threads.baker.read(missing.measured);
    engine.threads.baker.build_path_tracing(missing.path_tracing);
    is_empty
}

/// The settings and the files of the picture on screen, from the current camera.
pub(in crate::app) fn shown_session_state(state: &State) -> SessionState {
    let now = &state.session.settings;
    let shown = state.picture.shown.as_ref().map_or(now, |shown| &*shown.settings);
    let settings = Settings { camera: now.camera.clone(), lights: now.lights.clone(), ..shown.clone() };
    SessionState { settings: Arc::new(settings), ..state.session_state() }
}
