//! Reads the text of one annotation from left to right, and reports errors at their column.

use std::ops::Range;

use super::place::AnnotationPlace;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::is_word;

/// A position in an annotation.
pub struct Cursor<'a> {
    place: &'a AnnotationPlace,
    raw: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    /// A cursor at byte `at` of `raw`, the annotation's line.
    pub fn new(place: &'a AnnotationPlace, raw: &'a str, at: usize) -> Self {
        Self { place, raw, at }
    }

    /// The location of the annotation.
    pub fn place(&self) -> &'a AnnotationPlace {
        self.place
    }

    /// The text behind the cursor.
    pub fn rest(&self) -> &'a str {
        &self.raw[self.at..]
    }

    /// Byte offset of the cursor in the line.
    pub fn position(&self) -> usize {
        self.at
    }

    /// An error under `bytes`, or behind the annotation if `bytes` is empty.
    pub fn error(&self, bytes: Range<usize>, message: impl Into<String>) -> Box<Diagnostic> {
        // White space may follow the last word.
        let bytes = if bytes.is_empty() { self.place.end() } else { bytes };
        Box::new(self.place.under(bytes, message))
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

    /// Skips `sign` if it comes next. Returns whether it did.
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

    /// The text up to the next white space; empty at the end.
    pub fn word(&mut self) -> (Range<usize>, &'a str) {
        self.take_while(|c| !c.is_whitespace())
    }

    /// A key before `=`, or the next word if there is no key.
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

    /// The value of `key=`, which is one of these names.
    pub fn one_of<T: Copy>(&mut self, key: &str, all: &[(&str, T)]) -> Result<T, Box<Diagnostic>> {
        let (bytes, value) = self.value(key)?;
        let found = all.iter().find(|(name, _)| *name == value);
        found.map(|(_, one)| *one).ok_or_else(|| {
            let names: Vec<String> = all.iter().map(|(name, _)| format!("{key}={name}")).collect();
            let (others, last) = names.split_at(names.len() - 1);
            self.error(bytes, format!("expected {} or {}, found `{value}`", others.join(", "), last.concat()))
        })
    }

    /// A quoted string, if one begins here.
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
