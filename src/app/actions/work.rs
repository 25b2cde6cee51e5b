//! Remembers sessions that end, for later windows.

use crate::app::engine::Engine;
use crate::app::state::{State, last_session};

/// Whether the session differs from that of a plain start.
pub(in crate::app) fn has_work(state: &State) -> bool {
    state.plain.as_ref().is_none_or(|plain| !state.session_state().is_alike(plain))
}

/// Remembers the session, if there is anything to go on with.
pub(in crate::app) fn remember_session(state: &State) {
    if has_work(state) {
        last_session::remember(&state.session_state(), state.traces.file_shown());
    }
}

/// Remembers the session of a tree that is left, on a thread of its own.
pub(in crate::app) fn keep_session(state: &State, engine: &Engine) {
    if state.has_window && has_work(state) {
        let (work, file) = (state.session_state(), state.traces.file_shown().cloned());
        engine.threads.wait(move || {
            last_session::remember(&work, file.as_ref());
            None
        });
    }
}
