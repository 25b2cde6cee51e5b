//! The program that carries out commands: a process that this one starts, or a window that it joins. Commands and answers are JSON lines.

use std::collections::HashMap;
use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use serde_json::{Map, Value, json};

/// Most bytes of a command. The program would skip a longer one, and answer it without its number.
const MOST_BYTES: usize = 4 << 20;
/// How long the end waits for the process to end.
const FAREWELL: Duration = Duration::from_secs(5);

/// Where commands go.
#[derive(Debug)]
pub enum Connection {
    /// To a process of its own.
    Start(Start),
    /// To the window that listens on this socket.
    Join(PathBuf),
}

/// How to start the process.
#[derive(Debug)]
pub struct Start {
    /// The program.
    pub program: PathBuf,
    /// Its arguments: `serve`, a model and options.
    pub arguments: Vec<OsString>,
}

/// Why a command was not carried out.
#[derive(Debug)]
pub enum Failure {
    /// The reason, and the diagnostics of the shaders if they are wrong.
    Refused { message: String, diagnostics: Vec<Value> },
    /// The client has canceled the call.
    Canceled,
}

impl Failure {
    /// A reason without diagnostics.
    pub fn new(message: impl Into<String>) -> Self {
        Self::Refused { message: message.into(), diagnostics: Vec::new() }
    }
}

type Outcome = Result<Value, Failure>;

/// Takes how much of a command is done, and of how much.
type Progress = Box<dyn Fn(u64, u64) + Send + Sync>;

/// A call of the client, which asks one command after another.
#[derive(Default)]
pub struct Call {
    is_canceled: AtomicBool,
    open: Mutex<Option<(u64, Sender<Outcome>)>>,
    progress: Option<Progress>,
}

impl Call {
    /// A call that reports progress.
    pub fn new(progress: Option<Progress>) -> Arc<Self> {
        Arc::new(Self { progress, ..Self::default() })
    }

    /// Whether the client has canceled it.
    pub fn is_canceled(&self) -> bool {
        self.is_canceled.load(Ordering::SeqCst)
    }
}

/// The connection to the program. It is made anew for the next command if it has ended.
pub struct Program {
    connection: Connection,
    link: Mutex<Option<Link>>,
    numbers: AtomicU64,
}

/// A connection that is open.
struct Link {
    lines: Sender<String>,
    commands: Arc<Mutex<Commands>>,
    /// Closed once the process has ended.
    ended: Receiver<()>,
}

/// Commands without an answer.
#[derive(Default)]
struct Commands {
    open: HashMap<u64, (Sender<Outcome>, Arc<Call>)>,
    /// Why there will be no more answers.
    end: Option<String>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Program {
    /// Connects at once, so that the first command finds the program warm. A connection that cannot be made is tried again for each command.
    pub fn new(connection: Connection) -> Self {
        let program = Self { connection, link: Mutex::default(), numbers: AtomicU64::new(1) };
        if let Ok(link) = program.connect() {
            *lock(&program.link) = Some(link);
        }
        program
    }

    /// Asks a command and waits for its answer.
    ///
    /// # Errors
    /// The program refuses the command or has ended, or the client has canceled the call.
    pub fn ask(&self, call: &Arc<Call>, command: &str, fields: &Value) -> Outcome {
        let number = self.numbers.fetch_add(1, Ordering::SeqCst);
        let (sender, answer) = bounded(2);
        *lock(&call.open) = Some((number, sender.clone()));
        if call.is_canceled() {
            return Err(Failure::Canceled);
        }
        let mut line = fields.as_object().cloned().unwrap_or_default();
        line.retain(|_, value| !value.is_null());
        line.insert("id".to_owned(), number.into());
        line.insert("command".to_owned(), command.into());
        self.send(Value::Object(line), (number, sender, call))?;
        let outcome = answer.recv().unwrap_or_else(|_| Err(Failure::new("the program has ended")));
        *lock(&call.open) = None;
        outcome
    }

    /// Ends a call: its command is canceled, and whoever waits for it goes on.
    pub fn cancel(&self, call: &Call) {
        call.is_canceled.store(true, Ordering::SeqCst);
        let Some((number, sender)) = lock(&call.open).take() else { return };
        let _ = sender.try_send(Err(Failure::Canceled));
        if let Some(link) = &*lock(&self.link) {
            let _ = link.lines.send(json!({ "id": null, "command": "cancel", "of": number }).to_string());
        }
    }

    /// Ends a process that was started, and waits until it has ended. A window stays open.
    pub fn end(&self) {
        if let Some(Link { lines, ended, .. }) = lock(&self.link).take() {
            let is_own = matches!(self.connection, Connection::Start(_));
            if is_own {
                // At once: the end of its input alone would let it finish what was canceled.
                let _ = lines.send(json!({ "command": "quit" }).to_string());
            }
            drop(lines);
            if is_own {
                let _ = ended.recv_timeout(FAREWELL);
            }
        }
    }

    /// Sends a line whose answer goes to `sender`.
    fn send(&self, line: Value, (number, sender, call): (u64, Sender<Outcome>, &Arc<Call>)) -> Result<(), Failure> {
        let line = line.to_string();
        if line.len() > MOST_BYTES {
            return Err(Failure::new(format!("this is longer than {MOST_BYTES} bytes")));
        }
        let mut link = lock(&self.link);
        if link.as_ref().is_none_or(|link| lock(&link.commands).end.is_some()) {
            *link = None;
            *link = Some(self.connect().map_err(Failure::new)?);
        }
        let Some(link) = &*link else { return Err(Failure::new("the program has ended")) };
        let mut commands = lock(&link.commands);
        if let Some(end) = &commands.end {
            return Err(Failure::new(end.clone()));
        }
        commands.open.insert(number, (sender, call.clone()));
        let _ = link.lines.send(line);
        Ok(())
    }

    fn connect(&self) -> Result<Link, String> {
        match &self.connection {
            Connection::Start(Start { program, arguments }) => {
                // Its messages are for whoever reads those of this process.
                let mut command = Command::new(program);
                command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
                let mut child = command.spawn().map_err(|error| format!("{}: {error}", program.display()))?;
                let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
                    return Err("the program has no input and output".to_owned());
                };
                Link::new(input, output, Some(child))
            }
            #[cfg(unix)]
            Connection::Join(path) => {
                let join = |error| {
                    format!("no window listens on {}: {error}. Start one with `specula view --socket`", path.display())
                };
                let stream = std::os::unix::net::UnixStream::connect(path).map_err(join)?;
                let output = stream.try_clone().map_err(join)?;
                Link::new(stream, output, None)
            }
            #[cfg(not(unix))]
            Connection::Join(path) => Err(format!("{}: this system has no Unix sockets", path.display())),
        }
    }
}

impl Link {
    /// Starts the threads that write and read.
    fn new(
        mut input: impl Write + Send + 'static,
        output: impl Read + Send + 'static,
        child: Option<Child>,
    ) -> Result<Self, String> {
        let (lines, to_write) = unbounded::<String>();
        let write = move || {
            for line in to_write {
                if writeln!(input, "{line}").and_then(|()| input.flush()).is_err() {
                    break;
                }
            }
        };
        let commands = Arc::<Mutex<Commands>>::default();
        let (done, ended) = bounded(0);
        let read = {
            let commands = commands.clone();
            move || {
                for line in BufReader::new(output).lines().map_while(Result::ok) {
                    if let Ok(Value::Object(event)) = serde_json::from_str(&line) {
                        take(&commands, event);
                    }
                }
                let why = match child.map(|mut child| child.wait()) {
                    None => "the window has closed".to_owned(),
                    Some(Ok(status)) => format!("the program has ended ({status}); its messages are on stderr"),
                    Some(Err(error)) => format!("the program has ended: {error}"),
                };
                fail_all(&commands, &why, Some(why.clone()));
                drop(done);
            }
        };
        let spawn = |name: &str| std::thread::Builder::new().name(name.to_owned());
        let started = spawn("specula-mcp-ask").spawn(write).and_then(|_| spawn("specula-mcp-answers").spawn(read));
        started.map_err(|error| format!("no thread: {error}"))?;
        Ok(Self { lines, commands, ended })
    }
}

/// Gives an answer to whoever waits for it.
fn take(commands: &Mutex<Commands>, mut event: Map<String, Value>) {
    let kind = event.get("event").and_then(Value::as_str).unwrap_or_default().to_owned();
    if kind == "restarted" {
        let cause = event.get("cause").and_then(Value::as_str).unwrap_or("the program crashed").to_owned();
        let why = format!("{cause}. The program goes on with its settings and the last good shaders; try again");
        return fail_all(commands, &why, None);
    }
    let Some(number) = event.get("id").and_then(Value::as_u64) else { return };
    if kind == "progress" {
        let call = lock(commands).open.get(&number).map(|(_, call)| call.clone());
        let count = |field: &str| event.get(field).and_then(Value::as_u64).unwrap_or(0);
        if let Some(progress) = call.as_ref().and_then(|call| call.progress.as_ref()) {
            progress(count("done"), count("of"));
        }
        return;
    }
    let Some((sender, _)) = lock(commands).open.remove(&number) else { return };
    let _ = sender.try_send(match kind.as_str() {
        "done" => Ok(event.remove("result").unwrap_or_default()),
        _ => Err(Failure::Refused {
            message: event.get("message").and_then(Value::as_str).unwrap_or_default().to_owned(),
            diagnostics: match event.remove("diagnostics") {
                Some(Value::Array(diagnostics)) => diagnostics,
                _ => Vec::new(),
            },
        }),
    });
}

/// Answers all commands that are open. With `end`, there will be no more answers.
fn fail_all(commands: &Mutex<Commands>, why: &str, end: Option<String>) {
    let mut commands = lock(commands);
    commands.end = end.or(commands.end.take());
    for (_, (sender, _)) in commands.open.drain() {
        let _ = sender.try_send(Err(Failure::new(why)));
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// A program that is a line of the shell.
    fn shell(script: &str) -> Program {
        let arguments = ["-c", script].map(OsString::from).to_vec();
        Program::new(Connection::Start(Start { program: "sh".into(), arguments }))
    }

    fn message(outcome: Outcome) -> String {
        match outcome {
            Err(Failure::Refused { message, .. }) => message,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_program_that_ends_answers_its_commands_and_is_started_again() {
        let program = shell("read line; exit 7");
        for _ in 0..2 {
            let said = message(program.ask(&Call::new(None), "get", &json!({})));
            assert!(said.contains("has ended (exit status: 7)"), "{said}");
        }
        program.end();
    }

    #[test]
    fn a_loss_answers_the_commands_that_were_open() {
        let program = shell(r#"read line; echo '{"event": "restarted", "cause": "the device was lost"}'; read line"#);
        let said = message(program.ask(&Call::new(None), "get", &json!({})));
        assert!(said.starts_with("the device was lost. The program goes on"), "{said}");
        program.end();
    }

    #[test]
    fn a_canceled_call_goes_on_at_once_and_cancels_its_command() {
        // The program tells the line that cancels, as progress would be told.
        let program = Arc::new(shell(
            r#"read line; echo '{"event": "progress", "id": 1, "done": 1, "of": 2}'; read line
            case "$line" in *'"cancel"'*'"of":1'*) exit 0;; esac; exit 1"#,
        ));
        let (told, progress) = bounded(1);
        let call = Call::new(Some(Box::new(move |done, of| {
            let _ = told.send((done, of));
        })));
        let asked = std::thread::spawn({
            let (program, call) = (program.clone(), call.clone());
            move || program.ask(&call, "turntable", &json!({}))
        });
        assert_eq!(progress.recv(), Ok((1, 2)));
        program.cancel(&call);
        assert!(matches!(asked.join().unwrap(), Err(Failure::Canceled)));
        assert!(matches!(program.ask(&call, "get", &json!({})), Err(Failure::Canceled)));
        let ended = lock(&program.link).as_ref().map(|link| (link.ended.clone(), link.commands.clone())).unwrap();
        let _ = ended.0.recv();
        assert_eq!(lock(&ended.1).end.as_deref().map(|end| end.contains("exit status: 0")), Some(true));
    }
}
