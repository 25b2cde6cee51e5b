//! Asks a running window through its socket.

use std::path::{Path, PathBuf};
use std::sync::Arc;
#[cfg(unix)]
use std::time::Duration;

#[cfg(not(unix))]
use serde_json::Value;
use serde_json::json;

use super::traced::{Asked, Pinned, TracedFile, TracedLine};

/// How long a window may take for an answer: one with large shaders may compile for long.
#[cfg(unix)]
const ANSWER: Duration = Duration::from_mins(2);

/// The sockets that were named, or all of the user. Some may be left over from a window that has crashed.
pub fn socket_files(named: Option<&Path>) -> Vec<PathBuf> {
    if let Some(path) = named {
        return vec![path.to_owned()];
    }
    let folder = std::env::var_os("XDG_RUNTIME_DIR").map(|folder| PathBuf::from(folder).join("specula"));
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "sock")).collect();
    paths.sort();
    paths
}

/// The sockets of windows that run now: the one that was named, or all of the user.
pub fn sockets(named: Option<&Path>) -> Vec<PathBuf> {
    socket_files(named).into_iter().filter(|path| Line::open(path).is_ok()).collect()
}

/// Asks the first window that can to show an expression over the model.
///
/// # Errors
/// No window runs, or the answer of the last one.
pub fn show(sockets: &[PathBuf], expression: &str) -> Result<(), String> {
    let mut last = Err("no window listens: start one with `specula view --socket NAME`".to_owned());
    for socket in sockets {
        let values = json!({ "expression.at": expression, "mode": "expression" });
        last =
            Line::open(socket).and_then(|mut line| line.ask(&json!({ "command": "set", "values": values }))).map(drop);
        if last.is_ok() {
            break;
        }
    }
    last
}

/// The values of files at the pixel that is pinned in a window.
///
/// # Errors
/// Why there are none.
pub fn values(socket: &Path, asked: &Asked) -> Result<(Vec<TracedFile>, String), String> {
    let mut line = Line::open(socket)?;
    let (mut files, mut proof, mut problem) = (Vec::new(), String::new(), None);
    for path in &asked.files {
        let text: Arc<str> = std::fs::read_to_string(asked.root.join(path.as_str())).unwrap_or_default().into();
        let question = json!({ "command": "trace", "file": path.as_str(), "at": [asked.at.0, asked.at.1] });
        match line.ask(&question) {
            Ok(traced) => {
                proof = traced["proof"]["text"].as_str().unwrap_or_default().to_owned();
                let lines = traced["lines"].as_array().into_iter().flatten().filter_map(TracedLine::parse);
                // The file may be newer than the picture.
                let on_disk: Vec<&str> = text.lines().map(str::trim).collect();
                let is_same = |line: &TracedLine| on_disk.get(line.line as usize - 1) == Some(&line.code.as_str());
                let lines = lines.filter(|line| line.line > 0).filter(is_same).collect();
                files.push(TracedFile { path: path.clone(), text, lines });
            }
            Err(why) => problem = Some(why),
        }
        // An answer that is late would be taken for that of the next file.
        if line.is_lost() {
            break;
        }
    }
    match problem {
        Some(problem) if files.is_empty() => Err(problem),
        _ => Ok((files, proof)),
    }
}

/// Tells of the pinned pixel of a window, now and whenever it or the picture changes, until the window closes.
pub fn follow(socket: &Path, tell: impl Fn(Pinned)) {
    let Ok(mut line) = Line::open(socket) else { return };
    if line.send(&json!({ "id": ID, "command": "pinned" })).is_err() || line.wait_for(None).is_err() {
        return;
    }
    while let Some(event) = line.next() {
        let pinned = match event["event"].as_str() {
            Some("pinned") => &event,
            Some("done") if event["id"] == ID => &event["result"],
            _ => continue,
        };
        let number = |at: usize| pinned["pixel"][at].as_u64().and_then(|number| u32::try_from(number).ok());
        tell(Pinned {
            socket: socket.to_owned(),
            tree: pinned["tree"].as_str().map(PathBuf::from),
            pixel: number(0).zip(number(1)),
            moved: pinned["moved"] == true,
        });
    }
}

/// The name of questions.
const ID: &str = "lsp";

#[cfg(unix)]
use line::Line;

#[cfg(unix)]
mod line {
    use std::io::{BufRead as _, BufReader, Write as _};
    use std::os::unix::net::UnixStream;
    use std::path::{Path, PathBuf};
    use std::time::{Duration, Instant};

    use serde_json::Value;

    use super::{ANSWER, ID};

    /// A connection to a window.
    pub(super) struct Line {
        socket: PathBuf,
        stream: BufReader<UnixStream>,
        is_lost: bool,
    }

    impl Line {
        pub(super) fn open(socket: &Path) -> Result<Self, String> {
            let stream = UnixStream::connect(socket).and_then(|stream| {
                stream.set_write_timeout(Some(ANSWER))?;
                Ok(stream)
            });
            let stream = stream.map_err(|error| failed(socket, &error))?;
            Ok(Self { socket: socket.to_owned(), stream: BufReader::new(stream), is_lost: false })
        }

        pub(super) fn send(&mut self, command: &Value) -> Result<(), String> {
            writeln!(self.stream.get_mut(), "{command}").map_err(|error| failed(&self.socket, &error))
        }

        /// How long [`Self::next`] waits; `None` for ever.
        pub(super) fn wait_for(&mut self, most: Option<Duration>) -> Result<(), String> {
            self.stream.get_mut().set_read_timeout(most).map_err(|error| failed(&self.socket, &error))
        }

        /// The next event; `None` at the end.
        pub(super) fn next(&mut self) -> Option<Value> {
            let mut line = String::new();
            let read = self.stream.read_line(&mut line).ok()?;
            (read > 0).then(|| serde_json::from_str(&line).unwrap_or_default())
        }

        /// Whether an answer did not come, so that the next line may be about anything.
        pub(super) fn is_lost(&self) -> bool {
            self.is_lost
        }

        /// Sends a command, and waits for its result.
        pub(super) fn ask(&mut self, command: &Value) -> Result<Value, String> {
            let mut command = command.clone();
            command["id"] = ID.into();
            self.send(&command)?;
            let end = Instant::now() + ANSWER;
            loop {
                let left = end.saturating_duration_since(Instant::now()).max(Duration::from_millis(1));
                self.wait_for(Some(left))?;
                let Some(mut answer) = self.next() else { break };
                match answer["event"].as_str() {
                    _ if answer["id"] != ID => {}
                    Some("done") => return Ok(answer["result"].take()),
                    Some("error") => return Err(answer["message"].as_str().unwrap_or("it failed").to_owned()),
                    _ => {}
                }
            }
            self.is_lost = true;
            Err(format!("the window at {} does not answer, or has closed", self.socket.display()))
        }
    }

    fn failed(socket: &Path, error: &std::io::Error) -> String {
        format!("the window at {} does not answer: {error}", socket.display())
    }
}

/// This system has no sockets for windows.
#[cfg(not(unix))]
#[allow(dead_code)]
struct Line;

#[cfg(not(unix))]
impl Line {
    fn open(_: &Path) -> Result<Self, String> {
        Err("this system has no sockets for windows".to_owned())
    }

    fn send(&mut self, _: &Value) -> Result<(), String> {
        Ok(())
    }

    fn wait_for(&mut self, _: Option<Duration>) -> Result<(), String> {
        Ok(())
    }

    fn next(&mut self) -> Option<Value> {
        None
    }

    fn is_lost(&self) -> bool {
        true
    }

    fn ask(&mut self, _: &Value) -> Result<Value, String> {
        Ok(Value::Null)
    }
}
