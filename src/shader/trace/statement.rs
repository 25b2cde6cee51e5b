//! The statement at a place of a traced module, for a reader.

use std::ops::Range;

use serde::Serialize;

use crate::shader::contract::Texts;
use crate::shader::glsl::syntax::{Statement, StatementKind, functions, within};
use crate::shader::glsl::{Code, Token, code, spelled};
use crate::shader::source::TreePath;
use crate::shader::spirv::trace::{Place, Purpose};

/// A place that makes a value which is traced.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Site {
    /// The file as its author knows it.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// From 1, in bytes.
    pub column: u32,
    /// The statement on one line, or the declaration of what the stage before has written.
    pub code: String,
}

/// The statement of a place in the text of its file; the declaration, if the place reads an input of the stage.
pub(super) fn site(place: &Place, text: &str, texts: Texts<'_>) -> Site {
    let file = TreePath::from(place.file.as_str());
    if let Purpose::Input(name) = &place.purpose {
        let found = texts.error(&[name.as_str(), "in"], String::new());
        if let (Some(line), Some(excerpt)) = (found.line, &found.excerpt) {
            let column = found.column.unwrap_or(1);
            return Site { file: found.file, line, column, code: spelled(&code(excerpt)) };
        }
    }
    let (column, code) = statement(text, place);
    Site { file: texts.snapshot.display_path(&file), line: place.line, column, code }
}

/// The column and the code of the statement on the line of a place. Among several on the line, the one that fits the purpose.
fn statement(text: &str, place: &Place) -> (u32, String) {
    let code = Code::new(text);
    let mut pieces = Vec::new();
    functions(&code.tokens).iter().for_each(|function| add_pieces(&function.body, &mut pieces));
    let is_here =
        |bytes: &Range<usize>| (code.number_at(bytes.start)..=code.number_at(bytes.end - 1)).contains(&place.line);
    pieces.retain(|bytes| !bytes.is_empty() && is_here(bytes));
    let fits = |tokens: &[Token<'_>]| match &place.purpose {
        Purpose::Store(name) => tokens.iter().any(|token| token.text == name),
        Purpose::Return => tokens.first().is_some_and(|token| token.text == "return"),
        _ => true,
    };
    let found = pieces.iter().find(|bytes| fits(within(&code.tokens, bytes))).or(pieces.first());
    let line = code.start(place.line)..code.start(place.line + 1);
    let tokens = within(&code.tokens, found.unwrap_or(&line));
    let on_line = tokens.iter().find(|token| token.bytes.start >= line.start);
    let column = on_line.map_or(1, |token| token.bytes.start - line.start + 1);
    (u32::try_from(column).unwrap_or(1), spelled(tokens))
}

/// Adds the bytes of the statements in a statement: of one with parts, its header.
fn add_pieces(statement: &Statement, pieces: &mut Vec<Range<usize>>) {
    pieces.push(match statement.kind {
        StatementKind::Simple | StatementKind::Jump => statement.bytes.clone(),
        StatementKind::Branch | StatementKind::Loop => statement.bytes.start..statement.header.end,
        StatementKind::Block | StatementKind::DoLoop => statement.header.clone(),
    });
    statement.parts.iter().for_each(|part| add_pieces(part, pieces));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_statement_of_a_line_is_the_one_that_fits() {
        let text = "float f(float x) {\n    float y = x // half\n        * 0.5;\n    for (float t = 0.0; t < 1.0; t += 0.1) x *= y;\n    \
            do y += x; while (y < 2.0);\n    if (x > 1.0) return x; else y = 2.0;\n    return y;\n}\n#define G y = 1.0;\n";
        let store = |name: &str| Purpose::Store(name.to_owned());
        for (line, purpose, column, code) in [
            (2, store("y"), 5, "float y = x * 0.5;"),
            (3, Purpose::Use, 9, "float y = x * 0.5;"),
            (4, store("t"), 5, "for (float t = 0.0; t < 1.0; t += 0.1)"),
            (4, store("x"), 44, "x *= y;"),
            (4, Purpose::Use, 5, "for (float t = 0.0; t < 1.0; t += 0.1)"),
            (5, Purpose::Use, 16, "while (y < 2.0);"),
            (6, Purpose::Return, 18, "return x;"),
            (6, Purpose::Use, 5, "if (x > 1.0)"),
            (6, store("y"), 33, "y = 2.0;"),
            (7, Purpose::Return, 5, "return y;"),
            (99, Purpose::Return, 1, ""),
        ] {
            let place = Place { file: String::new(), line, purpose };
            assert_eq!(statement(text, &place), (column, code.to_owned()), "{place:?}");
        }
    }
}
