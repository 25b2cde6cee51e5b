//! A text with its lines, and places in it as the protocol counts them: lines from 0, and UTF-16 code units from the line's begin.

use std::ops::Range;
use std::sync::Arc;

use lsp_types::{Position, Range as Span, TextDocumentContentChangeEvent};

const MARK: char = '\u{feff}';

/// A text.
#[derive(Clone, Debug)]
pub struct SourceText {
    /// The text without a byte order mark.
    pub text: Arc<str>,
    /// The byte at which each line begins. Lines end with `\n`, `\r\n` or `\r`.
    starts: Vec<usize>,
    /// Whether the client counts a byte order mark, which is no part of `text`.
    has_mark: bool,
}

impl SourceText {
    /// Reads a text.
    pub fn new(text: &str) -> Self {
        let (text, has_mark) = text.strip_prefix(MARK).map_or((text, false), |rest| (rest, true));
        let bytes = text.as_bytes();
        let is_end = |at: &usize| match bytes[*at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let starts = std::iter::once(0).chain((0..bytes.len()).filter(is_end).map(|at| at + 1)).collect();
        Self { text: text.into(), starts, has_mark }
    }

    /// The bytes of a line, from 0, without its line break.
    pub fn line(&self, line: usize) -> Range<usize> {
        let start = self.starts.get(line).copied().unwrap_or(self.text.len());
        let end = self.starts.get(line + 1).copied().unwrap_or(self.text.len());
        start..start + self.text[start..end].trim_end_matches(['\n', '\r']).len()
    }

    /// The number of the line that holds a byte, from 0.
    pub fn line_of(&self, byte: usize) -> usize {
        self.starts.partition_point(|start| *start <= byte).saturating_sub(1)
    }

    /// The byte of a place. One behind the end of a line is that end, and one in the middle of a character is the begin of that.
    pub fn byte(&self, place: Position) -> usize {
        let line = self.line(place.line as usize);
        let mark = u32::from(self.has_mark && place.line == 0);
        let mut left = place.character.saturating_sub(mark) as usize;
        for (at, c) in self.text[line.clone()].char_indices() {
            if left < c.len_utf16() {
                return line.start + at;
            }
            left -= c.len_utf16();
        }
        line.end
    }

    /// The place of a byte.
    pub fn place(&self, byte: usize) -> Position {
        let byte = byte.min(self.text.len());
        let line = self.line_of(byte);
        let mut end = byte;
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let units = self.text[self.starts[line]..end].encode_utf16().count() + usize::from(self.has_mark && line == 0);
        Position::new(number(line), number(units))
    }

    /// The places of bytes.
    pub fn span(&self, bytes: Range<usize>) -> Span {
        Span::new(self.place(bytes.start), self.place(bytes.end))
    }

    /// The bytes between two places.
    pub fn bytes(&self, span: Span) -> Range<usize> {
        let (a, b) = (self.byte(span.start), self.byte(span.end));
        a.min(b)..a.max(b)
    }

    /// The text after changes, in their order.
    pub fn changed(&self, changes: &[TextDocumentContentChangeEvent]) -> Self {
        let mut now = self.clone();
        for change in changes {
            let Some(span) = change.range else {
                now = Self::new(&change.text);
                continue;
            };
            let bytes = now.bytes(span);
            // The change may replace the mark.
            let from_mark = now.has_mark && span.start == Position::new(0, 0) && span.end != span.start;
            let mut text = String::with_capacity(now.text.len() + change.text.len());
            if now.has_mark && !from_mark {
                text.push(MARK);
            }
            text.push_str(&now.text[..bytes.start]);
            text.push_str(&change.text);
            text.push_str(&now.text[bytes.end..]);
            now = Self::new(&text);
        }
        now
    }
}

/// A number of the protocol.
pub fn number(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn change(from: (u32, u32), to: (u32, u32), text: &str) -> TextDocumentContentChangeEvent {
        let range = Some(Span::new(Position::new(from.0, from.1), Position::new(to.0, to.1)));
        TextDocumentContentChangeEvent { range, range_length: None, text: text.to_owned() }
    }

    #[test]
    fn places_count_utf_16() {
        let text = SourceText::new("a𝄞é\r\n日b\rc\n\n");
        let places: Vec<_> = text.text.char_indices().map(|(byte, _)| text.place(byte)).collect();
        let expected = [(0, 0), (0, 1), (0, 3), (0, 4), (0, 5), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (3, 0)];
        assert_eq!(places, expected.map(|(line, character)| Position::new(line, character)));
        for (byte, _) in text.text.char_indices().filter(|(_, c)| !matches!(c, '\r' | '\n')) {
            assert_eq!(text.byte(text.place(byte)), byte);
        }
        // In the middle of a pair, behind the end of a line, behind the end of the text.
        assert_eq!((text.byte(Position::new(0, 2)), text.byte(Position::new(0, 99))), (1, 7));
        assert_eq!((text.byte(Position::new(9, 9)), text.text.len()), (text.text.len(), 17));
        assert_eq!(SourceText::new("").place(7), Position::new(0, 0));
    }

    #[test]
    fn changes_apply_in_order_and_none_is_out_of_range() {
        let text = SourceText::new("one\r\ntwo\r\n");
        let now =
            text.changed(&[change((0, 3), (1, 0), " "), change((0, 4), (0, 7), "𝄞"), change((0, 6), (7, 7), "!")]);
        assert_eq!(&*now.text, "one 𝄞!");
        let now = text.changed(&[change((1, 2), (0, 1), "")]);
        assert_eq!(&*now.text, "oo\r\n");
        let whole = TextDocumentContentChangeEvent { range: None, range_length: None, text: "new".to_owned() };
        assert_eq!(&*text.changed(&[whole]).text, "new");
    }

    #[test]
    fn a_byte_order_mark_is_counted_as_the_client_counts_it() {
        let text = SourceText::new("\u{feff}ab\nc");
        assert_eq!((&*text.text, text.place(1), text.byte(Position::new(0, 1))), ("ab\nc", Position::new(0, 2), 0));
        assert_eq!(text.place(3), Position::new(1, 0));
        let now = text.changed(&[change((0, 2), (0, 2), "x")]);
        assert_eq!((&*now.text, now.place(0)), ("axb\nc", Position::new(0, 1)));
        let now = now.changed(&[change((0, 0), (0, 2), "")]);
        assert_eq!((&*now.text, now.place(0)), ("xb\nc", Position::new(0, 0)));
    }
}
