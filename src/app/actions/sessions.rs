//! Goes on with the last session of the working directory, and remembers this one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::actions::files::{find_tree, load_model};
use crate::app::actions::work::has_work;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::workspace::PanelRequest;
use crate::events::{Event, emit};
use crate::picture::Look;
use crate::recovery::SessionState;
use crate::scene::BUILT_IN;
use crate::settings::Settings;

/// Reports the loss that ended the previous process.
pub(in crate::app) fn report_loss(state: &mut State, engine: &Engine) {
    let recorded = engine.recorder.state();
    let Some(loss) = &recorded.loss else { return };
    let refused = recorded.quarantined.keys().map(String::as_str).collect();
    let event = Event::Restarted { cause: &loss.cause, losses: recorded.losses, refused, reset: &loss.reset };
    emit(&state.events, &event);
    match loss.reset.as_slice() {
        [] => state.notices.say(format!("{}. The session goes on.", capitalized(&loss.cause))),
        reset => {
            let values = reset.join(", ");
            let cause = capitalized(&loss.cause);
            state.keep_saying(format!("{cause}. The session goes on with the last good value of {values}."));
        }
    }
}

/// Goes on with the last session, as it was left.
pub(in crate::app) fn restore_session(state: &mut State, engine: &mut Engine) {
    let Some(last) = state.last_sessions.here.clone() else {
        return state.say("There is no session to restore");
    };
    state.traces.file = last.file();
    go_to(state, engine, last.work);
    state.offers_session = false;
}

/// Shows the look of a file: its settings, and the model and the shaders that it names. Returns the model that has to be loaded.
pub(in crate::app) fn show_look(state: &mut State, engine: &mut Engine, look: Look) -> Option<PathBuf> {
    let now = state.session_state();
    let model = match &look.model {
        Some(model) => (model != Path::new(BUILT_IN[0])).then(|| model.clone()),
        None => now.model.clone(),
    };
    let scene = if look.model.is_some() { look.scene } else { now.scene };
    let loads = scene != now.scene
        || look.settings.added_files() != now.settings.added_files()
        || is_other(model.as_deref(), now.model.as_deref());
    let tree = look.shaders.or(now.tree);
    let mut settings = look.settings;
    // Without names, a look says nothing about clips: it may have been made with a model without any.
    if look.model.is_none() && settings.animation.clips.is_empty() {
        settings.animation.clips.clone_from(&now.settings.animation.clips);
    }
    go_to(state, engine, SessionState { settings: Arc::new(settings), model: model.clone(), scene, tree });
    loads.then(|| model.unwrap_or_else(|| BUILT_IN[0].into()))
}

/// Shows other work. The camera is that of the work, and not one that frames the model.
fn go_to(state: &mut State, engine: &mut Engine, SessionState { settings, model, scene, tree }: SessionState) {
    let now = state.session_state();
    if let Some(tree) = tree.filter(|tree| is_other(Some(tree), now.tree.as_deref())) {
        state.learning.before = None;
        find_tree(state, engine, &full_path(&tree));
    }
    state.session.settings = Arc::unwrap_or_clone(settings);
    let added = state.session.settings.added_files();
    if scene != now.scene || added != now.settings.added_files() || is_other(model.as_deref(), now.model.as_deref()) {
        state.load_options.scene = scene;
        state.load_options.added = added;
        state.model.added = None;
        state.model.keeps_camera = true;
        load_model(state, engine, model);
    }
}

/// Offers the last session no longer once the user has done anything that is worth keeping.
pub(in crate::app) fn update_offer(state: &mut State) {
    state.offers_session = state.offers_session && state.last_sessions.here.is_some() && !has_work(state);
}

/// Goes on with the session before the exercises: with its panels, and with its model unless another one was opened since.
pub(in crate::app) fn leave_exercise(state: &mut State, engine: &mut Engine) {
    let Some(before) = state.learning.before.take() else { return };
    state.workspace.request(PanelRequest::ArrangeAsBefore);
    let now = state.session_state();
    let default = Path::new(BUILT_IN[0]);
    let of_exercise = state.learning.exercise.as_ref().map(|exercise| Path::new(&exercise.model));
    if of_exercise == Some(now.model.as_deref().unwrap_or(default)) {
        return go_to(state, engine, SessionState { tree: None, ..before });
    }
    let Settings { camera, scene, materials, model, animation, variant, added, .. } = Settings::clone(&now.settings);
    let settings = Arc::unwrap_or_clone(before.settings);
    state.session.settings = Settings { camera, scene, materials, model, animation, variant, added, ..settings };
}

/// A path in full, through symbolic links; the name of something built in as it is.
fn full_path(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

fn is_other(a: Option<&Path>, b: Option<&Path>) -> bool {
    a.map(full_path) != b.map(full_path)
}

/// The text with a capital at its start.
fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().into_iter().flat_map(char::to_uppercase).chain(characters).collect()
}
