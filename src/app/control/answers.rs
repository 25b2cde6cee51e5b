//! Answers commands from outside once the last frame has done them.

use serde_json::{Value, json};

use super::captures::begin_capture;
use super::compare::compare_json;
use super::requests::short;
use crate::app::engine::Engine;
use crate::app::frames::progress::is_settled;
use crate::app::state::State;
use crate::app::state::waiting::{Shot, Until};
use crate::control::Reply;
use crate::shader::Diagnostic;

/// Answers the commands that the last frame has done.
pub(in crate::app) fn answer(state: &mut State, engine: &mut Engine) {
    if state.waiting.is_empty() {
        return;
    }
    let settled = is_settled(state, engine);
    for (reply, until) in state.waiting.take() {
        match until {
            Until::Shown if settled => reply.done(Value::Null),
            Until::Camera if settled => reply.done(camera_json(state)),
            Until::Grid if settled => reply.done(json!({ "modes": state.grid.modes() })),
            Until::Compared if settled && state.compare.is_drawn() => reply.done(compare_json(state)),
            Until::Picture(job) if settled => begin_capture(state, engine, reply, job),
            Until::Reloaded if settled || (state.has_errors() && !engine.threads.worker.is_compiling()) => {
                reloaded(state, reply);
            }
            Until::Model(path) if !state.model.loading => match state.model.is_file(&path) {
                true => state.waiting.push(reply, Until::Shown),
                false => reply.error(format!("{} was not loaded", path.display())),
            },
            Until::Shown | Until::Camera | Until::Grid | Until::Picture(_) | Until::Screen(_) | Until::Window(_)
                if never_shows(state, engine) =>
            {
                without_picture(state, reply);
            }
            until => state.waiting.push(reply, until),
        }
    }
}

/// Whether another frame must follow, because a command waits for nothing else. Messages wake the window for all others.
pub(in crate::app) fn has_unanswered(state: &State, engine: &Engine) -> bool {
    is_settled(state, engine) && state.waiting.needs_frame()
}

/// The pictures of the screen that can be taken now: its frame is final.
pub(in crate::app) fn take_shots(state: &mut State, engine: &Engine) -> Vec<Shot> {
    if !is_settled(state, engine) {
        return Vec::new();
    }
    std::iter::from_fn(|| state.waiting.take_shot(false)).collect()
}

/// The picture of the window that can be taken now.
pub(in crate::app) fn take_window_shot(state: &mut State, engine: &Engine) -> Option<Shot> {
    if is_settled(state, engine) { state.waiting.take_shot(true) } else { None }
}

/// Whether there are no shaders, and an edit is needed before there are.
fn never_shows(state: &State, engine: &Engine) -> bool {
    state.session.shaders.is_none() && !engine.threads.worker.is_compiling() && state.has_errors()
}

/// Answers a reload.
fn reloaded(state: &State, reply: Reply) {
    if state.has_errors() {
        return without_picture(state, reply);
    }
    reply.done(json!({ "generation": state.shown_generation() }));
}

/// Answers with the errors of the shaders.
fn without_picture(state: &State, reply: Reply) {
    let errors: Vec<&Diagnostic> = state.errors().collect();
    let message = errors.first().map_or_else(|| "there is no picture".to_owned(), |first| first.one_line());
    reply.error_with(message, json!({ "diagnostics": errors }));
}

/// The camera of the picture.
fn camera_json(state: &State) -> Value {
    state.shown().map_or(Value::Null, |frame_state| {
        let camera = &frame_state.camera;
        let (eye, target) = (short(camera.eye.to_array()), short(camera.target.to_array()));
        json!({ "eye": eye, "target": target, "fovy": short(camera.fovy_rad.to_degrees()) })
    })
}
