//! Where the call that watches an expression goes: after, before or into the statement that holds it.

use std::ops::Range;

use crate::shader::glsl::syntax::{Statement, StatementKind, functions, within};
use crate::shader::glsl::{Code, Token, find_word, is_name, is_word, spelled};

/// The texts to insert into a file, with their byte offsets, in order.
pub type Insertions = Vec<(usize, String)>;

/// Where an expression is evaluated.
#[derive(Debug, PartialEq)]
pub enum Placed {
    /// In a function of the file, by these insertions. `watched` is the expression: another than the given one for `return`.
    Inside(Insertions),
    /// Outside of every function: once all of the picture is shaded.
    Outside,
}

/// Makes the insertions that watch `expression` on the line `number`. `column` counts bytes of the line, from 0; without it, the
/// first occurrence on the line counts. `call` writes the call of an expression.
///
/// # Errors
/// A message if nothing can be watched there.
pub fn place(
    code: &Code<'_>,
    number: u32,
    column: Option<usize>,
    expression: &str,
    call: impl Fn(&str) -> String,
) -> Result<Placed, String> {
    let Some(line) = code.line(number) else { return Err(format!("the file has no line {number}")) };
    if line.is_directive {
        return Err("this line is a preprocessor directive, in which nothing is evaluated".to_owned());
    }
    let tokens = &code.tokens;
    let start = code.start(number);
    let found = occurrence(&line.code, expression, column);
    let at = found.clone().map(|bytes| bytes.start).or(column).map(|byte| byte + start);
    // On an empty line, the statement that follows it.
    let at = at.or_else(|| tokens.iter().find(|token| token.bytes.start >= start).map(|token| token.bytes.start));
    let functions = functions(tokens);
    let at = at.unwrap_or(start);
    let no_return = || "there is no `return` on this line".to_owned();
    let in_head = |range: &Range<usize>| range.contains(&at);
    for function in &functions {
        if in_head(&function.head) {
            if expression == "return" {
                return Err(no_return());
            }
            return Ok(Placed::Inside(vec![(function.body.bytes.start + 1, format!(" {}", call(expression)))]));
        }
        if function.body.bytes.contains(&at) {
            let statement = innermost(&function.body, at);
            let expression = match (expression, statement.kind) {
                ("return", StatementKind::Jump) => returned(statement, tokens)?,
                ("return", _) => return Err(no_return()),
                _ => expression.to_owned(),
            };
            return Ok(Placed::Inside(insert(statement, at, tokens, &expression, &call(&expression))));
        }
    }
    match tokens.iter().any(|token| token.bytes.start >= start) || found.is_some() {
        true if expression == "return" => Err(no_return()),
        true => Ok(Placed::Outside),
        false => Err("there is no code on this line".to_owned()),
    }
}

/// The bytes of an expression on a line: at the column or the first ones.
pub fn occurrence(code: &str, expression: &str, column: Option<usize>) -> Option<Range<usize>> {
    match column {
        Some(column) => {
            let at = |start: usize| find_word(code.get(start..)?, expression).map(|r| r.start + start..r.end + start);
            // The caret may stand anywhere in the expression.
            let first = (column + 1).saturating_sub(expression.len());
            (first..=column).filter(|start| code.is_char_boundary(*start)).find_map(at).filter(|r| r.start <= column)
        }
        None => find_word(code, expression),
    }
}

fn innermost(statement: &Statement, at: usize) -> &Statement {
    statement.parts.iter().find(|part| part.bytes.contains(&at)).map_or(statement, |part| innermost(part, at))
}

/// The expression of `return e;`.
fn returned(statement: &Statement, tokens: &[Token<'_>]) -> Result<String, String> {
    match within(tokens, &statement.bytes) {
        [first, middle @ .., _] if first.text == "return" && !middle.is_empty() => Ok(spelled(middle)),
        _ => Err("the statement on this line returns nothing".to_owned()),
    }
}

fn insert(statement: &Statement, at: usize, tokens: &[Token<'_>], expression: &str, call: &str) -> Insertions {
    let Range { start, end } = statement.bytes;
    let before = |call: &str| match statement.is_in_block {
        true => vec![(start, format!("{call} "))],
        false => vec![(start, format!("{{ {call} ")), (end, " }".to_owned())],
    };
    let into = |body: &Statement| match body.kind {
        StatementKind::Block => vec![(body.bytes.start + 1, format!(" {call}"))],
        _ => vec![(body.bytes.start, format!("{{ {call} ")), (body.bytes.end, " }".to_owned())],
    };
    match statement.kind {
        StatementKind::Simple if is_after(statement, tokens, expression) => match statement.is_in_block {
            true => vec![(end, format!(" {call}"))],
            false => vec![(start, "{ ".to_owned()), (end, format!(" {call} }}"))],
        },
        // The condition of an `if` is evaluated whether it holds or not.
        StatementKind::Simple | StatementKind::Jump | StatementKind::Branch => before(call),
        // A variable of the header is declared only inside.
        StatementKind::Loop => statement.parts.first().map(into).unwrap_or_default(),
        StatementKind::DoLoop => match statement.parts.first() {
            Some(body) if body.kind == StatementKind::Block => vec![(body.bytes.end - 1, format!("{call} "))],
            Some(body) => {
                vec![(body.bytes.start, "{ ".to_owned()), (body.bytes.end, format!(" {call} }}"))]
            }
            None => Vec::new(),
        },
        StatementKind::Block if at == start => vec![(start + 1, format!(" {call}"))],
        StatementKind::Block => vec![(end - 1, format!("{call} "))],
    }
}

/// Whether to evaluate after the statement: a name has its new value then. Another expression is evaluated before, as in the
/// statement itself, unless it uses what the statement declares.
fn is_after(statement: &Statement, tokens: &[Token<'_>], expression: &str) -> bool {
    if expression.chars().all(|c| is_word(c) || matches!(c, '.' | '[' | ']' | ' ')) {
        return true;
    }
    let inside = within(tokens, &statement.bytes);
    // `TYPE NAME`: two words in a row.
    let is_declaration = inside.windows(2).any(|pair| is_name(pair[0].text) && is_name(pair[1].text));
    let declared = inside.windows(2).filter(|pair| is_name(pair[0].text) && matches!(pair[1].text, "=" | ";" | ","));
    is_declaration && declared.into_iter().any(|pair| find_word(expression, pair[0].text).is_some())
}

/// A text with insertions.
pub fn inserted(text: &str, insertions: &Insertions) -> String {
    let mut sorted: Vec<_> = insertions.iter().collect();
    sorted.sort_by_key(|(at, _)| *at);
    let mut out = text.to_owned();
    for (at, insertion) in sorted.into_iter().rev() {
        out.insert_str(*at, insertion);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watched(text: &str, line: u32, column: Option<usize>, expression: &str) -> String {
        match place(&Code::new(text), line, column, expression, |e| format!("W({e});")) {
            Ok(Placed::Inside(insertions)) => inserted(text, &insertions),
            Ok(Placed::Outside) => "outside".to_owned(),
            Err(message) => message,
        }
    }

    #[test]
    fn calls_stand_on_the_line_of_their_statement() {
        for (body, expression, expected) in [
            ("float a = x * x;", "a", "float a = x * x; W(a);"),
            ("float a = x * x, b = a * 2.0;", "a * 2.0", "float a = x * x, b = a * 2.0; W(a * 2.0);"),
            ("x = x * x;", "x * x", "W(x * x); x = x * x;"),
            ("x = x * x;", "x", "x = x * x; W(x);"),
            ("return x * x; // x", "x", "W(x); return x * x; // x"),
            ("return x * x;", "return", "W(x * x); return x * x;"),
            ("if (x > 1.0) x = 1.0;", "x > 1.0", "W(x > 1.0); if (x > 1.0) x = 1.0;"),
            ("if (x > 1.0) y = 1.0;", "y", "if (x > 1.0) { y = 1.0; W(y); }"),
            ("if (x > 1.0) y = 1.0; else z();", "z()", "if (x > 1.0) y = 1.0; else { W(z()); z(); }"),
            ("for (int i = 0; i < 4; ++i) { x += 1.0; }", "i", "for (int i = 0; i < 4; ++i) { W(i); x += 1.0; }"),
            ("for (int i = 0; i < 4; ++i) x += 1.0;", "i", "for (int i = 0; i < 4; ++i) { W(i); x += 1.0; }"),
            ("for (int i = 0; i < 4; ++i) x += 1.0;", "x", "for (int i = 0; i < 4; ++i) { x += 1.0; W(x); }"),
            ("do { x += 1.0; } while (x < y);", "y", "do { x += 1.0; W(y); } while (x < y);"),
            // An expression that does not occur on the line belongs to its first statement.
            ("[[unroll]] for (;;) discard;", "z", "[[unroll]] for (;;) { W(z); discard; }"),
            ("switch (k) { case 1: y = 2.0; }", "y", "switch (k) { case 1: y = 2.0; W(y); }"),
            ("a = z.xy[i];", "z.xy[i]", "a = z.xy[i]; W(z.xy[i]);"),
        ] {
            let text = format!("float f(float q) {{\n    {body}\n}}\n");
            let expected = format!("float f(float q) {{\n    {expected}\n}}\n");
            assert_eq!(watched(&text, 2, None, expression), expected, "{body}: {expression}");
        }
    }

    #[test]
    fn heads_other_lines_and_columns() {
        let text = "const float C = 1.0;\n#define D 1\nfloat f(float q) {\n\n    float a = b\n        + q;\n    x = q; y = q;\n}\n";
        assert!(watched(text, 3, None, "q").contains("f(float q) { W(q);\n"));
        assert!(watched(text, 4, None, "q").contains("+ q; W(q);\n"));
        assert!(watched(text, 6, None, "a").contains("+ q; W(a);\n"));
        assert!(watched(text, 7, Some(15), "q").contains("x = q; y = q; W(q);\n"));
        assert!(watched(text, 8, None, "x").contains("y = q;\nW(x); }\n"));
        assert_eq!(watched(text, 1, None, "C"), "outside");
        assert!(watched(text, 2, None, "D").contains("directive"));
        assert!(watched(text, 99, None, "D").contains("no line 99"));
        assert!(watched(text, 7, None, "return").contains("no `return`"));
    }
}
