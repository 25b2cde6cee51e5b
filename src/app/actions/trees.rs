//! Shows another shader tree.

use std::path::Path;

use crate::app::actions::compare::change_tree;
use crate::app::actions::sessions::leave_exercise;
use crate::app::actions::watch::watch_tree;
use crate::app::engine::Engine;
use crate::app::source_line::stop;
use crate::app::state::State;
use crate::shader::Source;

/// Shows the shaders of the tree that was found, once they compile. `edits`: of [`crate::threads::worker::Worker::reloaded`].
pub(in crate::app) fn on_tree_found(
    state: &mut State,
    engine: &mut Engine,
    path: &Path,
    tree: Result<Source, String>,
    edits: u64,
) {
    let stops = std::mem::take(&mut state.edits.stops_watching);
    let source = match tree {
        Ok(source) => source,
        Err(message) => {
            state.waiting.tree_found(path, Err(&message));
            return state.say(message);
        }
    };
    state.waiting.tree_found(path, Ok(()));
    let watched = state.session.settings.expression.clone();
    if !state.learning.holds(source.location()) {
        leave_exercise(state, engine);
    }
    if stops {
        state.edits.leave(state.source.location(), &watched);
        stop(&mut state.session.settings);
        state.session.settings.expression = state.edits.come_back(source.location()).unwrap_or_default();
    }
    // Versions of another tree must never be written into this one.
    let tree = change_tree(state, engine, &source);
    state.shader.log.forget();
    state.source = source.clone();
    state.picture.settled = None;
    state.edits.forget_draft();
    // Nor is the text of a file that of the same file in another tree.
    state.traces.leave_tree();
    watch_tree(state, engine, &source);
    engine.threads.worker.open_tree(source, tree);
    engine.threads.worker.reloaded(edits);
    if state.has_window {
        engine.find_exercise(&state.source);
    }
}
