//! The session of a window without a window, for programs (`specula serve`): the same state, engine, threads and commands, without a display,
//! an event loop of the desktop, panels or a swapchain. Frames are drawn when something has happened, to an image that nobody sees.

use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, unbounded};
use serde_json::Value;

use super::ending::Ending;
use super::engine::Engine;
use super::error::AppError;
use super::frames::background::Next;
use super::frames::draw::Drawing;
use super::frames::progress::{is_settled, moves};
use super::messages::on_message;
use super::options::{AppOptions, Early};
use super::screen::Screen;
use super::start::start;
use super::state::State;
use super::state::waiting::CANCELED;
use crate::control::Asked;
use crate::events::{Event, emit};
use crate::gpu::{Gpu, GpuError, SetLayouts};
use crate::threads::{Message, MessageSender};

/// Carries out commands until one of them ends the session.
///
/// # Errors
/// No device, a picture that is too large for it, a model that does not load, or a device error.
pub fn serve(mut options: AppOptions) -> Result<(), AppError> {
    // Its end writes the last events, so it outlives the session.
    let control = std::mem::take(&mut options.control);
    let (sender, messages) = unbounded();
    let sender = MessageSender::Loop(sender);
    if let Some(socket) = control.socket() {
        emit(control.clients(), &Event::Listening { socket: &socket.display().to_string() });
    }
    let early = Early::begin(&options, control.clients(), &sender);
    let gpu = Gpu::new(&options.gpu(None))?;
    let (size, most) = (options.size, gpu.max_image_size());
    if !(1..=most).contains(&size.0) || !(1..=most).contains(&size.1) {
        return Err(AppError::Size(size.0, size.1, most));
    }
    let layouts = SetLayouts::new(&gpu)?;
    let drawing = Drawing::new(Screen::unseen(&gpu, &layouts, size)?);
    let (mut state, engine) = start(&gpu, &layouts, options, early, (&sender, false))?;
    // A picture of an animated shader is that of time 0, as a command renders it, until a program starts or moves the clock.
    state.playback.await_start();
    sender.pass_on(control.asked());
    let mut session = Ending { state, engine, drawing, gpu };
    match run(&mut session, &messages) {
        Err(error @ AppError::Gpu(GpuError::DeviceLost(_))) => {
            session.lost();
            Err(error)
        }
        result => session.end(result, || ()),
    }
}

/// Takes messages and draws the frames that follow from them, until the session ends.
fn run(session: &mut Ending, messages: &Receiver<Message>) -> Result<(), AppError> {
    let Ending { state, engine, drawing, .. } = session;
    let mut early = Vec::new();
    loop {
        messages.try_iter().for_each(|message| take(state, engine, &mut early, message));
        if knows_names(state, engine) {
            early.drain(..).for_each(|asked| on_message(state, engine, Message::Asked(Box::new(asked))));
        }
        if state.quit || state.quits_by_hand {
            return Ok(());
        }
        let mut wait = drawing.draw(None, state, engine)?;
        // A clock that runs needs no frames for which nobody waits.
        if moves(state) && state.waiting.is_empty() && is_settled(state, engine) {
            wait = wait.filter(|wait| !wait.is_zero());
        }
        // Waits for a message, or until a frame is due.
        while wait.is_none_or(|wait| !wait.is_zero()) {
            let record = engine.recorder.rest();
            if let Some(message) = next(messages, wait.into_iter().chain(record).min()) {
                take(state, engine, &mut early, message);
                break;
            }
            wait = match drawing.go_on(None, state, engine)? {
                Next::Frame => Some(Duration::ZERO),
                Next::After(wait) => Some(wait),
                Next::Event => None,
            };
        }
    }
}

/// Takes a message. Commands wait in `early` for the first shaders, whose names they may use; but not those that end something.
fn take(state: &mut State, engine: &mut Engine, early: &mut Vec<Asked>, message: Message) {
    match message {
        Message::Asked(asked) if asked.command == "cancel" => match canceled(early, &asked) {
            Some(command) => {
                command.reply.error(CANCELED);
                asked.reply.done(Value::Null);
            }
            None => on_message(state, engine, Message::Asked(asked)),
        },
        Message::Asked(asked) if asked.command != "quit" && (!early.is_empty() || !knows_names(state, engine)) => {
            early.push(*asked);
        }
        message => on_message(state, engine, message),
    }
}

/// Removes the early command that another one cancels.
fn canceled(early: &mut Vec<Asked>, cancel: &Asked) -> Option<Asked> {
    let key = (cancel.reply.key().0, cancel.fields.get("of")?.clone());
    let found = early.iter().position(|asked| asked.reply.key() == key)?;
    Some(early.remove(found))
}

/// Whether all stages have been compiled, or cannot be.
fn knows_names(state: &State, engine: &Engine) -> bool {
    let is_complete = state.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
    is_complete || state.names_checked || (state.has_errors() && !engine.threads.worker.is_compiling())
}

/// The next message; `None` if none comes for so long.
fn next(messages: &Receiver<Message>, wait: Option<Duration>) -> Option<Message> {
    let received = match wait {
        Some(wait) => messages.recv_deadline(Instant::now() + wait),
        None => messages.recv().map_err(|_| RecvTimeoutError::Disconnected),
    };
    received.ok()
}
