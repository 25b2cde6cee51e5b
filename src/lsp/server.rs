//! The loop of the server: one message or event at a time.

use std::collections::VecDeque;
use std::io::{BufRead, Write};
use std::sync::Arc;

use crossbeam_channel::{Receiver, select, unbounded};
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::InitializeParams;
use serde_json::{Value, json};

use super::event::Event;
use super::notifications::notified;
use super::requests::{Answer, answer, capabilities};
pub use super::state::{Config, OpenWindow};
use super::state::{State, failed};
use super::transport::{Incoming, Outgoing, read_from};
use super::uri::path_of;
use crate::message::catch_panic;
use crate::shader::Compiler;

/// Where the client is in the life of the connection.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Begin,
    Running,
    ShutDown,
}

/// Serves a client until it says so or its input ends. Returns whether it has asked for the shutdown before.
///
/// # Errors
/// The system grants no thread.
pub fn serve(
    config: Config,
    compiler: Arc<Compiler>,
    input: impl BufRead + Send + 'static,
    output: impl Write + Send + 'static,
) -> std::io::Result<bool> {
    let (sender, events) = unbounded();
    let incoming = read_from(input)?;
    let state = State::new(config, compiler, Outgoing::new(output)?, sender);
    let mut server = Server { state, phase: Phase::Begin, queue: VecDeque::new() };
    Ok(server.run(&incoming, &events))
}

struct Server {
    state: State,
    phase: Phase,
    /// Messages that were read and wait.
    queue: VecDeque<Incoming>,
}

impl Server {
    fn run(&mut self, incoming: &Receiver<Incoming>, events: &Receiver<Event>) -> bool {
        loop {
            while let Ok(next) = incoming.try_recv() {
                self.enqueue(next);
            }
            let next = self.queue.pop_front();
            match next {
                Some(Incoming::End) => return self.phase == Phase::ShutDown,
                Some(Incoming::Malformed(answer)) => self.state.out.refuse(&answer),
                Some(Incoming::Message(message)) => {
                    if self.message(message) {
                        return self.phase == Phase::ShutDown;
                    }
                }
                None => select! {
                    recv(incoming) -> next => self.enqueue(next.unwrap_or(Incoming::End)),
                    recv(events) -> event => event.into_iter().for_each(|event| self.event(event)),
                    recv(self.state.refresh_timer()) -> _ => {}
                },
            }
            while let Ok(event) = events.try_recv() {
                self.event(event);
            }
            self.state.send_refresh();
        }
    }

    /// Adds a message to those that wait, unless it takes one of these back.
    fn enqueue(&mut self, next: Incoming) {
        let Incoming::Message(Message::Notification(Notification { method, params })) = &next else {
            return self.queue.push_back(next);
        };
        if method != "$/cancelRequest" {
            return self.queue.push_back(next);
        }
        let id: Option<RequestId> = params.get("id").and_then(|id| serde_json::from_value(id.clone()).ok());
        let is_it = |waiting: &Incoming| matches!(waiting, Incoming::Message(Message::Request(request)) if Some(&request.id) == id.as_ref());
        if let Some(at) = self.queue.iter().position(is_it) {
            self.queue.remove(at);
            let canceled = id.map(|id| Response::new_err(id, ErrorCode::RequestCanceled as i32, "canceled".to_owned()));
            canceled.into_iter().for_each(|response| self.state.out.send(response));
        }
    }

    fn event(&mut self, event: Event) {
        match event {
            Event::Diagnosed(root, files) => self.state.diagnosed(&root, files),
            Event::Changed(root, paths) => self.state.changed_on_disk(&root, &paths),
            Event::Traced(traced) => self.state.traced(&traced),
            Event::Pinned(pinned) => self.state.pinned_in_window(&pinned),
            Event::WindowClosed(socket) => self.state.window_closed(&socket),
            Event::Answered(request, result) => self.state.out.send(match result {
                Ok(()) => Response::new_ok(request, Value::Null),
                Err(why) => failed(request, why),
            }),
        }
    }

    /// Handles a message. Returns whether it ends the server.
    fn message(&mut self, message: Message) -> bool {
        match message {
            Message::Request(request) => self.request(&request),
            Message::Notification(notification) if notification.method == "exit" => return true,
            Message::Notification(notification) if self.phase == Phase::Running => {
                let method = notification.method.clone();
                if let Err(panic) = catch_panic(|| notified(&mut self.state, notification)) {
                    tracing::error!("{method} failed: {panic}");
                }
            }
            // Before the begin they have no meaning, and the answers of the client change nothing.
            Message::Notification(_) | Message::Response(_) => {}
        }
        false
    }

    fn request(&mut self, request: &Request) {
        let id = request.id.clone();
        let refused = |code: ErrorCode, why: &str| Response::new_err(id.clone(), code as i32, why.to_owned());
        let response = match (request.method.as_str(), self.phase) {
            ("initialize", Phase::Begin) => {
                self.phase = Phase::Running;
                Response::new_ok(id.clone(), self.initialize(&request.params))
            }
            (_, Phase::Begin) => refused(ErrorCode::ServerNotInitialized, "`initialize` comes first"),
            (_, Phase::ShutDown) => refused(ErrorCode::InvalidRequest, "the server is shut down"),
            ("initialize", Phase::Running) => refused(ErrorCode::InvalidRequest, "`initialize` comes once"),
            ("shutdown", Phase::Running) => {
                self.phase = Phase::ShutDown;
                Response::new_ok(id.clone(), Value::Null)
            }
            _ => match catch_panic(|| answer(&mut self.state, request)) {
                Ok(Ok(Answer::Now(value))) => Response::new_ok(id.clone(), value),
                Ok(Ok(Answer::Later)) => return,
                Ok(Err((code, why))) => refused(code, &why),
                Err(panic) => refused(ErrorCode::InternalError, &format!("{} failed: {panic}", request.method)),
            },
        };
        self.state.out.send(response);
    }

    fn initialize(&mut self, params: &Value) -> Value {
        let refresh = params.pointer("/capabilities/workspace/inlayHint/refreshSupport");
        self.state.can_refresh = refresh.and_then(Value::as_bool).unwrap_or(false);
        if let Ok(params) = serde_json::from_value::<InitializeParams>(params.clone()) {
            let folders = params.workspace_folders.unwrap_or_default();
            self.state.folders = folders.iter().filter_map(|folder| path_of(&folder.uri)).collect();
        }
        json!({ "capabilities": capabilities(), "serverInfo": { "name": "specula", "version": env!("CARGO_PKG_VERSION") } })
    }
}
