//! Inlay hints: what the lines of a file computed at the pinned pixel, at their ends.

use std::collections::BTreeMap;

use lsp_types::{InlayHint, InlayHintLabel, InlayHintTooltip, Range as Span};

use super::source_text::SourceText;
use super::traced::{TracedFile, TracedLine};
use crate::shader::expression::lines_before;

/// The longest hint, in characters.
const LONGEST: usize = 100;

/// The hints of a file within a span. Values of lines that have changed since they were traced are left out; the others are where their
/// lines are now.
pub fn hints(traced: &TracedFile, source: &SourceText, span: Span) -> Vec<InlayHint> {
    let places = places(&traced.text, &source.text);
    let hint = |line: &TracedLine| {
        let now = *places.get(&(line.line as usize).checked_sub(1)?)?;
        let number = u32::try_from(now).ok()?;
        let bytes = source.line(now);
        let end = bytes.start + source.text[bytes].trim_end().len();
        (span.start.line..=span.end.line).contains(&number).then(|| InlayHint {
            position: source.place(end),
            label: InlayHintLabel::String(short(&line.text)),
            kind: None,
            text_edits: None,
            tooltip: Some(InlayHintTooltip::String(line.calls.clone())),
            padding_left: Some(true),
            padding_right: None,
            data: None,
        })
    };
    traced.lines.iter().filter_map(hint).collect()
}

/// The values of a line of the text as it is now, from 0, in words.
pub fn values_of(traced: &TracedFile, source: &SourceText, line: usize) -> Option<String> {
    let places = places(&traced.text, &source.text);
    let is_it = |of: &&TracedLine| (of.line as usize).checked_sub(1).and_then(|of| places.get(&of)) == Some(&line);
    traced.lines.iter().find(is_it).map(|line| line.text.clone())
}

/// Where the lines of `old` that have not changed are in `new`, from 0.
fn places(old: &str, new: &str) -> BTreeMap<usize, usize> {
    let (old_lines, new_lines): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let same = |(now, before): (usize, Option<u32>)| {
        let before = (before? as usize).checked_sub(1)?;
        (old_lines.get(before)?.trim() == new_lines.get(now)?.trim()).then_some((before, now))
    };
    lines_before(old, new).into_iter().enumerate().filter_map(same).collect()
}

fn short(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_have_changed_have_no_place() {
        let old = "a\nb\nc\nd\n";
        let moved = |new: &str| places(old, new).into_iter().collect::<Vec<_>>();
        assert_eq!(moved("x\na\r\nb\nC\nd"), [(0, 1), (1, 2), (3, 4)]);
        assert_eq!(moved(""), []);
        assert_eq!(short(&"ä".repeat(200)).chars().count(), LONGEST + 1);
    }
}
