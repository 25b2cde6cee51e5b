//! Initial values of variables that an author does not set. WebGL starts each variable at 0 where it is declared; the compiled
//! modules do so only at the start of a function (`spirv/initial.rs`), which is too early in a loop and for a parameter.

use std::ops::Range;

use super::declared::TYPES;
use crate::shader::glsl::syntax::{Statement, StatementKind, functions, outside_brackets, within};
use crate::shader::glsl::{Token, is_name};

/// Bytes of a text, and what replaces them.
pub(super) type Edit = (Range<usize>, String);

/// Adds a 0 to declarations in loops, and sets output parameters to 0. Arrays and structs are left as they are.
pub(super) fn initial_values(code: &[Token<'_>]) -> Vec<Edit> {
    let mut edits = Vec::new();
    for function in functions(code) {
        let head = within(code, &function.head);
        let parameters =
            head.iter().position(|token| token.text == "(").map_or(&[][..], |at| &head[at + 1..head.len() - 1]);
        let set: String = parameters.split(|token| token.text == ",").filter_map(output).collect();
        let start = function.body.bytes.start + 1;
        edits.push((start..start, set));
        walk(code, &function.body, false, &mut edits);
    }
    edits
}

/// The assignment of 0 to an output parameter.
fn output(parameter: &[Token<'_>]) -> Option<String> {
    let words: Vec<&str> = parameter.iter().map(|token| token.text).collect();
    let words: Vec<&str> = words.into_iter().filter(|word| !is_precision(word)).collect();
    match words.as_slice() {
        ["out", kind, name] if TYPES.contains(kind) => Some(format!(" {name} = {kind}(0);")),
        _ => None,
    }
}

fn is_precision(word: &str) -> bool {
    matches!(word, "lowp" | "mediump" | "highp")
}

fn walk(code: &[Token<'_>], statement: &Statement, is_in_loop: bool, edits: &mut Vec<Edit>) {
    let is_loop = matches!(statement.kind, StatementKind::Loop | StatementKind::DoLoop);
    if is_in_loop && statement.kind == StatementKind::Simple {
        declare(within(code, &statement.bytes), edits);
    }
    if is_in_loop && statement.kind == StatementKind::Loop {
        declare(&within(code, &statement.header)[1..], edits);
    }
    statement.parts.iter().for_each(|part| walk(code, part, is_in_loop || is_loop, edits));
}

/// Adds a 0 to each variable of a declaration, up to its semicolon, that has no initial value.
fn declare(tokens: &[Token<'_>], edits: &mut Vec<Edit>) {
    let first = tokens.iter().position(|token| !is_precision(token.text)).unwrap_or(0);
    let Some((kind, rest)) = tokens[first..].split_first().filter(|(kind, _)| TYPES.contains(&kind.text)) else {
        return;
    };
    if !rest.first().is_some_and(|name| is_name(name.text)) {
        return;
    }
    let end = rest.iter().position(|token| token.text == ";").unwrap_or(rest.len());
    let mut is_first = true;
    let outside: Vec<(usize, &Token<'_>)> = outside_brackets(&rest[..end]).collect();
    for (at, token) in outside {
        let next = rest.get(at + 1).map_or("", |next| next.text);
        if std::mem::replace(&mut is_first, token.text == ",") && is_name(token.text) && matches!(next, "," | ";") {
            edits.push((token.bytes.end..token.bytes.end, format!(" = {}(0)", kind.text)));
        }
    }
}

/// A text with its edits.
pub(super) fn apply(text: &str, mut edits: Vec<Edit>) -> String {
    // Of two edits that overlap, the one that begins first or is longer holds.
    edits.sort_by_key(|(bytes, _)| (bytes.start, std::cmp::Reverse(bytes.end)));
    let (mut out, mut end) = (String::with_capacity(text.len() + 64), 0);
    for (bytes, by) in edits.into_iter().filter(|(bytes, by)| !bytes.is_empty() || !by.is_empty()) {
        if bytes.start >= end {
            out += &text[end..bytes.start];
            out += &by;
            end = bytes.end;
        }
    }
    out + &text[end..]
}

/// Spaces in place of these bytes; line breaks stay.
pub(super) fn blank(text: &str, bytes: Range<usize>) -> Edit {
    let spaces = text[bytes.clone()].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' });
    (bytes, spaces.collect())
}

#[cfg(test)]
mod tests {
    use super::super::adapt::adapted;

    #[test]
    fn variables_of_loops_start_at_0_in_each_round() {
        for (text, expected) in [
            (
                "void f() { float i, d; for (float j; j < 9.0; j++) { vec3 p, q = vec3(1.0, 2.0, 3.0), r; int a[2]; } }",
                "void f() { float i, d; for (float j; j < 9.0; j++) { vec3 p = vec3(0), q = vec3(1.0, 2.0, 3.0), r = vec3(0); int a[2]; } }",
            ),
            (
                "void f() { while (true) for (highp float i, j = 2.; i < j; ) if (i > 1.) { S s; float x = 1.; } }",
                "void f() { while (true) for (highp float i = float(0), j = 2.; i < j; ) if (i > 1.) { S s; float x = 1.; } }",
            ),
            (
                "void g(out vec3 c, inout vec2 d, out S s) { c += 1.0; }",
                "void g(out vec3 c, inout vec2 d, out S s) { c = vec3(0); c += 1.0; }",
            ),
            (
                "void h() { do { vec2(1.0); float x; } while (y); }",
                "void h() { do { vec2(1.0); float x = float(0); } while (y); }",
            ),
        ] {
            assert_eq!(adapted(text, "image"), expected);
        }
    }
}
