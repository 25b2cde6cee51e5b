//! Shows the model that the loader has read, before and after its textures, and reads changed files again.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::app::actions::compare::file::on_picture_changed;
use crate::app::actions::files::load_model;
use crate::app::actions::select::{follow_environment, follow_lights};
use crate::app::actions::watch::watch_files;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::recent::Kind;
use crate::app::state::selection::Selected;
use crate::message;
use crate::scene::{BUILT_IN, Model};
use crate::settings::{LightSource, SceneSettings};
use crate::threads::Loaded;

pub(in crate::app) fn on_loaded(state: &mut State, engine: &mut Engine, loaded: Loaded) {
    if !engine.threads.loader.is_newest(loaded.number) {
        return;
    }
    let awaits_textures = loaded.result.as_ref().is_ok_and(|uploaded| uploaded.model().awaits_textures);
    state.model.loading = awaits_textures;
    let added = state.model.added.take();
    match loaded.result {
        Ok(uploaded) => {
            // The pictures of older versions would keep the old model on the device.
            engine.generations.drop_pictures();
            engine.forget_second_picture();
            let (model, is_other_file) = (uploaded.model(), loaded.path != state.model.path);
            let is_other_scene = |before: &Model| before.contents.scene != model.contents.scene;
            let is_other = is_other_file || state.session.model().is_some_and(|before| is_other_scene(before));
            if let Some(mut added) = added {
                let before = &state.session.settings.added;
                // They may have been moved while the new one was loading.
                if added.len() > before.len() {
                    added.iter_mut().zip(before).for_each(|(model, before)| model.place = before.place);
                }
                let is_added = added != *before;
                state.session.settings.added = added;
                if is_added && !is_other && !state.model.keeps_camera {
                    state.frame_model();
                }
            }
            // A session that is restored brings its own settings.
            let is_restored = std::mem::take(&mut state.model.keeps_camera);
            if is_other && !is_restored {
                state.frame_model();
                // They name parts of the model before.
                state.session.settings.scene = SceneSettings::default();
                if is_other_file {
                    state.session.settings.materials.clear();
                }
            }
            let keeps_selection = |before| !is_other && state.selected.is_same(before, model);
            if !state.session.model().is_some_and(|before| keeps_selection(before)) {
                state.select(Selected::Nothing);
            }
            if !is_restored && (is_other || state.session.model().is_none()) {
                follow_lights(state, model);
                follow_environment(state, model);
            }
            state.model.awaits = awaits_textures.then_some(loaded.number);
            if let Some(path) = loaded.path.as_deref().filter(|path| !is_built_in(path)) {
                state.recent.remember(Kind::Model, path);
            }
            state.model.path = loaded.path;
            state.model.scene = state.load_options.scene;
            state.model.load_ms = loaded.ms;
            state.model.failure = None;
            state.model.files = model.files.as_slice().into();
            let is_next = is_other && state.session.model().is_some();
            state.session.set_model(model);
            if is_next && !state.shader.is_single_file {
                state.playback.begin();
            }
            if is_next && state.shader.is_single_file && !state.shader.compiling {
                let file = Path::new(&state.shader.tree).file_name().unwrap_or_default().to_string_lossy().into_owned();
                state.say(format!("{} is loaded, but {file} draws no model. Open a shader tree to see it", model.name));
            }
            engine.resources.set_model(&uploaded);
            if !awaits_textures {
                tell_problems(state, model);
            }
        }
        Err((message, tried)) => {
            state.model.keeps_camera = false;
            if added.is_some() {
                // Those that are on screen.
                state.load_options.added = state.session.settings.added_files();
            }
            // Watch the model on screen as well as the files that must be repaired.
            let on_screen = state.session.model().map(|model| model.files.clone()).unwrap_or_default();
            state.model.files = on_screen.iter().cloned().chain(tried).collect();
            if let Some(path) = &loaded.path {
                state.recent.forget(Kind::Model, path);
            }
            state.waiting.model_failed(&message);
            state.model.failure = state.session.model().is_none().then(|| message.clone());
            state.say(message);
            // The load that failed has ended the one that was decoding the textures of the model on screen.
            if state.model.awaits.take().is_some_and(|number| number != loaded.number) {
                state.load_options.scene = state.model.scene;
                load_model(state, engine, state.model.path.clone());
            }
        }
    }
    watch_files(state, engine);
}

/// Tells the user of everything in a model, and in settings for it, that cannot be shown.
fn tell_problems(state: &mut State, model: &Model) {
    for warning in model.warnings.iter() {
        message::warn(format_args!("{}: {warning}", model.name));
    }
    state.model.shows_warnings = true;
    let settings = &state.session.settings;
    let has_no_lights = settings.lights.source == LightSource::Model && model.lights.is_empty();
    let lights =
        has_no_lights.then(|| format!("warning: {} has no lights of its own for `--lights model`", model.name));
    let unknown = model.unknown_part(&settings.scene);
    let unknown = unknown.or_else(|| model.unknown_material(settings.materials.keys()));
    let unknown = unknown.or_else(|| model.unknown_clip(&settings.animation));
    let unknown = unknown.or_else(|| model.unknown_target(&settings.animation));
    lights.into_iter().chain(unknown).for_each(|problem| state.say(problem));
}

/// Handles changed files of the environment, the measured BRDF or the model.
pub(in crate::app) fn on_files_changed(state: &mut State, engine: &mut Engine, changed: &BTreeSet<PathBuf>) {
    let (environment, measured) = (state.session.environment_files(), state.session.measured_files());
    let is_changed = |files: &[PathBuf]| files.iter().any(|file| changed.contains(file));
    if is_changed(&environment) {
        state.session.revisions.environment += 1;
    }
    if is_changed(&measured) {
        state.session.revisions.measured += 1;
    }
    on_picture_changed(state, engine, changed);
    if is_changed(&state.model.files) {
        let on_screen = state.session.model().is_some_and(|model| is_changed(&model.files));
        let is_shown = on_screen && !state.model.loading;
        let path = if is_shown { &state.model.path } else { &state.model.requested }.clone();
        if is_shown {
            state.load_options.scene = state.model.scene;
        }
        load_model(state, engine, path);
    }
}

/// Whether a path is the name of a built-in model.
fn is_built_in(path: &Path) -> bool {
    BUILT_IN.iter().any(|name| Path::new(name) == path)
}
