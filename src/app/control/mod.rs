//! Carries out commands from outside, and of the panel Capture. A command that changes the picture is answered when the picture is final
//! ([`is_settled`](crate::app::frames::progress::is_settled)), one that writes a file when the file is written.

mod answers;
mod captures;
mod compare;
mod files;
mod numbers;
mod requests;

use serde_json::Value;

use crate::app::actions::watch::watch_files;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::waiting::Until;
use crate::control::{Asked, Reply, Request};
pub(super) use answers::{answer, has_unanswered, take_shots, take_window_shot};
pub(super) use files::{write_shot, write_window_shot};

/// Immediate outcome of a command.
pub(super) enum Next {
    Done(Value),
    Wait(Until),
}

/// Takes a command from outside.
pub(in crate::app) fn on_asked(state: &mut State, engine: &mut Engine, asked: Asked) {
    carry_out(state, engine, asked.request, asked.reply);
}

/// Carries out a command of the window itself, and shows its result as a message.
pub(in crate::app) fn ask_self(state: &mut State, engine: &mut Engine, request: Request) {
    let sender = engine.threads.sender();
    let reply = Reply::to_window(move |result| {
        let text = match result {
            Ok(result) => result["file"].as_str().map(|file| format!("wrote {file}")),
            Err(message) => Some(message),
        };
        text.into_iter().for_each(|text| sender.send(crate::threads::Message::Say(text)));
    });
    carry_out(state, engine, request, reply);
}

fn carry_out(state: &mut State, engine: &mut Engine, request: Request, reply: Reply) {
    match requests::request(state, engine, request) {
        Ok(Next::Done(result)) => reply.done(result),
        Ok(Next::Wait(until)) => state.waiting.push(reply, until),
        Err(message) => reply.error(message),
    }
    watch_files(state, engine);
}
