//! Reads and writes messages. A message that is wrong is answered, and the next one is read.

use std::io::{BufRead, ErrorKind, Read as _, Write};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use lsp_server::{ErrorCode, Message};
use serde_json::{Value, json};

/// Most bytes of a message.
const MOST_BYTES: u64 = 64 << 20;
/// Most bytes of a line of a head.
const MOST_HEAD: u64 = 8 << 10;
/// How long the end of the server waits until the client has read what was written.
const FAREWELL: Duration = Duration::from_secs(2);

/// A message of the client, or the end of its output.
#[derive(Debug)]
pub enum Incoming {
    /// A message.
    Message(Message),
    /// The answer to something that is no message. Its id may be null, which no request has.
    Malformed(Value),
    /// There will be nothing more.
    End,
}

/// Reads messages on a thread until the input ends.
///
/// # Errors
/// The system grants no thread.
pub fn read_from(mut input: impl BufRead + Send + 'static) -> std::io::Result<Receiver<Incoming>> {
    let (sender, receiver) = unbounded();
    let work = move || {
        while let Some(incoming) = next(&mut input) {
            if sender.send(incoming).is_err() {
                return;
            }
        }
        let _ = sender.send(Incoming::End);
    };
    std::thread::Builder::new().name("specula-lsp-read".to_owned()).spawn(work)?;
    Ok(receiver)
}

/// The next message; `None` at the end.
fn next(input: &mut impl BufRead) -> Option<Incoming> {
    let length = match head(input)? {
        Ok(length) => length,
        Err(why) => return Some(malformed(Value::Null, ErrorCode::ParseError, why)),
    };
    if length > MOST_BYTES {
        std::io::copy(&mut input.take(length), &mut std::io::sink()).ok()?;
        let why = format!("the message has {length} bytes, more than {MOST_BYTES}");
        return Some(malformed(Value::Null, ErrorCode::InvalidRequest, why));
    }
    let mut body = vec![0; length as usize];
    input.read_exact(&mut body).ok()?;
    let value: Value = match serde_json::from_slice(&body) {
        Ok(value) => value,
        Err(error) => return Some(malformed(Value::Null, ErrorCode::ParseError, error.to_string())),
    };
    let id = value.get("id").filter(|id| id.is_number() || id.is_string()).cloned();
    // A list would be read as the members of a response.
    match serde_json::from_value(if value.is_object() { value } else { Value::Null }) {
        Ok(message) => Some(Incoming::Message(message)),
        Err(_) => {
            let why = "expected a request, a notification or a response of JSON-RPC 2.0".to_owned();
            Some(malformed(id.unwrap_or_default(), ErrorCode::InvalidRequest, why))
        }
    }
}

fn malformed(id: Value, code: ErrorCode, why: String) -> Incoming {
    Incoming::Malformed(json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code as i32, "message": why } }))
}

/// Reads a head up to its empty line. Returns the length of the body; `None` at the end of the input.
fn head(input: &mut impl BufRead) -> Option<Result<u64, String>> {
    let mut length = None;
    let mut is_empty = true;
    loop {
        let mut line = Vec::new();
        match input.take(MOST_HEAD).read_until(b'\n', &mut line) {
            Ok(0) => return None,
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => return None,
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if line.is_empty() {
            match length {
                Some(length) => return Some(Ok(length)),
                None if is_empty => continue,
                None => return Some(Err("the head has no Content-Length".to_owned())),
            }
        }
        is_empty = false;
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok();
        }
    }
}

/// Writes messages on a thread, so that a client that does not read stops nothing.
pub struct Outgoing {
    sender: Option<Sender<Vec<u8>>>,
    end: Receiver<()>,
}

impl Outgoing {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system grants none.
    pub fn new(mut output: impl Write + Send + 'static) -> std::io::Result<Self> {
        let (sender, receiver) = unbounded::<Vec<u8>>();
        let (done, end) = bounded(1);
        let work = move || {
            for bytes in receiver {
                if output.write_all(&bytes).and_then(|()| output.flush()).is_err() {
                    break;
                }
            }
            let _ = done.send(());
        };
        std::thread::Builder::new().name("specula-lsp-write".to_owned()).spawn(work)?;
        Ok(Self { sender: Some(sender), end })
    }

    /// Sends a message.
    pub fn send(&self, message: impl Into<Message>) {
        let mut bytes = Vec::new();
        if let (Some(sender), Ok(())) = (&self.sender, message.into().write(&mut bytes)) {
            let _ = sender.send(bytes);
        }
    }

    /// Sends the answer to something that is no message.
    pub fn refuse(&self, answer: &Value) {
        let body = answer.to_string();
        if let Some(sender) = &self.sender {
            let _ = sender.send(format!("Content-Length: {}\r\n\r\n{body}", body.len()).into_bytes());
        }
    }
}

impl Drop for Outgoing {
    /// Waits until all is written, unless the client does not read.
    fn drop(&mut self) {
        self.sender = None;
        let _ = self.end.recv_timeout(FAREWELL);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_answered_and_the_next_message_is_read() {
        let body = |text: &str| format!("Content-Length: {}\r\n\r\n{text}", text.len());
        let input = [
            body(r#"{"jsonrpc":"2.0","id":1,"method":"a"}"#),
            body("{no json"),
            body("[1]"),
            body(r#"{"id":7}"#),
            "X: y\r\n\r\n".to_owned(),
            "content-length: -1\r\n\r\n".to_owned(),
            "\r\n\r\n".to_owned(),
            format!("Content-Length: 99999999999\r\n\r\n{}", body("short")),
        ];
        let text = input.concat();
        let mut input = text.as_bytes();
        let mut codes = Vec::new();
        while let Some(incoming) = next(&mut input) {
            codes.push(match incoming {
                Incoming::Malformed(answer) => answer["error"]["code"].as_i64().unwrap(),
                Incoming::Message(_) => 0,
                Incoming::End => 1,
            });
        }
        // A response without a result is one: the last is cut off by the end.
        assert_eq!(codes, [0, -32700, -32600, 0, -32700, -32700, -32600]);
    }
}
