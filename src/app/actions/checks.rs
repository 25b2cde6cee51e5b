//! Has the picture checked while it rests: its assertions, and, if the user wants that, its undefined operations.

use std::sync::Arc;
use std::time::Duration;

use super::trace::{REST, REST_ON_CPU, final_picture};
use crate::app::engine::Engine;
use crate::app::frames::progress::moves;
use crate::app::state::State;
use crate::app::state::checks::CheckProgress;
use crate::events::{Event, emit};
use crate::headless::CheckedPicture;
use crate::settings::Checks;
use crate::shader::TreePath;
use crate::threads::operation_checker::OperationCheck;

/// Asks for the checks of the picture if they are missing. Returns the time until that is to be looked at again.
pub(in crate::app) fn update_checks(state: &mut State, engine: &mut Engine, is_safe_mode: bool) -> Option<Duration> {
    let wanted = state.session.settings.view.checks;
    let is_wanted = match (wanted, &state.session.shaders) {
        _ if is_safe_mode => false,
        (Checks::Off, _) | (_, None) => false,
        (Checks::Assertions, Some(shaders)) => state.checks.has_asserts(shaders),
        (Checks::Undefined, Some(_)) => true,
    };
    if !is_wanted {
        state.checks.forget();
        engine.threads.operation_checker.release();
        return None;
    }
    let moment = state.checks.moment().filter(|_| moves(state)).cloned();
    let Some(subject) = final_picture(state, engine, moment.as_ref()) else {
        state.checks.set(CheckProgress::Waits);
        return None;
    };
    if state.checks.asked() == Some(&subject) {
        state.checks.resume();
        seek(state);
        return None;
    }
    let rest = if engine.gpu_is_fast() { REST } else { REST_ON_CPU };
    // Settings of a moving picture may change in each of its frames.
    if let Some(left) = state.checks.rest_left(&subject, rest).filter(|_| !moves(state)) {
        state.checks.set(CheckProgress::Waits);
        return Some(left);
    }
    let mut session = state.session.clone();
    session.settings.clone_from(&subject.settings);
    let request = OperationCheck {
        compiler: engine.compiler.clone(),
        session,
        resources: engine.resources.clone(),
        source: state.source.clone(),
        clock: subject.clock,
        size: subject.size,
        undefined: wanted == Checks::Undefined,
    };
    let number = engine.threads.operation_checker.check(request);
    state.checks.ask(subject, number);
    None
}

/// Pins the first pixel that fails, if the user wants that and the panel Source is open, and shows its line there.
fn seek(state: &mut State) {
    if !state.checks.seeks || !state.workspace.sight.source || state.checks.of_picture().is_none() {
        return;
    }
    (state.checks.seeks, state.checks.redraws) = (false, true);
    if let Some((at, broken)) = state.checks.first_mark() {
        let file = TreePath::from(broken.file.as_str());
        (state.inspection.pin, state.traces.stage, state.traces.file) = (Some(at), None, Some(file));
    }
}

/// Takes the result of checks.
pub(in crate::app) fn on_operations_checked(
    state: &mut State,
    number: u64,
    result: Result<Arc<CheckedPicture>, String>,
) {
    let generation = state.checks.asked().map_or(0, |asked| asked.shaders.generation);
    let error = result.as_ref().err().cloned();
    if !state.checks.take(number, result) {
        return;
    }
    let found = state.checks.newest().and_then(|result| result.as_ref().ok()).map(|picture| picture.json());
    emit(&state.events, &Event::Checked { generation, found, error: error.as_deref() });
}
