//! The numbers in a line of code.

use std::ops::Range;

use crate::shader::glsl::{Line, TokenKind, lines};

/// A number in a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Literal {
    /// Its bytes in the line.
    pub bytes: Range<usize>,
    /// Its text, without a sign.
    pub text: String,
    /// Its value.
    pub value: f64,
    /// Whether it is an `int` or `uint`.
    pub is_whole: bool,
}

/// The numbers in the code of a line, from the left. Those of directives are left out, and those in the name of something.
pub fn literals(text: &str, number: u32) -> Vec<Literal> {
    let all = lines(text);
    all.get((number as usize).wrapping_sub(1)).map(of_line).unwrap_or_default()
}

/// The same of all lines.
pub fn literals_by_line(text: &str) -> Vec<Vec<Literal>> {
    lines(text).iter().map(of_line).collect()
}

fn of_line(line: &Line<'_>) -> Vec<Literal> {
    let tokens = if line.is_directive { Vec::new() } else { line.tokens() };
    // Digits behind a dot or a name are nothing that can be dragged.
    let follows = |at: usize| {
        let before = at.checked_sub(1).map(|before| &tokens[before]);
        let before = before.filter(|before| before.bytes.end == tokens[at].bytes.start);
        before.is_some_and(|before| before.kind == TokenKind::Word || before.text == ".")
    };
    let numbers = (0..tokens.len()).filter(|at| tokens[*at].kind == TokenKind::Number && !follows(*at));
    numbers.filter_map(|at| parsed(tokens[at].text, tokens[at].bytes.start)).collect()
}

fn parsed(text: &str, start: usize) -> Option<Literal> {
    let bytes = start..start + text.len();
    let lower = text.to_ascii_lowercase();
    let (value, is_whole) = if let Some(digits) = lower.strip_prefix("0x") {
        (u32::from_str_radix(digits.trim_end_matches('u'), 16).ok()? as f64, true)
    } else if lower.contains(['.', 'e']) || lower.ends_with('f') {
        (lower.trim_end_matches('f').trim_end_matches('l').parse::<f64>().ok()?, false)
    } else {
        let digits = lower.trim_end_matches('u');
        let is_octal = digits.len() > 1 && digits.starts_with('0');
        let value = if is_octal { u32::from_str_radix(digits, 8).ok()? } else { digits.parse::<u32>().ok()? };
        (f64::from(value), true)
    };
    value.is_finite().then(|| Literal { bytes, text: text.to_owned(), value, is_whole })
}

/// A number written like a literal: a float with a point and the same suffix, a whole number, which is not negative, with its `u`.
pub fn spelled_like(literal: &str, value: f64) -> String {
    let lower = literal.to_ascii_lowercase();
    let is_whole = lower.starts_with("0x") || !(lower.contains(['.', 'e']) || lower.ends_with('f'));
    if is_whole {
        let suffix = if lower.ends_with('u') { &literal[literal.len() - 1..] } else { "" };
        return format!("{}{suffix}", value.round().clamp(0.0, f64::from(u32::MAX)) as u32);
    }
    let suffix = if lower.ends_with('f') { &literal[literal.len() - 1..] } else { "" };
    let number = format!("{}{suffix}", float(value));
    // A sign may stand before it already.
    if number.starts_with('-') { format!("({number})") } else { number }
}

/// A float as GLSL writes it: the shortest decimal that is the same `f32`, with a point or an exponent.
pub(super) fn float(value: f64) -> String {
    let value = value as f32;
    let plain = value.to_string();
    if value != 0.0 && !(1e-5..1e7).contains(&value.abs()) {
        return format!("{value:e}");
    }
    if plain.contains('.') { plain } else { plain + ".0" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_line() {
        let text = "#define A 1.0\nvec3 c = vec3(1.0, .5f, 2e-3) * a1.x + 16u + 0x1F - m[2] - 1.0; // 7.0\n";
        let texts: Vec<String> = literals(text, 2).into_iter().map(|literal| literal.text).collect();
        assert_eq!(texts, ["1.0", ".5f", "2e-3", "16u", "0x1F", "2", "1.0"]);
        let values: Vec<f64> = literals(text, 2).into_iter().map(|literal| literal.value).collect();
        assert_eq!(values, [1.0, 0.5, 2e-3, 16.0, 31.0, 2.0, 1.0]);
        assert!(literals(text, 1).is_empty() && literals(text, 9).is_empty() && literals(text, 0).is_empty());
    }

    #[test]
    fn a_new_number_has_the_type_of_the_old() {
        for (old, value, new) in [
            ("1.0", 2.0, "2.0"),
            ("1.0", 0.25, "0.25"),
            (".5f", 0.75, "0.75f"),
            ("2e-3", 1e-6, "1e-6"),
            ("1.0", -0.5, "(-0.5)"),
            ("16u", 3.4, "3u"),
            ("4", 5.0, "5"),
            ("4u", -5.0, "0u"),
        ] {
            assert_eq!(spelled_like(old, value), new, "{old}");
        }
    }
}
