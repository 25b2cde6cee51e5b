//! The functions of a file, which can be folded.

use std::ops::Range;

use crate::shader::symbols::{SymbolKind, Symbols};

/// A function whose body has lines of its own.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Function {
    /// Its name, with a number for overloads.
    pub(super) name: String,
    /// The indices of its lines.
    pub(super) lines: Range<usize>,
}

/// The functions of a text, in order.
pub(super) fn functions(text: &str) -> Vec<Function> {
    let line_of = |byte: usize| text[..byte].matches('\n').count();
    let mut found: Vec<Function> = Vec::new();
    let bodies = Symbols::of(text).all;
    for symbol in bodies.iter().filter(|symbol| symbol.kind == SymbolKind::Function && symbol.has_body) {
        let lines = line_of(symbol.whole.start)..line_of(symbol.whole.end) + 1;
        if lines.len() > 1 {
            let same =
                bodies.iter().filter(|other| other.name == symbol.name && other.bytes.start < symbol.bytes.start);
            let name = format!("{} {}", symbol.name, same.count());
            found.push(Function { name, lines });
        }
    }
    found
}

/// The place of a line in a function.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fold {
    pub(super) name: String,
    /// The lines of the function that are hidden; 0 if it is open.
    pub(super) hidden: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_have_their_lines() {
        let text = "float one() { return 1.0; }\nfloat f(float x) {\n    return x;\n}\n\nfloat f(vec2 x)\n{\n    return x.x;\n}\nfloat g(float);\n";
        let found = functions(text);
        let lines: Vec<(&str, Range<usize>)> =
            found.iter().map(|function| (function.name.as_str(), function.lines.clone())).collect();
        assert_eq!(lines, [("f 0", 1..4), ("f 1", 5..9)]);
    }
}
