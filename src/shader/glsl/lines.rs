//! The lines of GLSL. Their numbers are those of glslang.

use std::borrow::Cow;
use std::ops::Range;

use super::token::{Token, TokenKind, code, is_word, tokens};

/// A line of a text.
#[derive(Clone, Debug)]
pub struct Line<'a> {
    /// From 1.
    pub number: u32,
    /// The byte of the text at which it begins.
    pub start: usize,
    /// The line without its line break.
    pub raw: &'a str,
    /// `raw` with a space for every byte of a comment, so that byte offsets are the same.
    pub code: Cow<'a, str>,
    /// Byte offset in the line of a `//@` that is not inside another comment.
    pub annotation: Option<usize>,
    /// The keyword of the preprocessor directive that begins on the line; empty for one without a keyword.
    pub keyword: Option<&'a str>,
    /// Whether a preprocessor directive has tokens on the line.
    pub is_directive: bool,
}

impl<'a> Line<'a> {
    /// Whether nothing but comments and white space is on the line.
    pub fn is_blank(&self) -> bool {
        self.code.trim().is_empty()
    }

    /// Whether the line has code that is no preprocessor directive.
    pub fn is_code(&self) -> bool {
        !self.is_directive && !self.is_blank()
    }

    /// The bytes of `code` without the white space around it.
    pub fn trimmed(&self) -> Range<usize> {
        self.code.len() - self.code.trim_start().len()..self.code.trim_end().len()
    }

    /// The tokens of the line, with their bytes in the line.
    pub fn tokens(&self) -> Vec<Token<'_>> {
        tokens(&self.code).collect()
    }

    /// Replaces these bytes of the text by spaces.
    fn blank(&mut self, bytes: &Range<usize>) {
        let in_line = |byte: usize| byte.saturating_sub(self.start).min(self.raw.len());
        let bytes = in_line(bytes.start)..in_line(bytes.end);
        self.code.to_mut().replace_range(bytes.clone(), &" ".repeat(bytes.len()));
    }
}

/// Splits a text into lines.
pub fn lines(text: &str) -> Vec<Line<'_>> {
    let mut start = 0;
    let with_breaks = text.split_inclusive('\n').zip(text.lines()).zip(1..);
    let line = |((with_break, raw), number): ((&str, _), _)| {
        let line =
            Line { number, start, raw, code: Cow::Borrowed(raw), annotation: None, keyword: None, is_directive: false };
        start += with_break.len();
        line
    };
    let mut lines: Vec<Line<'_>> = with_breaks.map(line).collect();
    let mut first = 0;
    let mut tokens = tokens(text).peekable();
    while let Some(token) = tokens.next() {
        if token.kind != TokenKind::Comment && !token.in_directive {
            continue;
        }
        while lines.get(first + 1).is_some_and(|next| next.start <= token.bytes.start) {
            first += 1;
        }
        for line in lines[first..].iter_mut().take_while(|line| line.start < token.bytes.end) {
            line.is_directive |= token.in_directive;
            if token.kind == TokenKind::Comment {
                line.blank(&token.bytes);
            }
        }
        let line = &mut lines[first];
        if token.text.starts_with("//@") {
            line.annotation = Some(token.bytes.start - line.start);
        }
        if token.kind == TokenKind::Directive {
            let keyword = tokens.peek().filter(|next| next.in_directive && next.kind == TokenKind::Word);
            line.keyword = Some(keyword.map_or("", |keyword| keyword.text));
        }
    }
    lines
}

/// The lines of a text, and its tokens outside of comments and directives.
#[derive(Debug)]
pub struct Code<'a> {
    text: &'a str,
    lines: Vec<Line<'a>>,
    /// The tokens, in order.
    pub tokens: Vec<Token<'a>>,
}

impl<'a> Code<'a> {
    /// Reads a text.
    pub fn new(text: &'a str) -> Self {
        Self { text, lines: lines(text), tokens: code(text) }
    }

    /// A line by its number, from 1.
    pub fn line(&self, number: u32) -> Option<&Line<'a>> {
        self.lines.get((number as usize).checked_sub(1)?)
    }

    /// All lines.
    pub fn lines(&self) -> &[Line<'a>] {
        &self.lines
    }

    /// The byte at which a line begins, by its number, from 1. The end of the text for a line behind it.
    pub fn start(&self, number: u32) -> usize {
        self.line(number).map_or(self.text.len(), |line| line.start)
    }

    /// The number of the line that holds a byte, from 1.
    pub fn number_at(&self, byte: usize) -> u32 {
        u32::try_from(self.lines.partition_point(|line| line.start <= byte)).unwrap_or(u32::MAX)
    }
}

/// Whether two texts differ in comments and white space at most. Annotations count as code.
pub fn is_same_code(a: &str, b: &str) -> bool {
    fn code(text: &str) -> impl Iterator<Item = (TokenKind, &str, bool, bool)> {
        let mut end = usize::MAX;
        let code = tokens(text).filter(|token| token.kind != TokenKind::Comment || token.text.starts_with("//@"));
        code.map(move |token| {
            // Two signs that touch may be one operator.
            let is_attached = std::mem::replace(&mut end, token.bytes.end) == token.bytes.start;
            (token.kind, token.text.trim_end(), token.in_directive, is_attached)
        })
    }
    a == b || code(a).eq(code(b))
}

/// Byte range of `word` in `code`. If `word` is an identifier, it must be a whole word there.
pub fn find_word(code: &str, word: &str) -> Option<Range<usize>> {
    if word.is_empty() {
        return None;
    }
    let starts = word.starts_with(is_word);
    let ends = word.ends_with(is_word);
    code.match_indices(word).map(|(at, _)| at..at + word.len()).find(|range| {
        let before = code[..range.start].chars().next_back().is_some_and(is_word);
        let after = code[range.end..].chars().next().is_some_and(is_word);
        !(starts && before || ends && after)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_no_code() {
        let text = "float f() { return 1.0; }\n//@ui \"A\" 0..1\n";
        for same in [
            "// New.\n\nfloat f() {   return 1.0; } // Why.\n//@ui \"A\" 0..1\n",
            "/* a\n b */ float f() { return 1.0; }\n  //@ui \"A\" 0..1",
            "float f() {\n    return 1.0;\n}\n//@ui \"A\" 0..1\n",
        ] {
            assert!(is_same_code(text, same), "{same}");
        }
        for other in [text.replace("1.0", "2.0"), text.replace("0..1", "0..2"), text.replace("float", "//float")] {
            assert!(!is_same_code(text, &other), "{other}");
        }
    }

    #[test]
    fn comments_become_spaces_and_annotations_are_found() {
        let text = "int a; /* b\r\n//@mode no\n*/ float c; //@ui \"ä\"\n// write //@ui here\nvoid";
        let lines = lines(text);
        let code: Vec<&str> = lines.iter().map(|line| line.code.trim_end()).collect();
        assert_eq!(code, ["int a;", "", "   float c;", "", "void"]);
        let annotations: Vec<Option<usize>> = lines.iter().map(|line| line.annotation).collect();
        assert_eq!(annotations, [None, None, Some(12), None, None]);
        let raw: Vec<&str> = lines.iter().map(|line| line.raw).collect();
        assert_eq!(raw, text.lines().collect::<Vec<_>>());
        assert!(lines.iter().all(|line| text[line.start..].starts_with(line.raw) && line.code.len() == line.raw.len()));
    }

    #[test]
    fn directives_are_marked() {
        let lines = lines("#define A \\\n  b\n /* # */ # if A\n#\na /*\n#if */ #x\n");
        let found: Vec<_> = lines.iter().map(|line| (line.keyword, line.is_directive)).collect();
        let none = (None, false);
        assert_eq!(found, [(Some("define"), true), (None, true), (Some("if"), true), (Some(""), true), none, none]);
        assert!(lines[4].is_code() && !lines[0].is_code());
    }

    #[test]
    fn lines_are_found_by_bytes() {
        let code = Code::new("a\nb // c\n\nd");
        assert_eq!([1, 2, 3, 4, 5].map(|number| code.start(number)), [0, 2, 9, 10, 11]);
        assert_eq!([0, 1, 2, 8, 9, 10].map(|byte| code.number_at(byte)), [1, 1, 2, 2, 3, 4]);
    }

    #[test]
    fn words_are_whole() {
        assert_eq!(find_word("foo.food + foo", "foo"), Some(0..3));
        assert_eq!(find_word("food + foo", "foo"), Some(7..10));
        assert_eq!(find_word("a }", "}"), Some(2..3));
        assert_eq!(find_word("abc", ""), None);
    }
}
