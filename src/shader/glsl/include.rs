//! The includes of a file, as they are written.

use std::ops::Range;

use super::token::{Token, TokenKind, tokens};

/// An `#include "name"`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Include<'a> {
    /// The name.
    pub name: &'a str,
    /// The bytes of the name in the text.
    pub bytes: Range<usize>,
}

/// The includes of a text, in its order. Conditions are not evaluated; includes in comments do not count.
pub fn includes(text: &str) -> impl Iterator<Item = Include<'_>> {
    let mut tokens = tokens(text).filter(|token| token.kind != TokenKind::Comment).peekable();
    std::iter::from_fn(move || {
        loop {
            let follows = |token: &Token<'_>| token.in_directive && token.kind != TokenKind::Directive;
            let is_include = |token: &Token<'_>| token.in_directive && token.text == "include";
            if tokens.next()?.kind != TokenKind::Directive || tokens.next_if(is_include).is_none() {
                continue;
            }
            let Some(name) = tokens.next_if(follows) else { continue };
            let length = match name.text {
                "<" => text[name.bytes.end..].lines().next().and_then(|line| line.find('>')),
                quoted if name.kind == TokenKind::Text => Some(quoted.len() - 2),
                _ => None,
            };
            let Some(length) = length else { continue };
            let bytes = name.bytes.start + 1..name.bytes.start + 1 + length;
            return Some(Include { name: &text[bytes.clone()], bytes });
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found() {
        let text = "#include \"a.glsl\" // \"b\"\n // #include \"c\"\n  # include<d>\n#\ninclude \"l\"\n#include <k\n#include\n#includes \"e\"\n/*\n\
                    #include \"f\" */ #include \"g//h\"\n#include \"i\n#define X include \"j\"\n";
        let found: Vec<_> = includes(text).collect();
        let names: Vec<&str> = found.iter().map(|include| include.name).collect();
        assert_eq!(names, ["a.glsl", "d", "g//h"]);
        assert!(found.iter().all(|include| text[include.bytes.clone()] == *include.name));
    }
}
