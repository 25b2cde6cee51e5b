//! Watches the files that the window shows.

use crate::app::engine::Engine;
use crate::app::state::State;
use crate::shader::Source;

/// Watches the shader tree.
pub(in crate::app) fn watch_tree(state: &mut State, engine: &mut Engine, source: &Source) {
    if let Err(message) = engine.threads.watch_tree(source) {
        state.say(message);
    }
}

/// Watches the files of the model, the environment, the measured BRDF and the compared picture.
pub(in crate::app) fn watch_files(state: &mut State, engine: &mut Engine) {
    let session = &state.session;
    let look_up = || session.environment_files().into_iter().chain(session.measured_files()).collect();
    let files = state.watched.changed(&session.settings, &state.model.files, state.compare.files(), look_up);
    if let Some(Err(message)) = files.map(|files| engine.threads.watch_files(files)) {
        state.say(message);
    }
}
