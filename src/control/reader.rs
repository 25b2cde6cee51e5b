//! Reads commands, a line each. A line that names no command is answered here.

use std::io::{BufRead as _, BufReader, Read};

use crossbeam_channel::Sender;
use serde_json::Value;

use super::line::{Parsed, parse};
use super::{Asked, Client, Reply};

/// Most bytes of a command: the longest text of a shader file, of whose characters some take more than one as JSON.
pub const MOST_BYTES: usize = 4 << 20;

/// A line of the input.
#[derive(Debug, PartialEq, Eq)]
enum InputLine {
    Whole(Vec<u8>),
    TooLong,
}

/// Reads commands until the input ends, and sends them on. Invalid ones are answered here.
pub(super) fn read(input: impl Read, client: &Client, sender: &Sender<Asked>) {
    let mut lines = BufReader::new(input);
    while let Some(line) = next(&mut lines) {
        let bytes = match line {
            InputLine::Whole(bytes) if bytes.trim_ascii().is_empty() => continue,
            InputLine::Whole(bytes) => bytes,
            InputLine::TooLong => {
                let reply = Reply::new(client, Value::Null, String::new());
                reply.error(format!("a command is longer than {MOST_BYTES} bytes; it was skipped"));
                continue;
            }
        };
        let Parsed { id, command, fields } = parse(&bytes);
        let reply = Reply::new(client, id, command.clone());
        match fields {
            // After the window has closed, the reply says so.
            Ok(fields) => drop(sender.send(Asked { command, fields, reply })),
            Err(message) => reply.error(message),
        }
    }
}

/// The next line without its line break; `None` at the end of the input, which also an error ends.
fn next(input: &mut BufReader<impl Read>) -> Option<InputLine> {
    let (mut line, mut is_long, mut is_begun) = (Vec::new(), false, false);
    loop {
        let bytes = match input.fill_buf() {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(_) => &[],
        };
        if bytes.is_empty() {
            break is_begun.then_some(());
        }
        is_begun = true;
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let part = &bytes[..end.unwrap_or(bytes.len())];
        is_long |= line.len() + part.len() > MOST_BYTES;
        if is_long {
            line = Vec::new();
        } else {
            line.extend_from_slice(part);
        }
        let used = end.map_or(bytes.len(), |end| end + 1);
        input.consume(used);
        if end.is_some() {
            break Some(());
        }
    }?;
    Some(if is_long { InputLine::TooLong } else { InputLine::Whole(line) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read_whole_and_long_ones_are_skipped() {
        let long = "x".repeat(3 * MOST_BYTES);
        let text = format!("a\n\n{long}\nb\r\nlast");
        let mut input = BufReader::with_capacity(16, text.as_bytes());
        let mut lines = Vec::new();
        while let Some(line) = next(&mut input) {
            lines.push(line);
        }
        let whole = |text: &str| InputLine::Whole(text.as_bytes().to_vec());
        assert_eq!(lines, [whole("a"), whole(""), InputLine::TooLong, whole("b\r"), whole("last")]);
    }
}
