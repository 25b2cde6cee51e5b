//! Has the pinned pixel traced while the panel Source, or the list of the evaluations of an expression, is in sight.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::app::engine::Engine;
use crate::app::frames::progress::{awaits_edit, is_settled, lacks_nothing, moves};
use crate::app::state::State;
use crate::app::state::picture_subject::PictureSubject;
use crate::app::state::trace::Progress;
use crate::app::state::trace::preparation::Preparation;
use crate::app::state::trace::subject::Subject;
use crate::events::{Event, emit};
use crate::headless::Prepared;
use crate::identity::Identity;
use crate::settings::{ExpressionSettings, Settings};
use crate::shader::{Severity, TreePath, expression};
use crate::threads::tracer::{OlderVersion, TraceRequest};
use crate::threads::{Message, Traced};

/// How long settings must not change before the pixel is traced with them.
pub(in crate::app) const REST: Duration = Duration::from_millis(150);
/// The same on a software device, whose frames a trace holds up.
pub(in crate::app) const REST_ON_CPU: Duration = Duration::from_millis(400);

/// Kinds of material for which modules are compiled before a click. A software device takes a second for each.
const MOST_PREPARED: usize = 32;
const MOST_PREPARED_ON_CPU: usize = 4;

/// Asks for a trace if that of the picture is missing. Returns the time until it is to be looked at again.
pub(in crate::app) fn update_trace(state: &mut State, engine: &mut Engine, is_safe_mode: bool) -> Option<Duration> {
    let sight = &state.workspace.sight;
    if !(sight.source || sight.evaluations.is_some()) || is_safe_mode {
        state.traces.unseen();
        if is_safe_mode {
            state.traces.progress = Progress::AfterLoss;
        }
        engine.threads.tracer.release();
        return None;
    }
    read_saved(state, engine);
    let Some(at) = state.inspection.pin else {
        state.traces.progress = Progress::NoPixel;
        return prepare(state, engine);
    };
    if state.shown().is_some_and(|shown| at[0] >= shown.size.0 || at[1] >= shown.size.1) {
        state.traces.progress = Progress::Outside;
        return prepare(state, engine);
    }
    let Some(subject) = subject(state, engine, at) else {
        state.traces.progress = Progress::Waits;
        return None;
    };
    if state.traces.asked() == Some(&subject) {
        state.traces.resume();
        ask_around(state, engine);
        return prepare(state, engine);
    }
    let rest = if engine.gpu_is_fast() { REST } else { REST_ON_CPU };
    if let Some(left) = state.traces.rest_left(&subject, rest) {
        state.traces.progress = Progress::Waits;
        return Some(left);
    }
    let before = if state.traces.lacks_before(&subject) { version_before(state, engine) } else { None };
    let place = (subject.stage.clone(), subject.file.as_ref());
    let request = request_of(state, engine, &subject.picture, subject.at, place);
    let with_before = before.is_some();
    let number = engine.threads.tracer.trace(request, before);
    if state.edits.draft.is_some() {
        state.traces.drafted.insert(subject.picture.shaders.generation);
    }
    state.traces.ask(subject, number, with_before);
    None
}

/// Has what the next click needs compiled, if the thread is free. Returns the time until it is to be looked at again.
fn prepare(state: &mut State, engine: &mut Engine) -> Option<Duration> {
    // Each number that is dragged is a generation of its own.
    if !state.workspace.sight.source || state.traces.is_under_way() || state.edits.draft.is_some() {
        return None;
    }
    let size = state.shown()?.size;
    let at = state.inspection.pin.filter(|at| at[0] < size.0 && at[1] < size.1).unwrap_or([size.0 / 2, size.1 / 2]);
    let Subject { picture, at, stage, file } = subject(state, engine, at)?;
    let pipelines = state.shown()?.pipelines.clone();
    let next = Preparation { generation: picture.shaders.generation, pipelines, stage, file };
    let rest = if engine.gpu_is_fast() { REST } else { REST_ON_CPU };
    let left = state.traces.preparations.left(&next, rest)?;
    if !left.is_zero() {
        return Some(left);
    }
    let most = if engine.gpu_is_fast() { MOST_PREPARED } else { MOST_PREPARED_ON_CPU };
    let request = request_of(state, engine, &picture, at, (next.stage.clone(), next.file.as_ref()));
    let number = engine.threads.tracer.prepare(request, most);
    state.traces.preparations.ask(next, number);
    None
}

/// Tells programs that a click finds what it needs.
pub(in crate::app) fn on_trace_prepared(state: &mut State, number: u64, prepared: Result<Prepared, String>, ms: f64) {
    let Some(preparation) = state.traces.preparations.take(number) else { return };
    let found = prepared.as_ref().ok();
    let event = Event::Prepared {
        generation: preparation.generation,
        stage: found.map(|found| found.stage.as_str()),
        file: found.map(|found| found.file.as_str()),
        built: found.map_or(0, |found| found.built),
        error: prepared.as_ref().err().map(String::as_str),
        ms,
    };
    emit(&state.events, &event);
}

/// Asks for the values around the pixel, while the mouse is on one of its values. When it leaves, they are no longer needed.
fn ask_around(state: &mut State, engine: &mut Engine) {
    if !state.workspace.sight.around {
        if state.traces.leave_around() {
            engine.threads.tracer.cancel();
            state.traces.preparations.interrupt();
        }
        return;
    }
    let Some(newest) = state.traces.lacks_around() else { return };
    let place = (Some(newest.stage.clone()), Some(&newest.file));
    let request = request_of(state, engine, &newest.of.picture, newest.of.at, place);
    let number = engine.threads.tracer.trace_around(request);
    state.traces.preparations.interrupt();
    state.traces.around.ask(&newest, number);
}

/// The request to trace a pixel of a picture.
pub(in crate::app) fn request_of(
    state: &State,
    engine: &Engine,
    picture: &PictureSubject,
    at: [u32; 2],
    (stage, file): (Option<String>, Option<&TreePath>),
) -> TraceRequest {
    let mut session = state.session.clone();
    session.settings.clone_from(&picture.settings);
    TraceRequest {
        compiler: engine.compiler.clone(),
        session,
        resources: engine.resources.clone(),
        source: state.source.clone(),
        clock: picture.clock,
        size: picture.size,
        at: at.into(),
        stage,
        file: file.map(|file| file.as_str().to_owned()),
    }
}

/// Has the shown file read while the shaders in use have older texts: there are errors, also of other files, or comments alone were edited.
fn read_saved(state: &mut State, engine: &Engine) {
    if !state.has_errors() && !state.traces.saved.is_behind() {
        return state.traces.saved.forget();
    }
    let Some(path) = state.traces.file_shown().cloned().or_else(|| state.file_of_picture()) else { return };
    let errors = state.session.diagnostics.iter().filter(|found| found.severity == Severity::Error);
    let last_edit = state.shader.log.edits().next().map(|edit| edit.at);
    if !state.traces.saved.lacks(&path, errors, last_edit) {
        return;
    }
    let source = state.source.clone();
    engine.threads.wait(move || {
        let text = source.author_text(&path).ok()?;
        Some(Message::SourceText(path, text.into()))
    });
}

/// The pixel, the stage and the frame to trace; `None` while the picture is not final.
fn subject(state: &State, engine: &Engine, at: [u32; 2]) -> Option<Subject> {
    // While the picture moves, the trace of a moment stays: that of a click, so that an edit shows its values before and after at one time.
    let is_old = engine.gpu_is_fast() && state.traces.before().is_none() && state.traces.is_old();
    let last = state.traces.asked().filter(|asked| moves(state) && asked.at == at && !is_old);
    let last = last.map(|asked| &asked.picture);
    let picture = final_picture(state, engine, last)?;
    let shown = state.shown()?;
    let sight = &state.workspace.sight;
    if let Some(file) = sight.evaluations.clone().filter(|_| !sight.source) {
        return Some(Subject { picture, at, stage: None, file: Some(file) });
    }
    // A picture may lack the stage that was chosen in another.
    let stage = state.traces.stage.clone().filter(|stage| shown.pipelines.stages().contains(stage));
    // The stage around a single file is not what the user has written.
    let opened = || state.source.opened().filter(|_| stage.is_none());
    let file = state.traces.file.clone().or_else(opened);
    Some(Subject { picture, at, stage, file })
}

/// The picture on screen; `None` while it is not final. `moment`: an earlier one, of the same moving picture.
pub(in crate::app) fn final_picture(
    state: &State,
    engine: &Engine,
    moment: Option<&PictureSubject>,
) -> Option<PictureSubject> {
    let (shown, shaders) = (state.shown()?, state.session.shaders.clone()?);
    // The picture of the tree before stays while a new one does not compile.
    let is_final = state.is_tree_in_use()
        && shown.shaders.generation == shaders.generation
        && shaders.is_complete()
        && !awaits_edit(state, engine)
        && (is_settled(state, engine) || moves(state) && lacks_nothing(state, engine));
    if !is_final {
        return None;
    }
    let now = settings(state);
    let same = moment.filter(|moment| is_same_but_lights(moment, &now)).map(|moment| moment.settings.clone());
    Some(PictureSubject {
        size: shown.size,
        settings: same.unwrap_or(now),
        shaders,
        revisions: state.session.revisions,
        model: Identity::of_any(state.session.model()),
        light: Identity::of(engine.resources.environment()),
        clock: moment.map_or(state.picture.clock, |moment| moment.clock),
    })
}

/// The settings of the traced picture. While an expression is watched, that is the picture without it.
fn settings(state: &State) -> Arc<Settings> {
    let shared = state.session.shared_settings();
    if shared.expression == ExpressionSettings::default() && shared.mode != expression::MODE {
        return shared;
    }
    let mode = if shared.mode == expression::MODE { Settings::default().mode } else { shared.mode.clone() };
    Arc::new(Settings { mode, expression: ExpressionSettings::default(), ..Settings::clone(&shared) })
}

/// Whether settings differ from those of a trace in the places of the orbiting lights alone.
fn is_same_but_lights(last: &PictureSubject, now: &Settings) -> bool {
    let mut now = now.clone();
    now.lights.orbit.clone_from(&last.settings.lights.orbit);
    now == *last.settings
}

/// The version before that on screen.
fn version_before(state: &State, engine: &Engine) -> Option<OlderVersion> {
    version_of(state, engine, state.versions.before(state.shown_generation())?.number)
}

/// The version with a number, if it can be drawn beside that on screen.
pub(in crate::app) fn version_of(state: &State, engine: &Engine, number: u64) -> Option<OlderVersion> {
    let version = state.versions.get(number)?;
    if !state.versions.can_show(version, state.shown_generation()) {
        return None;
    }
    let set = engine.generations.set(version.generation)?.clone();
    let like = engine.generations.picture(version.generation).map(|picture| picture.frame.clone());
    Some(OlderVersion { shaders: version.shaders.clone(), set, like })
}

/// Takes the result of a trace.
pub(in crate::app) fn on_traced(state: &mut State, number: u64, traced: Traced) {
    let Traced { place, trace, built, ms } = traced;
    if !state.traces.take(number, place, trace) {
        return;
    }
    state.traces.taken = Some((Instant::now(), Duration::from_secs_f64(ms / 1e3)));
    let Some(newest) = state.traces.newest() else { return };
    let fragment = newest.trace.as_ref().ok().and_then(|trace| Some((trace, trace.visible()?)));
    let event = Event::Traced {
        pixel: newest.of.at,
        generation: newest.of.picture.shaders.generation,
        stage: &newest.stage,
        file: newest.file.as_str(),
        equal: fragment.map(|(trace, fragment)| trace.is_proven(fragment)),
        error: newest.trace.as_ref().err().map(String::as_str),
        built,
        ms,
    };
    emit(&state.events, &event);
}
