//! The lines of a file without values, read anew only when its text changes.

use std::ops::Range;
use std::sync::Arc;

use super::functions::{Function, functions};
use crate::shader::rewrite::literals_by_line;
use crate::shader::{Highlight, highlights, includes};

/// A line of a text.
pub(super) struct TextLine {
    pub(super) text: String,
    /// The parts that have a color, by their bytes in `text`.
    pub(super) parts: Vec<(Range<usize>, Highlight)>,
    /// The name of the file that the line includes.
    pub(super) include: Option<String>,
    /// The bytes of its numbers that can be dragged.
    pub(super) numbers: Vec<Range<usize>>,
}

/// The lines of a text, and its functions.
#[derive(Default)]
pub(super) struct TextLines {
    text: Option<Arc<str>>,
    pub(super) lines: Vec<TextLine>,
    pub(super) functions: Vec<Function>,
}

impl TextLines {
    /// Reads a text, unless it is that of the last time.
    pub(super) fn update(&mut self, text: &Arc<str>) {
        if self.text.as_ref() != Some(text) {
            *self = Self { text: Some(text.clone()), lines: lines(text), functions: functions(text) };
        }
    }
}

fn lines(text: &str) -> Vec<TextLine> {
    let mut parts = highlights(text).into_iter().peekable();
    let mut names = includes(text).peekable();
    let mut numbers = literals_by_line(text).into_iter();
    let mut start = 0;
    let line = |(with_break, line): (&str, &str)| {
        let bytes = start..start + line.len();
        let in_line = |of: &Range<usize>| of.start - bytes.start..of.end.min(bytes.end) - bytes.start;
        let mut own = Vec::new();
        while let Some((of, highlight)) = parts.next_if(|(of, _)| of.start < bytes.end) {
            own.push((in_line(&of), highlight));
        }
        let include = names.next_if(|include| include.bytes.start < bytes.end);
        start += with_break.len();
        TextLine {
            text: line.to_owned(),
            parts: own,
            include: include.map(|include| include.name.to_owned()),
            numbers: numbers.next().unwrap_or_default().into_iter().map(|literal| literal.bytes).collect(),
        }
    };
    text.split_inclusive('\n').zip(text.lines()).map(line).collect()
}
