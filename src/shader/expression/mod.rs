//! Watches an expression of the shaders: shows its value over the model as a debug mode, without a change of the source.
//!
//! The library compiles one more stage, [`STAGE`], while an expression is watched. Its text is that of the first stage that includes
//! the file of the expression (`host.rs`: the picture's, or that of a pass), with another `main` around it; and in that file, a call
//! of `watch_value` stands on the line of the statement. Only this stage sees these texts ([`Overlay`]): the stages of the tree are
//! not compiled again.
//!
//! Every line of the stage's text stays in its place: `main` becomes `watched_main`, the first include is a library
//! with `watch_value` for each type, and a new `main` calls the old one and writes the value that was kept. `place.rs`
//! inserts `watch_value(EXPR);` on the line of the statement, which `syntax.rs` finds without a preprocessor.
//! `library/watched.rs` follows the line over edits by the unchanged lines above and below it. The copy of the model's stage draws
//! the model; that of another pass draws an image of its own, just before that pass (`//@pass ... watches=NAME`), which the mode
//! shows. In a vertex stage, a copy of that beside the copy of the fragment stage hands the value over, and pixels show it between those
//! of their vertices. While an expression does not compile there is no such mode, and the final picture is shown in its place: the error belongs
//! to the expression ([`Watching`]) and is no error of the tree. The stage is not part of `debug.frag`, because a wrong expression
//! must not disable a hundred modes. A loop without end in this stage has no line in its message.

mod follow;
mod host;
mod overlay;
pub(in crate::shader) mod place;
mod scope;
mod stage;

use std::fmt;

use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{assigns, code};

pub use follow::{follow, lines_before};
pub use host::{can_show, hosts};
pub use overlay::{Overlay, is_virtual, is_watched};
pub use scope::{Structs, Variable, members, variables};
pub use stage::{MODE, MODE_ID, STAGE, VERTEX, components_of};

/// An expression and the place where it is watched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expression {
    /// The file as the user gave it: a path in the tree, on disk, or the end of one.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// From 1, in bytes; without it, the first occurrence on the line counts.
    pub column: Option<u32>,
    /// GLSL of a value, or `return` for what the statement returns.
    pub text: String,
    /// Which evaluation counts in a fragment, from 1; 0 is the last.
    pub evaluation: u32,
}

/// The watched expression of a set of shaders.
#[derive(Clone, Debug, PartialEq)]
pub struct Watching {
    /// The expression as the user gave it.
    pub expression: Expression,
    /// Its line now, after edits above it.
    pub line: u32,
    /// Why it has no mode.
    pub error: Option<Diagnostic>,
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:", self.file, self.line)?;
        if let Some(column) = self.column {
            write!(f, "{column}:")?;
        }
        f.write_str(&self.text)
    }
}

impl Expression {
    /// Parses `FILE:LINE:EXPRESSION` or `FILE:LINE:COLUMN:EXPRESSION`; spaces may stand for the first two colons.
    ///
    /// # Errors
    /// A message with what was expected.
    pub fn parse(text: &str, evaluation: u32) -> Result<Self, String> {
        let wrong = |what: &str| format!("`{text}`: {what}; expected FILE:LINE:NAME, as brdf/ndf.glsl:20:a2");
        let separators = [':', ' '];
        let (file, rest) = text.trim().split_once(separators).ok_or_else(|| wrong("there is no line"))?;
        let (line, rest) = rest.trim_start().split_once(separators).ok_or_else(|| wrong("there is no expression"))?;
        let line = line.parse().ok().filter(|line| *line > 0);
        let line = line.ok_or_else(|| wrong("the line is no number from 1"))?;
        let column = rest.trim_start().split_once(':').and_then(|(column, rest)| Some((column.parse().ok()?, rest)));
        let (column, expression) = column.map_or((None, rest), |(column, rest)| (Some(column), rest));
        let expression = expression.trim().to_owned();
        if file.is_empty() {
            return Err(wrong("there is no file"));
        }
        check(&expression).map_err(|what| wrong(&what))?;
        Ok(Self { file: file.to_owned(), line, column, text: expression, evaluation })
    }
}

/// The file and line at the start of a text that may go on with an expression.
pub fn place_of(text: &str) -> Option<(&str, u32)> {
    let (file, rest) = text.trim().split_once([':', ' '])?;
    let rest = rest.trim_start();
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let line = rest[..digits].parse().ok().filter(|line| *line > 0)?;
    (!file.is_empty()).then_some((file, line))
}

/// The longest expression, in bytes.
const LONGEST: usize = 500;

/// Checks that a text can be one expression that changes nothing.
fn check(expression: &str) -> Result<(), String> {
    if expression.is_empty() {
        return Err("there is no expression".to_owned());
    }
    if expression.len() > LONGEST {
        return Err(format!("the expression is longer than {LONGEST} characters"));
    }
    if expression.contains("//") || expression.contains("/*") {
        return Err("an expression holds no comment".to_owned());
    }
    let wrong =
        |c: &char| matches!(c, ';' | '{' | '}' | '#' | '\\' | '"' | '\'' | '`') || c.is_control() || !c.is_ascii();
    if let Some(c) = expression.chars().find(wrong) {
        return Err(format!("an expression holds no `{}`", c.escape_debug()));
    }
    let tokens = code(expression);
    let mut depth = 0_i32;
    for (at, token) in tokens.iter().enumerate() {
        let text = token.text;
        depth += i32::from(matches!(text, "(" | "[")) - i32::from(matches!(text, ")" | "]"));
        let next = tokens.get(at + 1).filter(|next| next.bytes.start == token.bytes.end).map(|next| next.text);
        let counts = matches!(text, "+" | "-") && next == Some(text);
        if assigns(&tokens, at) || counts {
            return Err("the expression changes a variable, so it would change the picture".to_owned());
        }
        if depth < 0 {
            break;
        }
    }
    if depth != 0 {
        return Err("the parentheses of the expression do not match".to_owned());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_parsed() {
        let parse = |text| Expression::parse(text, 0).map(|e| (e.to_string(), e.column, e.text));
        let plain = ("brdf/ndf.glsl:20:a2".to_owned(), None, "a2".to_owned());
        assert_eq!(parse("brdf/ndf.glsl:20:a2"), Ok(plain.clone()));
        assert_eq!(parse(" brdf/ndf.glsl 20 a2 "), Ok(plain));
        assert_eq!(parse("a.glsl:3:9:x == 1 ? y : z").unwrap().1, Some(9));
        assert_eq!(parse("a.glsl:3:x <= 1.0 ? y : z").unwrap().2, "x <= 1.0 ? y : z");
        for (wrong, words) in [
            ("a.glsl", "no line"),
            ("a.glsl:0:x", "from 1"),
            ("a.glsl:x:y", "from 1"),
            ("a.glsl:1", "no expression"),
            ("a.glsl:1:", "no expression"),
            ("a.glsl:1:x = 2.0", "changes a variable"),
            ("a.glsl:1:x++", "changes a variable"),
            ("a.glsl:1:x += 1", "changes a variable"),
            ("a.glsl:1:x <<= 1", "changes a variable"),
            ("a.glsl:1:x >>= 1", "changes a variable"),
            ("a.glsl:1:f(x", "parentheses"),
            ("a.glsl:1:x); discard; (y", "no `;`"),
            ("a.glsl:1:x // y", "comment"),
        ] {
            let error = parse(wrong).unwrap_err();
            assert!(error.contains(words), "{wrong}: {error}");
        }
    }
}
