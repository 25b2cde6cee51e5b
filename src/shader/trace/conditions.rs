//! The lines of conditions that are constant: the compiler gives them none, but the first line of the branch behind them.

use std::ops::RangeInclusive;

use crate::shader::glsl::Code;
use crate::shader::glsl::syntax::{Function, Statement, StatementKind};

/// The first line of the `if`, `switch` or loop whose first branch begins with code at a line. Between both, this many other conditions are
/// constant.
pub(super) fn line_of_condition(functions: &[Function], code: &Code<'_>, line: u32, between: usize) -> Option<u32> {
    let mut around = Around { exact: Vec::new(), innermost: None };
    let body = functions.iter().map(|function| &function.body).find(|body| lines(body, code).contains(&line))?;
    around.search(body, code, line);
    let exact = around.exact.len().checked_sub(1 + between).map(|at| around.exact[at]);
    let statement = exact.or(around.innermost)?;
    Some(*lines(statement, code).start())
}

/// The statements with a condition around a line.
struct Around<'a> {
    /// Those with a part that begins there, the innermost last.
    exact: Vec<&'a Statement>,
    innermost: Option<&'a Statement>,
}

impl<'a> Around<'a> {
    fn search(&mut self, statement: &'a Statement, code: &Code<'_>, line: u32) {
        for part in statement.parts.iter().filter(|part| lines(part, code).contains(&line)) {
            if has_condition(statement) {
                self.innermost = Some(statement);
                if begins_at(part, code, line) {
                    self.exact.push(statement);
                }
            }
            self.search(part, code, line);
        }
    }
}

fn has_condition(statement: &Statement) -> bool {
    matches!(statement.kind, StatementKind::Branch | StatementKind::Loop | StatementKind::DoLoop)
}

/// Whether the code of a statement may begin at a line: with a header, or with its first part.
fn begins_at(statement: &Statement, code: &Code<'_>, line: u32) -> bool {
    match statement.kind {
        StatementKind::Simple | StatementKind::Jump => true,
        StatementKind::Block => {
            let first = statement.parts.first().filter(|first| lines(first, code).contains(&line));
            first.is_some_and(|first| begins_at(first, code, line))
        }
        StatementKind::Branch | StatementKind::Loop | StatementKind::DoLoop => {
            let header = code.number_at(statement.bytes.start)..=code.number_at(statement.header.end);
            let first = statement.parts.first().filter(|first| lines(first, code).contains(&line));
            header.contains(&line) || first.is_some_and(|first| begins_at(first, code, line))
        }
    }
}

fn lines(statement: &Statement, code: &Code<'_>) -> RangeInclusive<u32> {
    code.number_at(statement.bytes.start)..=code.number_at(statement.bytes.end.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::glsl::syntax::functions;

    #[test]
    fn a_constant_condition_stands_before_its_branch() {
        let text = "float f(float x) {\n    if (ON)\n        x += 1.0;\n    if (ON) {\n        float a;\n        if (x > 1.0)\n            \
            a = x;\n        x = a;\n    } else if (OFF)\n        x = 2.0;\n    if (ON)\n        if (OFF)\n            x = 3.0;\n    \
            while (ON) {\n        x += 1.0;\n    }\n    switch (KIND) {\n    case 1:\n        x = 7.0;\n        break;\n    }\n    return x;\n}\n";
        let code = Code::new(text);
        let functions = functions(&code.tokens);
        let of = |line: u32, between: usize| line_of_condition(&functions, &code, line, between);
        for (line, between, expected) in [
            (3, 0, Some(2)),
            (6, 0, Some(4)),
            (10, 0, Some(9)),
            (13, 0, Some(12)),
            (13, 1, Some(11)),
            (15, 0, Some(14)),
            (19, 0, Some(17)),
            (22, 0, None),
            (99, 0, None),
        ] {
            assert_eq!(of(line, between), expected, "{line}");
        }
    }
}
