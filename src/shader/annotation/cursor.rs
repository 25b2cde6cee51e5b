//! Walks along the text of one annotation and says where in it something is wrong.

use std::ops::Range;

use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::text::is_word;

/// Where an annotation stands.
#[derive(Clone, Debug)]
pub struct Place {
    /// File as printed.
    pub file: String,
    /// 1-based.
    pub line: u32,
    /// The whole line.
    pub raw: String,
    /// Byte range of the annotation in it.
    pub bytes: Range<usize>,
}

impl Place {
    /// An error here; the caret goes under `bytes`, else under the whole annotation.
    pub fn error(&self, bytes: Option<Range<usize>>, message: impl Into<String>) -> Box<Diagnostic> {
        let bytes = bytes.unwrap_or_else(|| self.bytes.clone());
        Box::new(Diagnostic::error(&self.file, message).on_line(self.line, Some(&self.raw)).under(bytes))
    }
}

/// A position in an annotation.
pub struct Cursor<'a> {
    place: &'a Place,
    raw: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    /// Starts at byte `at` of `raw`, the annotation's line.
    pub fn new(place: &'a Place, raw: &'a str, at: usize) -> Self {
        Self { place, raw, at }
    }

    /// Where the annotation stands.
    pub fn place(&self) -> &'a Place {
        self.place
    }

    /// Byte offset in the line.
    pub fn position(&self) -> usize {
        self.at
    }

    /// An error under `bytes`, or under the whole annotation when they are empty.
    pub fn error(&self, bytes: Range<usize>, message: impl Into<String>) -> Box<Diagnostic> {
        // At the end of the line there is nothing to mark but the annotation itself.
        self.place.error(Some(bytes).filter(|bytes| !bytes.is_empty()), message)
    }

    /// An error at the next word.
    pub fn expected(&mut self, what: &str) -> Box<Diagnostic> {
        let (bytes, word) = self.word();
        let found = if word.is_empty() { "the end of the line".to_owned() } else { format!("`{word}`") };
        self.error(bytes, format!("expected {what}, found {found}"))
    }

    fn skip(&mut self) {
        let rest = &self.raw[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    /// Whether only white space is left.
    pub fn at_end(&mut self) -> bool {
        self.skip();
        self.at >= self.raw.len()
    }

    /// Whether `sign` comes next.
    pub fn peek(&mut self, sign: char) -> bool {
        self.skip();
        self.raw[self.at..].starts_with(sign)
    }

    /// Whether `text` comes next.
    pub fn peek_text(&mut self, text: &str) -> bool {
        self.skip();
        self.raw[self.at..].starts_with(text)
    }

    /// Passes over `sign` if it comes next.
    pub fn take(&mut self, sign: char) -> bool {
        let found = self.peek(sign);
        if found {
            self.at += sign.len_utf8();
        }
        found
    }

    fn take_while(&mut self, wanted: impl Fn(char) -> bool) -> (Range<usize>, &'a str) {
        self.skip();
        let rest = &self.raw[self.at..];
        let length = rest.find(|c| !wanted(c)).unwrap_or(rest.len());
        let bytes = self.at..self.at + length;
        self.at = bytes.end;
        (bytes, &rest[..length])
    }

    /// Everything up to white space; empty at the end.
    pub fn word(&mut self) -> (Range<usize>, &'a str) {
        self.take_while(|c| !c.is_whitespace())
    }

    /// A key before `=`; any other sign alone.
    pub fn key(&mut self) -> (Range<usize>, &'a str) {
        let key = self.take_while(|c| is_word(c) || c == '-');
        if key.1.is_empty() { self.word() } else { key }
    }

    /// The value of `key=`: a word or a quoted string.
    pub fn value(&mut self, key: &str) -> Result<(Range<usize>, String), Box<Diagnostic>> {
        if !self.take('=') {
            return Err(self.expected(&format!("`=` after `{key}`")));
        }
        self.skip();
        let start = self.at;
        if let Some(text) = self.string()? {
            return Ok((start..self.at, text));
        }
        let (bytes, word) = self.word();
        if word.is_empty() {
            return Err(self.expected(&format!("a value after `{key}=`")));
        }
        Ok((bytes, word.to_owned()))
    }

    /// A string in quotes, if one begins here.
    pub fn string(&mut self) -> Result<Option<String>, Box<Diagnostic>> {
        self.skip();
        let start = self.at;
        if !self.take('"') {
            return Ok(None);
        }
        let rest = &self.raw[self.at..];
        let Some(length) = rest.find('"') else {
            return Err(self.error(start..self.raw.trim_end().len(), "expected a closing quote"));
        };
        self.at += length + 1;
        Ok(Some(rest[..length].to_owned()))
    }
}
