//! The parts of a fragment stage that a stage made of it replaces: what runs, what it writes, and its first include.

use std::ops::Range;

use super::include::{Include, includes};
use super::syntax::functions;
use super::token::{Token, code};

/// The parts.
#[derive(Debug)]
pub struct StageMain<'a> {
    /// The bytes of the name `main`.
    pub main: Range<usize>,
    /// The name of the color that the stage writes.
    pub color: &'a str,
    /// The first include.
    pub include: Include<'a>,
}

impl<'a> StageMain<'a> {
    /// Finds the parts in a text.
    ///
    /// # Errors
    /// The part that the text lacks: the end of a message that begins with the file.
    pub fn of(text: &'a str) -> Result<Self, &'static str> {
        let tokens = code(text);
        let functions = functions(&tokens);
        let is_outside = |token: &Token<'_>| !functions.iter().any(|of| of.body.bytes.contains(&token.bytes.start));
        let find = |words: [&str; 2]| {
            let is_pair = |at: &usize| [&tokens[*at], &tokens[at + 1]].map(|token| token.text) == words;
            (0..tokens.len().saturating_sub(2)).find(|at| is_pair(at) && is_outside(&tokens[*at]))
        };
        let main = find(["main", "("]).ok_or("has no main()")?;
        let color = find(["out", "vec4"]).ok_or("has no `out vec4` color")?;
        let include = includes(text).next().ok_or("includes no file")?;
        Ok(Self { main: tokens[main].bytes.clone(), color: tokens[color + 2].text, include })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_are_outside_of_functions() {
        let text = "#include \"a.glsl\"\n#include \"b.glsl\"\nvoid f() { main(); }\nout vec4 shown;\nvoid main() {}\n";
        let entry = StageMain::of(text).unwrap();
        assert_eq!((entry.main.start, entry.color, entry.include.name), (78, "shown", "a.glsl"));
        assert_eq!(StageMain::of("void f() { main(); }").unwrap_err(), "has no main()");
        assert_eq!(StageMain::of("void main() { }").unwrap_err(), "has no `out vec4` color");
        assert_eq!(StageMain::of("out vec4 c; void main() { }").unwrap_err(), "includes no file");
    }
}
