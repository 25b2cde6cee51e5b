//! The parts of a fragment stage that a stage made of it replaces: what runs, and what it writes.

use std::ops::Range;

use super::token::{Token, code};

/// The bytes of the name of the function `main` that a stage defines.
pub fn main_of(tokens: &[Token<'_>]) -> Option<Range<usize>> {
    let pair = tokens.windows(2).find(|pair| pair[0].text == "main" && pair[1].text == "(")?;
    Some(pair[0].bytes.clone())
}

/// The outputs that a text declares, `out TYPE NAME;`: the places of these four tokens.
pub fn outputs<'a>(tokens: &'a [Token<'_>]) -> impl Iterator<Item = usize> + 'a {
    (0..tokens.len().saturating_sub(3)).filter(|at| tokens[*at].text == "out" && tokens[at + 3].text == ";")
}

/// The name of the color that a text declares: the output at location 0, or the first.
pub fn color_of(text: &str) -> Option<String> {
    let tokens = code(text);
    let colors: Vec<usize> = outputs(&tokens).filter(|at| tokens[at + 1].text == "vec4").collect();
    let is_first = |at: &&usize| **at >= 2 && tokens[**at - 2].text == "0";
    let at = colors.iter().find(is_first).or(colors.first())?;
    Some(tokens[at + 2].text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_color_is_the_output_at_location_0_or_the_first() {
        let text = "layout(location = 1) out vec4 more;\nlayout(location = 0) out vec4 shown;\nvoid main() {}\n";
        assert_eq!((color_of(text).as_deref(), main_of(&code(text)).unwrap().start), (Some("shown"), 78));
        assert_eq!(color_of("out float depth; out vec4 color;").as_deref(), Some("color"));
        assert_eq!((color_of("out vec3 color;"), main_of(&code("void f() {}"))), (None, None));
    }
}
