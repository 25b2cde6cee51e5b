//! Lines of the client, and lines to it.

use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::sync::Arc;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use serde::Deserialize;
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
            let why = format!("a message is longer than {MOST_BYTES} bytes; it was skipped");
            return Some(Err(error(skip(&line, input), INVALID_REQUEST, &why)));
        }
        if line.trim_ascii().is_empty() {
            continue;
        }
        let why = |fault: serde_json::Error| error(Value::Null, PARSE_ERROR, &format!("no JSON: {fault}"));
        return Some(serde_json::from_slice(&line).map_err(why));
    }
}

/// Reads to the end of a line that has begun with `begun`, and keeps of it only the `id` of its message, for which a client waits.
fn skip(begun: &[u8], input: &mut impl BufRead) -> Value {
    #[derive(Deserialize)]
    struct Message {
        #[serde(default)]
        id: Value,
    }
    // A parser reads single bytes.
    let mut line = BufReader::new(begun.chain(RestOfLine { input, ended: false }));
    let id = Message::deserialize(&mut serde_json::Deserializer::from_reader(&mut line)).map(|message| message.id);
    let _ = std::io::copy(&mut line, &mut std::io::sink());
    id.ok().filter(|id| id.is_number() || id.is_string()).unwrap_or_default()
}

/// The input up to the end of its line.
struct RestOfLine<'a, R> {
    input: &'a mut R,
    ended: bool,
}

impl<R: BufRead> Read for RestOfLine<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.ended || buffer.is_empty() {
            return Ok(0);
        }
        let bytes = self.input.fill_buf()?;
        let bytes = &bytes[..bytes.len().min(buffer.len())];
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let count = end.unwrap_or(bytes.len());
        buffer[..count].copy_from_slice(&bytes[..count]);
        self.ended = end.is_some();
        self.input.consume(count + usize::from(self.ended));
        Ok(count)
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
