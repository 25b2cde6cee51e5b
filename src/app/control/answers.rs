//! Answers commands, at once or when the last frame has done them.

use serde_json::{Value, json};

use super::captures::begin_capture;
use crate::app::engine::Engine;
use crate::app::frames::progress::{is_compiling, is_settled};
use crate::app::state::State;
use crate::app::state::waiting::{self, Shot, Work};
use crate::control::Reply;
use crate::shader::Diagnostic;
use crate::threads::{Message, TaskKind};

type Until = waiting::Until<State>;

/// Answers a command from outside once it is done.
pub(in crate::app) fn answer_when(
    state: &mut State,
    engine: &mut Engine,
    reply: Reply,
    outcome: Result<Until, String>,
) {
    match outcome {
        Ok(Until::Now(result)) => reply.done(result),
        Ok(Until::Work(work)) => do_work(engine, reply, work),
        Ok(until) => state.waiting.push(reply, until),
        Err(message) => reply.error(message),
    }
}

/// Has a thread do the work of a command, and answer.
fn do_work(engine: &mut Engine, reply: Reply, Work { uses_device, run }: Work) {
    let answer = move || match run() {
        Ok(result) => reply.done(result),
        Err(message) => reply.error(message),
    };
    match uses_device {
        true => engine.threads.use_device(TaskKind::External, |_| answer()),
        false => engine.threads.wait(|| {
            answer();
            None
        }),
    }
}

/// Tells the user why a command of keys or panels was refused, or which file it has written. The window tells of all else by itself.
pub(in crate::app) fn tell_when(state: &mut State, engine: &Engine, outcome: Result<Until, String>) {
    match outcome {
        Err(message) => state.say(message),
        Ok(until) if until.is_capture() => {
            let sender = engine.threads.sender();
            let reply = Reply::to_window(move |result| {
                let text = match result {
                    Ok(result) => result["file"].as_str().map(|file| format!("wrote {file}")),
                    Err(message) => Some(message),
                };
                text.into_iter().for_each(|text| sender.send(Message::Say(text)));
            });
            state.waiting.push(reply, until);
        }
        Ok(_) => {}
    }
}

/// Answers the commands that the last frame has done.
pub(in crate::app) fn answer(state: &mut State, engine: &mut Engine) {
    if state.waiting.is_empty() {
        return;
    }
    let settled = is_settled(state, engine);
    for (reply, until) in state.waiting.take() {
        match until {
            Until::Settled(_) | Until::Picture(_) | Until::Screen(_) | Until::Rendered(..) if lacks_model(state) => {
                reply.error(state.model.failure.clone().unwrap_or_default());
            }
            Until::Settled(result) if settled => reply.done(result(state)),
            Until::Compared(result) if settled && state.compare.is_drawn() => reply.done(result(state)),
            Until::Found(result) => match result(state) {
                Some(Ok(result)) => reply.done(result),
                Some(Err(message)) => reply.error(message),
                None => state.waiting.push(reply, Until::Found(result)),
            },
            Until::Picture(job) if settled => begin_capture(state, engine, reply, job),
            Until::Reloaded if settled || (state.has_errors() && !is_compiling(state, engine)) => {
                match state.has_errors() {
                    true => without_picture(state, reply),
                    false => reply.done(json!({ "generation": state.shown_generation() })),
                }
            }
            Until::CapturesEnded if state.captures.is_empty() => reply.done(Value::Null),
            Until::Model(path) if !state.model.loading => match state.model.is_file(&path) {
                true => state.waiting.push(reply, Until::SHOWN),
                false => reply.error(format!("{} was not loaded", path.display())),
            },
            Until::Settled(_) | Until::Picture(_) | Until::Screen(_) | Until::Rendered(..) | Until::Window(_)
                if never_shows(state, engine) =>
            {
                without_picture(state, reply);
            }
            until => state.waiting.push(reply, until),
        }
    }
}

/// Answers the commands for which a thread has found something, or for which nothing is to be found. No frame need follow.
pub(in crate::app) fn answer_found(state: &mut State) {
    for (reply, until) in state.waiting.take() {
        let found = if let Until::Found(result) = &until { result(state) } else { None };
        match found {
            Some(Ok(result)) => reply.done(result),
            Some(Err(message)) => reply.error(message),
            None => state.waiting.push(reply, until),
        }
    }
}

/// Whether another frame must follow, because a command waits for nothing else. Messages wake the window for all others.
pub(in crate::app) fn has_unanswered(state: &State, engine: &Engine) -> bool {
    is_settled(state, engine) && state.waiting.needs_frame()
}

/// The pictures of the screen that can be taken now: its frame is final.
pub(in crate::app) fn take_shots(state: &mut State, engine: &Engine) -> Vec<Shot> {
    if !is_settled(state, engine) || lacks_model(state) {
        return Vec::new();
    }
    std::iter::from_fn(|| state.waiting.take_shot()).collect()
}

/// Whether a picture of the window can be taken now.
pub(in crate::app) fn wants_window(state: &State, engine: &Engine) -> bool {
    is_settled(state, engine) && state.waiting.wants_window()
}

/// Whether the model of a session without a window could not be loaded. A program would take an empty picture for the model's; a user sees why.
fn lacks_model(state: &State) -> bool {
    !state.has_window && state.model.failure.is_some() && !state.model.loading
}

/// Whether there are no shaders, and an edit is needed before there are.
fn never_shows(state: &State, engine: &Engine) -> bool {
    state.session.shaders.is_none() && !is_compiling(state, engine) && state.has_errors()
}

/// Answers with the errors of the shaders.
fn without_picture(state: &State, reply: Reply) {
    let errors: Vec<&Diagnostic> = state.errors().collect();
    let message = errors.first().map_or_else(|| "there is no picture".to_owned(), |first| first.one_line());
    reply.error_with(message, json!({ "diagnostics": errors }));
}
