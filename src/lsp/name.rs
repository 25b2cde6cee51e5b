//! Names in texts.

use crate::shader::glsl::{Token, TokenKind, is_word, tokens};

/// A name in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct NameAt {
    /// The name.
    pub text: String,
    /// Its bytes.
    pub bytes: std::ops::Range<usize>,
    /// Whether it stands behind a dot.
    pub is_member: bool,
}

/// Whether a dot stands before a byte on its line. One at the end of a line is being typed.
pub fn is_behind_dot(text: &str, byte: usize) -> bool {
    text[..byte].trim_end_matches([' ', '\t']).ends_with('.')
}

/// The name that holds a byte of a text or ends there: in code, in a directive, or in an annotation.
pub fn name_at(text: &str, byte: usize) -> Option<NameAt> {
    let holds = |token: &Token<'_>| token.bytes.start <= byte && byte <= token.bytes.end;
    let mut in_comment = None;
    for token in tokens(text).take_while(|token| token.bytes.start <= byte) {
        match token.kind {
            TokenKind::Word if holds(&token) => {
                let is_member = is_behind_dot(text, token.bytes.start);
                return Some(NameAt { text: token.text.to_owned(), bytes: token.bytes, is_member });
            }
            TokenKind::Comment if holds(&token) => in_comment = Some(token.bytes.clone()),
            _ => {}
        }
    }
    // A name in an annotation, as behind `when=`.
    let comment = in_comment.filter(|bytes| text[bytes.clone()].starts_with("//@"))?;
    if !text.is_char_boundary(byte) {
        return None;
    }
    let start = byte - text[comment.start..byte].chars().rev().take_while(|c| is_word(*c)).count();
    let end = byte + text[byte..comment.end.max(byte)].chars().take_while(|c| is_word(*c)).count();
    let is_name = start < end && !text[start..end].starts_with(|c: char| c.is_ascii_digit());
    is_name.then(|| NameAt { text: text[start..end].to_owned(), bytes: start..end, is_member: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_where_they_begin_and_end() {
        let text = "a.b1 + ä; // c\n#define D e\nf; //@ui when=BLOOM = 1\n";
        let name = |part: &str, plus: usize| {
            name_at(text, text.find(part).unwrap() + plus).map(|name| (name.text, name.is_member))
        };
        assert_eq!(name("a.", 0), Some(("a".to_owned(), false)));
        assert_eq!(name("b1", 1), Some(("b1".to_owned(), true)));
        assert_eq!(name("b1", 2), Some(("b1".to_owned(), true)));
        assert_eq!((name("+", 1), name("c\n", 0)), (None, None));
        assert_eq!(name("e\nf", 0), Some(("e".to_owned(), false)));
        assert_eq!(name("BLOOM", 2), Some(("BLOOM".to_owned(), false)));
        assert_eq!((name_at(text, text.len()), name_at(text, 8)), (None, None));
    }
}
