//! Lines of the client, and lines to it.

use std::io::{BufRead, ErrorKind, Read as _, Write};
use std::sync::Arc;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use serde_json::Value;

use super::message::{INVALID_REQUEST, PARSE_ERROR, error};

/// Most bytes of a message.
const MOST_BYTES: u64 = 16 << 20;
/// How long the end of the server waits until the client has read what was written.
const FAREWELL: Duration = Duration::from_secs(2);

/// Reads the next message; `None` at the end of the input. A line that is no JSON is an error: the answer to it.
pub fn next(input: &mut impl BufRead) -> Option<Result<Value, Value>> {
    loop {
        let mut line = Vec::new();
        match input.by_ref().take(MOST_BYTES + 1).read_until(b'\n', &mut line) {
            Ok(0) => return None,
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => return None,
        }
        if line.len() as u64 > MOST_BYTES && !line.ends_with(b"\n") {
            skip_line(input);
            let why = format!("a message is longer than {MOST_BYTES} bytes; it was skipped");
            return Some(Err(error(Value::Null, INVALID_REQUEST, &why)));
        }
        if line.trim_ascii().is_empty() {
            continue;
        }
        let why = |fault: serde_json::Error| error(Value::Null, PARSE_ERROR, &format!("no JSON: {fault}"));
        return Some(serde_json::from_slice(&line).map_err(why));
    }
}

/// Reads to the end of a line, and keeps nothing of it.
fn skip_line(input: &mut impl BufRead) {
    loop {
        let (used, ends) = match input.fill_buf() {
            Ok([]) => return,
            Ok(bytes) => match bytes.iter().position(|byte| *byte == b'\n') {
                Some(at) => (at + 1, true),
                None => (bytes.len(), false),
            },
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => return,
        };
        input.consume(used);
        if ends {
            return;
        }
    }
}

/// Writes messages on a thread, so that a client that does not read stops nothing. The thread ends with the last copy.
#[derive(Clone)]
pub struct Outgoing {
    sender: Sender<Value>,
}

/// Waits until all is written that was sent.
pub struct Written(Receiver<()>);

impl Outgoing {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system grants none.
    pub fn new(mut output: impl Write + Send + 'static) -> std::io::Result<(Self, Written)> {
        let (sender, receiver) = unbounded::<Value>();
        let (done, end) = bounded(1);
        let work = move || {
            for message in receiver {
                if writeln!(output, "{message}").and_then(|()| output.flush()).is_err() {
                    break;
                }
            }
            let _ = done.send(());
        };
        std::thread::Builder::new().name("specula-mcp-write".to_owned()).spawn(work)?;
        Ok((Self { sender }, Written(end)))
    }

    /// Sends a message.
    pub fn send(&self, message: Value) {
        let _ = self.sender.send(message);
    }
}

impl Written {
    /// Waits, unless the client does not read. All copies of [`Outgoing`] are gone by then.
    pub fn wait(self) {
        let _ = self.0.recv_timeout(FAREWELL);
    }
}

/// Where the answer to a request goes: to the client, or into the list that answers a batch.
#[derive(Clone)]
pub enum Target {
    Client(Outgoing),
    Batch(Arc<Batch>),
}

/// Answers that are sent together once all of their requests are answered.
pub struct Batch {
    answers: std::sync::Mutex<Vec<Value>>,
    to: Outgoing,
}

impl Batch {
    /// No answers yet.
    pub fn new(to: Outgoing) -> Arc<Self> {
        Arc::new(Self { answers: std::sync::Mutex::default(), to })
    }
}

impl Drop for Batch {
    /// The last request of the batch is answered.
    fn drop(&mut self) {
        let answers = std::mem::take(self.answers.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner));
        if !answers.is_empty() {
            self.to.send(Value::Array(answers));
        }
    }
}

impl Target {
    /// Sends an answer.
    pub fn answer(&self, answer: Value) {
        match self {
            Self::Client(to) => to.send(answer),
            Self::Batch(batch) => {
                batch.answers.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(answer);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_json_is_answered_and_the_next_line_is_read() {
        let long = " ".repeat(2 * MOST_BYTES as usize);
        let text = format!("\n{{\"a\"\n{long}\n[1]\r\n\"last\"");
        let mut input = text.as_bytes();
        let codes: Vec<Value> = std::iter::from_fn(|| next(&mut input))
            .map(|line| line.unwrap_or_else(|answer| answer["error"]["code"].clone()))
            .collect();
        assert_eq!(codes, [PARSE_ERROR.into(), INVALID_REQUEST.into(), serde_json::json!([1]), "last".into()]);
    }
}
