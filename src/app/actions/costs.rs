//! Has times measured while the picture rests: what functions cost, if the user asks for that, and how much the version that is compared
//! with, or the one before, differs from the newest.

use std::sync::Arc;
use std::time::Duration;

use super::trace::{final_picture, version_of};
use crate::app::engine::Engine;
use crate::app::frames::progress::moves;
use crate::app::state::State;
use crate::app::state::costs::Question;
use crate::app::state::picture_subject::PictureSubject;
use crate::events::{Event, emit};
use crate::headless::StageCosts;
use crate::statistics::Difference;
use crate::threads::timekeeper::{TimeQuestion, TimedPicture};

/// How long the picture must not change before it is measured: measuring takes the device from everything else.
const REST: Duration = Duration::from_millis(600);
/// Most pairs of frames, on a GPU and on a software device.
const MOST: usize = 256;
const MOST_ON_CPU: usize = 32;

/// Asks for times that are missing. Returns the time until that is to be looked at again.
pub(in crate::app) fn update_costs(state: &mut State, engine: &mut Engine, is_safe_mode: bool) -> Option<Duration> {
    let Some(picture) = final_picture(state, engine, None) else {
        stop(state, engine);
        return None;
    };
    state.costs.keep(&picture);
    if is_safe_mode {
        stop(state, engine);
        state.costs.refuse(picture, "nothing is measured in safe mode");
        return None;
    }
    if moves(state) {
        stop(state, engine);
        state.costs.refuse(picture, "the picture moves, so its frames differ: pause it first");
        return None;
    }
    let question = state.costs.question(&picture, version_in_sight(state));
    let Some(question) = question else {
        // The memory of the last measurement.
        stop(state, engine);
        engine.threads.timekeeper.release();
        return None;
    };
    if state.costs.is_asked(&picture, &question) {
        return None;
    }
    stop(state, engine);
    if let Some(left) = state.costs.rest_left(&picture, &question, REST) {
        return Some(left);
    }
    ask(state, engine, picture, question);
    None
}

/// Ends what is being measured: the picture has changed.
fn stop(state: &mut State, engine: &mut Engine) {
    if state.costs.stop() {
        engine.threads.timekeeper.release();
    }
}

/// The version whose time is shown: the one that is compared with, or the one before that on screen, while the panel Timeline is in sight.
fn version_in_sight(state: &State) -> Option<u64> {
    let before = || state.versions.before(state.shown_generation()).map(|version| version.number);
    let of_timeline = || state.workspace.sight.timeline.then(before).flatten();
    state.compare.version().or_else(of_timeline)
}

fn ask(state: &mut State, engine: &mut Engine, picture: PictureSubject, question: Question) {
    let Some(target) = state.shown().map(|shown| shown.pipelines.target) else { return };
    let of_thread = match &question {
        Question::Functions(wanted) => TimeQuestion::Functions(wanted.stage.clone(), wanted.functions.clone()),
        Question::Version(number) => {
            // Dropped for memory, or a loop did not end in it.
            let Some(older) = version_of(state, engine, *number) else { return };
            TimeQuestion::Version(older)
        }
    };
    let mut session = state.session.clone();
    session.settings.clone_from(&picture.settings);
    let request = TimedPicture {
        compiler: engine.compiler.clone(),
        session,
        resources: engine.resources.clone(),
        source: state.source.clone(),
        clock: picture.clock,
        size: picture.size,
        target,
        most: if engine.gpu_is_fast() { MOST } else { MOST_ON_CPU },
    };
    let number = engine.threads.timekeeper.measure(request, of_thread);
    state.costs.ask(picture, question, number);
}

/// Takes what functions cost.
pub(in crate::app) fn on_functions_timed(state: &mut State, number: u64, result: Result<Arc<StageCosts>, String>) {
    let (found, error) = (result.as_ref().ok().map(|costs| costs.json()), result.as_ref().err().cloned());
    if state.costs.take_functions(number, result) {
        emit(&state.events, &Event::Costs { generation: state.shown_generation(), found, error: error.as_deref() });
    }
}

/// Takes how much a version differs from the newest.
pub(in crate::app) fn on_version_timed(state: &mut State, number: u64, result: Result<Difference, String>) {
    let (found, error) = (result.as_ref().ok().copied(), result.as_ref().err().cloned());
    let Some(version) = state.costs.take_version(number, result) else { return };
    let generation = state.shown_generation();
    let text = found.map(|found| found.text());
    let event = Event::Timed { generation, version, text: text.as_deref(), difference: found, error: error.as_deref() };
    emit(&state.events, &event);
}
