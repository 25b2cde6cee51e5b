//! The names that can be watched on a line.

use crate::shader::glsl::syntax::{Function, Statement, StatementKind, functions, within};
use crate::shader::glsl::{Code, Token, is_name};

/// The types whose values can be shown.
const TYPES: [&str; 17] = [
    "float", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4",
    "bvec3", "mat2", "mat3", "mat4",
];

/// The variables with a value of a simple type that are declared at the end of a line, the nearest first, with their types. Those of
/// the line itself come before.
pub fn variables(text: &str, number: u32) -> Vec<(String, String)> {
    let code = Code::new(text);
    let tokens = &code.tokens;
    let end = code.start(number) + code.line(number).map_or(0, |line| line.raw.len());
    let start = code.start(number);
    let inside = |function: &&Function| {
        let whole = function.head.start..function.body.bytes.end;
        whole.start < end.max(start + 1) && whole.end > start
    };
    let mut out = Vec::new();
    if let Some(function) = functions(tokens).iter().find(inside) {
        collect(&function.body, end, tokens, &mut out);
        out.reverse();
        declared(tokens, function.head.start..function.head.end, &mut out);
    }
    out.dedup();
    let mut seen = std::collections::BTreeSet::new();
    out.retain(|(name, _)| seen.insert(name.clone()));
    out
}

/// Adds what the statements declare that begin before `end` and whose blocks hold it.
fn collect(statement: &Statement, end: usize, tokens: &[Token<'_>], out: &mut Vec<(String, String)>) {
    for part in &statement.parts {
        if part.bytes.start > end {
            break;
        }
        match part.kind {
            StatementKind::Simple => declared(tokens, part.bytes.clone(), out),
            StatementKind::Jump => {}
            _ if part.bytes.end >= end => {
                declared(tokens, part.header.clone(), out);
                collect(part, end, tokens, out);
            }
            _ => {}
        }
    }
}

/// Adds the variables that a piece of code declares: `TYPE NAME`, and after it `, NAME` with an initializer or none.
fn declared(tokens: &[Token<'_>], bytes: std::ops::Range<usize>, out: &mut Vec<(String, String)>) {
    let inside = within(tokens, &bytes);
    let mut kind = None;
    let mut depth = 0_i32;
    for (at, token) in inside.iter().enumerate() {
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        let before = at.checked_sub(1).and_then(|at| inside.get(at)).map_or("", |token| token.text);
        let after = inside.get(at + 1).map_or("", |token| token.text);
        if TYPES.contains(&before) && is_name(token.text) && matches!(after, "=" | ";" | "," | ")" | "") {
            out.push((token.text.to_owned(), before.to_owned()));
            kind = Some((before, depth));
        } else if before == "," && is_name(token.text) && matches!(after, "=" | ";" | ",") {
            let of_list = kind.filter(|(_, declared)| *declared == depth);
            out.extend(of_list.map(|(kind, _)| (token.text.to_owned(), kind.to_owned())));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variables_of_a_line() {
        let text = "float g(float a, inout vec3 b, Surface s) {\n    float c = f(a, b.x), d;\n    if (c > 0.0) { int e = 1; }\n    \
            for (uint i = 0u; i < 4u; ++i) {\n        mat3 m = mat3(1.0);\n    }\n    vec2 late;\n}\nfloat h() { return 1.0; }\n";
        let names = |line| variables(text, line).into_iter().map(|(name, _)| name).collect::<Vec<_>>().join(" ");
        assert_eq!(names(1), "a b");
        assert_eq!(names(2), "d c a b");
        assert_eq!(names(5), "m i d c a b");
        assert_eq!(names(7), "late d c a b");
        assert_eq!(names(9), "");
        assert_eq!(variables(text, 5)[1], ("i".to_owned(), "uint".to_owned()));
    }
}
