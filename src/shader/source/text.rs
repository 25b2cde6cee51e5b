//! Splits GLSL text into lines with code and annotations. Line numbers are the same as glslang's.

use std::ops::Range;

/// One line of a file.
#[derive(Debug, Clone)]
pub struct Line<'a> {
    /// 1-based.
    pub number: u32,
    /// The line without its line break.
    pub raw: &'a str,
    /// `raw` with every byte of a comment replaced by a space, so that byte offsets are the same.
    pub code: String,
    /// Byte offset of a `//@` that is not inside another comment.
    pub annotation: Option<usize>,
}

/// Splits a file into lines. Block comments may span lines.
pub fn lines(text: &str) -> Vec<Line<'_>> {
    let mut in_block = false;
    let mut out = Vec::new();
    for (number, raw) in (1..).zip(text.lines()) {
        let mut code = raw.as_bytes().to_vec();
        let mut annotation = None;
        let mut at = 0;
        while at < code.len() {
            let rest = &raw.as_bytes()[at..];
            if in_block {
                let end = rest.windows(2).position(|pair| pair == b"*/").map(|end| end + 2);
                in_block = end.is_none();
                let end = at + end.unwrap_or(rest.len());
                code[at..end].fill(b' ');
                at = end;
            } else if rest.starts_with(b"//") {
                if rest.starts_with(b"//@") {
                    annotation = Some(at);
                }
                code[at..].fill(b' ');
                at = code.len();
            } else if rest.starts_with(b"/*") {
                in_block = true;
                code[at..at + 2].fill(b' ');
                at += 2;
            } else {
                at += 1;
            }
        }
        // Comments begin and end at ASCII characters, so no character is split.
        out.push(Line { number, raw, code: String::from_utf8_lossy(&code).into_owned(), annotation });
    }
    out
}

/// Whether two texts differ in comments and white space at most. Annotations count as code.
pub fn is_same_code(a: &str, b: &str) -> bool {
    let code = |text: &str| -> Vec<(String, String)> {
        let parts = |line: Line<'_>| {
            let code = line.code.split_whitespace().collect::<Vec<_>>().join(" ");
            (code, line.annotation.map_or("", |at| line.raw[at..].trim_end()).to_owned())
        };
        let all = lines(text).into_iter().map(parts);
        all.filter(|(code, annotation)| !code.is_empty() || !annotation.is_empty()).collect()
    };
    a == b || code(a) == code(b)
}

/// Whether a character may be part of an identifier.
pub fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
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

/// The words, numbers and single signs of a line of code, with their byte ranges.
pub fn tokens(code: &str) -> Vec<(Range<usize>, &str)> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(c) = code[at..].chars().next() {
        let length = if is_word(c) {
            let number = c.is_ascii_digit();
            code[at..].find(|c| !(is_word(c) || (number && c == '.'))).unwrap_or(code.len() - at)
        } else {
            c.len_utf8()
        };
        if !c.is_whitespace() {
            out.push((at..at + length, &code[at..at + length]));
        }
        at += length;
    }
    out
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
    }

    #[test]
    fn words_are_whole() {
        assert_eq!(find_word("foo.food + foo", "foo"), Some(0..3));
        assert_eq!(find_word("food + foo", "foo"), Some(7..10));
        assert_eq!(find_word("a }", "}"), Some(2..3));
        assert_eq!(find_word("abc", ""), None);
        let words: Vec<&str> = tokens("x=1.5f*(y2)").into_iter().map(|(_, word)| word).collect();
        assert_eq!(words, ["x", "=", "1.5f", "*", "(", "y2", ")"]);
    }
}
