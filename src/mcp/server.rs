//! Answers the client's messages. What needs the program runs on a thread of its own for each call, so that a `ping` or a cancellation is never
//! behind a picture.

use std::io::{self, BufRead, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use serde_json::{Map, Value, json};

use super::message::{self, INTERNAL_ERROR, INVALID_REQUEST, Incoming, METHOD_NOT_FOUND, Refused};
use super::places::Places;
use super::program::{Call, Connection, Program};
use super::shared::{Shared, lock};
use super::transport::{Batch, Outgoing, Target, next};
use super::{resources, tools};
use crate::message::catch_panic;

/// Revisions of the protocol that this server speaks, the newest last.
const VERSIONS: [&str; 4] = ["2024-11-05", "2025-03-26", "2025-06-18", "2025-11-25"];
/// The only revision with batches.
const WITH_BATCHES: &str = "2025-03-26";
/// Most calls at a time. Each has a thread.
const MOST_CALLS: usize = 32;

const INSTRUCTIONS: &str = "Specula renders a glTF model with a tree of GLSL shaders that you can read and edit. `render` shows you the \
    picture, or one channel or term of the shading as a debug mode (`modes` lists them). `edit_shader` changes a file and returns the \
    compiler's messages; the picture stays that of the last good shaders until the file compiles. `probe`, `trace` and `furnace` give \
    numbers: values of a pixel, what each line of a shader computes there, and the energy of the BRDF. Pixels are counted from the upper \
    left corner of a picture of the size that `render` has by default. World space is right-handed, +Y up, in meters.";

/// Options of the server.
pub struct Config {
    /// The program behind the tools.
    pub connection: Connection,
    /// The folder for files that an agent writes; without one, it writes none.
    pub out: Option<PathBuf>,
}

/// Serves a client until its messages end, and answers the requests that are open then.
///
/// # Errors
/// The output folder cannot be made, or the system grants no thread.
pub fn serve(config: Config, mut input: impl BufRead, output: impl Write + Send + 'static) -> io::Result<()> {
    let places = Places::new(config.out)?;
    let (outgoing, written) = Outgoing::new(output)?;
    let shared = Arc::new(Shared {
        program: Program::new(config.connection),
        places,
        calls: Mutex::default(),
        seen: Mutex::default(),
        made: Mutex::default(),
        checking: Mutex::default(),
    });
    let mut server = Server { shared: shared.clone(), outgoing, version: None, threads: Vec::new() };
    while let Some(line) = next(&mut input) {
        match line {
            Ok(Value::Array(batch)) => server.take_batch(batch),
            Ok(value) => server.take(value, &Target::Client(server.outgoing.clone())),
            Err(answer) => server.outgoing.send(answer),
        }
    }
    server.threads.drain(..).for_each(|thread| drop(thread.join()));
    drop(server);
    shared.program.end();
    written.wait();
    Ok(())
}

struct Server {
    shared: Arc<Shared>,
    outgoing: Outgoing,
    /// The revision of the protocol, once the client has named its own.
    version: Option<&'static str>,
    threads: Vec<std::thread::JoinHandle<()>>,
}

type Answered = Result<Value, Refused>;

/// Work for a thread; `None` if the client has canceled it.
type Work = Box<dyn FnOnce(&Shared, &Arc<Call>) -> Option<Answered> + Send>;

impl Server {
    fn take_batch(&mut self, batch: Vec<Value>) {
        if batch.is_empty() || self.version.is_some_and(|version| version != WITH_BATCHES) {
            let why = "expected one message: batches belong to the revision 2025-03-26 of the protocol alone";
            return self.outgoing.send(message::error(Value::Null, INVALID_REQUEST, why));
        }
        let target = Target::Batch(Batch::new(self.outgoing.clone()));
        batch.into_iter().for_each(|value| self.take(value, &target));
    }

    fn take(&mut self, value: Value, target: &Target) {
        match message::parse(value) {
            Incoming::Request { id, method, params } => self.request(id, &method, params, target),
            Incoming::Notification { method, params } => self.notification(&method, &params),
            Incoming::Response => {}
            Incoming::Wrong(answer) => target.answer(answer),
        }
    }

    fn notification(&self, method: &str, params: &Map<String, Value>) {
        if method == "notifications/cancelled"
            && let Some(id) = params.get("requestId")
        {
            // Whoever is canceled gets no answer. A request that has been answered is not there any more.
            let call = lock(&self.shared.calls).remove(&id.to_string());
            if let Some(call) = call {
                self.shared.program.cancel(&call);
            }
        }
    }

    fn request(&mut self, id: Value, method: &str, mut params: Map<String, Value>, target: &Target) {
        let answered = match method {
            "initialize" => self.initialize(&params),
            "ping" => Ok(json!({})),
            "tools/list" => Ok(json!({ "tools": tools::list() })),
            "resources/templates/list" => Ok(json!({ "resourceTemplates": [resources::template()] })),
            "tools/call" => match tools::find(&mut params) {
                Ok((tool, arguments)) => {
                    let work =
                        move |shared: &Shared, call: &Arc<Call>| tools::call(tool, arguments, shared, call).map(Ok);
                    return self.begin(id, &params, Box::new(work), target);
                }
                Err(refused) => Err(refused),
            },
            "resources/list" => {
                return self.begin(id, &params, Box::new(resources::list), target);
            }
            "resources/read" => {
                let uri = params.get("uri").and_then(Value::as_str).unwrap_or_default().to_owned();
                let work = move |shared: &Shared, call: &Arc<Call>| resources::read(&uri, shared, call);
                return self.begin(id, &params, Box::new(work), target);
            }
            _ => Err(Refused { code: METHOD_NOT_FOUND, message: format!("there is no method `{method}`") }),
        };
        target.answer(message::answer(id, answered));
    }

    fn initialize(&mut self, params: &Map<String, Value>) -> Answered {
        let Some(Value::String(asked)) = params.get("protocolVersion") else {
            return Err(Refused::params("`protocolVersion` is missing: expected a revision, such as \"2025-06-18\""));
        };
        let version = VERSIONS.into_iter().find(|version| version == asked).unwrap_or(VERSIONS[VERSIONS.len() - 1]);
        self.version = Some(version);
        Ok(json!({
            "protocolVersion": version,
            "capabilities": { "tools": {}, "resources": {} },
            "serverInfo": { "name": "specula", "title": "Specula", "version": env!("CARGO_PKG_VERSION") },
            "instructions": INSTRUCTIONS,
        }))
    }

    /// Answers a request on a thread.
    fn begin(&mut self, id: Value, params: &Map<String, Value>, work: Work, target: &Target) {
        self.threads.retain(|thread| !thread.is_finished());
        let call = Call::new(self.progress(params));
        {
            let mut calls = lock(&self.shared.calls);
            let why = if calls.len() >= MOST_CALLS {
                Some(format!("{MOST_CALLS} calls are open already; wait for one of them"))
            } else {
                calls.contains_key(&id.to_string()).then(|| format!("a request with the id {id} is open already"))
            };
            if let Some(why) = why {
                return target.answer(message::error(id, INVALID_REQUEST, &why));
            }
            calls.insert(id.to_string(), call.clone());
        }
        let (shared, to) = (self.shared.clone(), target.clone());
        let answer_of = id.clone();
        let run = move || {
            let answered = catch_panic(|| work(&shared, &call)).unwrap_or_else(|panic| {
                let message = format!("this is a mistake of Specula: {panic}");
                Some(Err(Refused { code: INTERNAL_ERROR, message }))
            });
            // A canceled call is not there any more, or its place is that of a later one.
            let mut calls = lock(&shared.calls);
            let is_open = calls.get(&answer_of.to_string()).is_some_and(|open| Arc::ptr_eq(open, &call));
            if is_open {
                calls.remove(&answer_of.to_string());
                if let Some(answered) = answered {
                    to.answer(message::answer(answer_of, answered));
                }
            }
        };
        match std::thread::Builder::new().name("specula-mcp-call".to_owned()).spawn(run) {
            Ok(thread) => self.threads.push(thread),
            Err(error) => {
                lock(&self.shared.calls).remove(&id.to_string());
                target.answer(message::error(id, INVALID_REQUEST, &format!("no thread: {error}")));
            }
        }
    }

    /// Reports progress, if the client asks for it.
    fn progress(&self, params: &Map<String, Value>) -> Option<Box<dyn Fn(u64, u64) + Send + Sync>> {
        let token = params.get("_meta")?.get("progressToken")?.clone();
        let outgoing = self.outgoing.clone();
        Some(Box::new(move |done, of| {
            let params = json!({ "progressToken": token, "progress": done, "total": of });
            outgoing.send(json!({ "jsonrpc": "2.0", "method": "notifications/progress", "params": params }));
        }))
    }
}

#[cfg(all(test, unix))]
mod tests;
