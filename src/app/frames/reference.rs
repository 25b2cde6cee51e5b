//! The other picture of a comparison, and those of all versions.

use crate::app::actions::compare::tree::snapshot;
use crate::app::engine::Engine;
use crate::app::engine::compared::{Compared, LastAsked};
use crate::app::frames::picture::interim;
use crate::app::screen::Reference;
use crate::app::state::State;
use crate::app::state::compare::With;
use crate::app::state::shaders::versions::Version;
use crate::capture::VersionPicture;
use crate::frame::FrameState;
use crate::gpu::GpuError;
use crate::render::BoundFrame;
use crate::shader::ShaderSet;
use crate::threads::second_tree::Needs;
use std::sync::Arc;

/// The other picture with the camera of now. An older version and a second tree follow all settings as soon as their pipelines for
/// them are built; until then, and with settings that need another light, it is the last picture that they had on screen.
///
/// # Errors
/// No memory left.
pub(in crate::app) fn reference(
    state: &mut State,
    engine: &mut Engine,
    live: &BoundFrame,
) -> Result<Option<Reference>, GpuError> {
    let part = if state.compare.is_held { 1.0 } else { state.compare.wipe };
    let drawn = |frame| Reference { frame, still: None, part };
    let reference = match (&state.compare.with, &engine.compared) {
        (_, Compared::Kept(kept)) => Some(drawn(interim(state, kept, state.picture.clock, live.state.size))),
        (_, Compared::File(_)) => {
            let still = engine.picture_that_fits(live.state.size);
            still.map(|still| Reference { frame: live.clone(), still: Some(still), part })
        }
        (_, Compared::Tree(_)) => picture_of_tree(state, engine, live)?.map(drawn),
        (&Some(With::Version(number)), _) => picture_of_version(state, engine, Some(number), live)?.map(drawn),
        _ => {
            let before = state.version_before().filter(|_| state.compare.is_held);
            picture_of_version(state, engine, before, live)?.map(drawn)
        }
    };
    state.compare.is_drawn = reference.is_some();
    Ok(reference)
}

fn picture_of_version(
    state: &mut State,
    engine: &mut Engine,
    number: Option<u64>,
    live: &BoundFrame,
) -> Result<Option<BoundFrame>, GpuError> {
    let Some(version) = number.and_then(|number| state.versions.get(number)) else {
        state.compare.with = None;
        return Ok(None);
    };
    let Some(set) = engine.generations.set(version.generation).cloned() else { return Ok(None) };
    let like = engine.generations.picture(version.generation).map(|picture| picture.frame.clone());
    let frame_state = state_like(state, live, &set.shaders);
    if let Some(frame) = engine.resources.bind_older(&set, &frame_state, like.as_ref())? {
        return Ok(Some(frame));
    }
    if state.picture.is_complete && !frame_state.pipelines.needs_pending(&set.shaders) {
        engine.threads.worker.build(&set, &frame_state.pipelines);
    }
    let picture = engine.generations.picture(set.shaders.generation);
    Ok(picture.map(|picture| interim(state, picture, state.picture.clock, live.state.size)))
}

/// The picture of now with other shaders.
fn state_like(state: &mut State, live: &BoundFrame, shaders: &Arc<ShaderSet>) -> Arc<FrameState> {
    // The mouse may preview a mode.
    let mode = live.state.mode().map_or_else(|| state.session.settings.mode.clone(), |mode| mode.slug.clone());
    let selected = std::mem::replace(&mut state.session.settings.mode, mode);
    let frame_state =
        state.session.frame_state_of(shaders, state.picture.clock, live.state.size, live.state.pipelines.target);
    state.session.settings.mode = selected;
    frame_state
}

/// Inputs for a picture of each version, oldest first.
pub(in crate::app) fn version_pictures(state: &State, engine: &Engine) -> Vec<VersionPicture> {
    let newest = state.shown_generation();
    let versions = state
        .versions
        .iter()
        .filter(|version| version.generation == newest || state.versions.can_show(version, newest));
    let of = |version: &Version| {
        let set = engine.generations.set(version.generation)?.clone();
        let picture = engine.generations.picture(version.generation);
        let picture = picture.or(engine.shown.as_ref().filter(|_| version.generation == newest));
        let label = format!("{}   {}", version.number, version.title());
        Some(VersionPicture { set, label, like: picture.map(|picture| picture.frame.clone()) })
    };
    versions.filter_map(of).collect()
}

/// Renders the second tree with the current settings once its resources are ready.
pub(in crate::app) fn picture_of_tree(
    state: &mut State,
    engine: &mut Engine,
    live: &BoundFrame,
) -> Result<Option<BoundFrame>, GpuError> {
    let Compared::Tree(tree) = &engine.compared else { return Ok(None) };
    let Some(set) = tree.set.clone() else { return Ok(None) };
    let like = tree.like.as_ref().map(|like| like.frame.clone());
    let frame_state = state_like(state, live, &set.shaders);
    let is_pending = frame_state.pipelines.needs_pending(&set.shaders);
    if !is_pending && let Some(frame) = engine.resources.bind_older(&set, &frame_state, like.as_ref())? {
        return Ok(Some(frame));
    }
    // The main picture comes first, and its light is likely to be the second tree's as well.
    let snapshot = (state.picture.is_complete && !is_pending).then(|| {
        let mut snapshot = snapshot(state, engine);
        // The mouse may preview a mode.
        if let Some(mode) = live.state.mode() {
            Arc::make_mut(&mut snapshot.settings).mode.clone_from(&mode.slug);
        }
        snapshot
    });
    let Compared::Tree(tree) = &mut engine.compared else { return Ok(None) };
    let is_asked = tree.asked.as_ref().is_some_and(|asked| asked.has_needs_of(&frame_state));
    if let Some(snapshot) = snapshot.filter(|_| !is_asked) {
        let resources = engine.resources.clone();
        tree.tree.provide(Needs { snapshot: snapshot.clone(), resources, set, state: frame_state.clone() });
        tree.asked = Some(LastAsked { state: frame_state, snapshot });
    }
    let Compared::Tree(tree) = &engine.compared else { return Ok(None) };
    Ok(tree.like.as_ref().map(|like| interim(state, like, state.picture.clock, live.state.size)))
}
