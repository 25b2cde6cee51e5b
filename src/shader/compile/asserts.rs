//! `assert(condition)`, `assert(condition, "message")` and `print("name", value)`, which GLSL lacks, as it lacks texts.
//!
//! Before a file reaches the compiler, each text in such a call becomes its number in the file, filled up with spaces, so that no column
//! moves. A stage that does not compile since it has no such functions is compiled again with functions that do nothing, which cost
//! nothing. `spirv/checks/` looks for their calls. A tree that declares functions or macros of these names has its own.

use std::borrow::Cow;

use crate::shader::glsl::{Token, TokenKind, code, tokens};

/// The names of the functions.
const NAMES: [&str; 2] = ["assert", "print"];
/// The types of values that are printed.
const PRINTED: [&str; 16] = [
    "float", "vec2", "vec3", "vec4", "int", "ivec2", "ivec3", "ivec4", "uint", "uvec2", "uvec3", "uvec4", "bool",
    "bvec2", "bvec3", "bvec4",
];

/// The text as the compiler gets it: with numbers instead of texts.
pub(super) fn numbered(text: &str) -> Cow<'_, str> {
    // Few files have such calls.
    if !NAMES.iter().any(|name| text.contains(name)) || !text.contains('"') {
        return Cow::Borrowed(text);
    }
    let code = code(text);
    let mut out = Cow::Borrowed(text);
    for (number, token) in texts_of(&code).into_iter().enumerate() {
        let (digits, length) = (number.to_string(), token.bytes.len());
        // Its message is not told if the number has no room.
        let digits = if digits.len() <= length { digits } else { "0".to_owned() };
        out.to_mut().replace_range(token.bytes.clone(), &format!("{digits:<length$}"));
    }
    out
}

/// Whether a text of the tree calls them, or has functions of these names.
pub fn has_calls(text: &str) -> bool {
    let is_call = |pair: &[Token<'_>]| NAMES.contains(&pair[0].text) && pair[1].text == "(";
    NAMES.iter().any(|name| text.contains(name)) && code(text).windows(2).any(is_call)
}

/// The text with this number in the calls of a file, without its quotes.
pub fn text_of(file: &str, number: u32) -> Option<String> {
    let code = code(file);
    let texts = texts_of(&code);
    let token = texts.get(number as usize)?;
    Some(token.text.trim_matches('"').to_owned())
}

/// The texts in the calls, in their order.
fn texts_of<'a, 'b>(code: &'b [Token<'a>]) -> Vec<&'b Token<'a>> {
    let mut found = Vec::new();
    for (at, pair) in code.windows(2).enumerate() {
        if !NAMES.contains(&pair[0].text) || pair[1].text != "(" {
            continue;
        }
        let mut depth = 0;
        for token in &code[at + 1..] {
            match (token.kind, token.text) {
                (TokenKind::Sign, "(") => depth += 1,
                (TokenKind::Sign, ")") => depth -= 1,
                (TokenKind::Sign, ";") => depth = 0,
                (TokenKind::Text, _) if depth == 1 => found.push(token),
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    found
}

/// The text of a stage that has the functions, if a log says that they lack. No line moves.
pub(super) fn with_functions(text: &str, log: &str) -> Option<String> {
    let lacks = |name: &str| log.contains(&format!("'{name}' : no matching overloaded function found"));
    let lacking = NAMES.map(lacks);
    if lacking == [false; 2] {
        return None;
    }
    let prints = PRINTED.iter().map(|kind| format!("void print(const in int name, const in {kind} value) {{}}"));
    let asserts = ["const in bool condition", "const in bool condition, const in int message"];
    let asserts = asserts.iter().map(|parameters| format!("void assert({parameters}) {{}}"));
    // A tree may have one of them of its own.
    let asserts = asserts.filter(|_| lacking[0]);
    let functions: String = asserts.chain(prints.filter(|_| lacking[1])).collect::<Vec<_>>().join(" ");
    let start = after_extensions(text);
    let next = text[..start].lines().count() + 1;
    Some(format!("{}{functions}\n#line {next}\n{}", &text[..start], &text[start..]))
}

/// The first byte of the line behind the version and the extensions, which come before all functions.
fn after_extensions(text: &str) -> usize {
    let mut end = 0;
    let mut all = tokens(text).filter(|token| token.kind != TokenKind::Comment).peekable();
    while let Some(token) = all.next() {
        if token.kind != TokenKind::Directive {
            break;
        }
        let is_head = all.peek().is_some_and(|next| matches!(next.text, "version" | "extension"));
        while all.next_if(|next| next.in_directive && next.kind != TokenKind::Directive).is_some() {}
        if !is_head {
            break;
        }
        let from = token.bytes.start;
        end = text[from..].find('\n').map_or(text.len(), |at| from + at + 1);
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_become_numbers_and_no_column_moves() {
        let text =
            "assert(a > 0.0, \"first, of (two)\"); print(\"b\", f(b, \"no\"));\nassert(c); // assert(d, \"comment\")\n";
        let numbered = numbered(text);
        assert_eq!(numbered.len(), text.len());
        assert_eq!(
            numbered,
            "assert(a > 0.0, 0                ); print(1  , f(b, \"no\"));\nassert(c); // assert(d, \"comment\")\n"
        );
        assert_eq!([0, 1, 2].map(|n| text_of(text, n)), [Some("first, of (two)".into()), Some("b".into()), None]);
        for plain in ["assert(a > 0.0);", "// print(\"a\", b)", "int printed = 1;"] {
            assert_eq!(super::numbered(plain), plain);
        }
    }

    #[test]
    fn functions_stand_behind_the_extensions() {
        let log = "a.frag:3: error: 'assert' : no matching overloaded function found";
        let text =
            "// head\n#version 460\n#extension A : require\n\n#include \"b.glsl\"\nvoid main() { assert(true); }\n";
        let with = with_functions(text, log).unwrap();
        assert!(with.starts_with("// head\n#version 460\n#extension A : require\nvoid assert("), "{with}");
        assert!(with.ends_with("\n#line 4\n\n#include \"b.glsl\"\nvoid main() { assert(true); }\n"), "{with}");
        assert_eq!(with_functions(text, "a.frag:3: error: 'assertion' : undeclared identifier"), None);
    }
}
