//! Parses the range, choices and default of a `//@ui`, and checks that its type can hold them.

use std::ops::Range;

use super::ParameterType;
use super::cursor::Cursor;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::spirv::reflect::Scalar;

/// A scalar type's name in GLSL, and its smallest and largest value.
pub fn limits(scalar: Scalar) -> (&'static str, f64, f64) {
    match scalar {
        Scalar::Bool => ("bool", 0.0, 1.0),
        Scalar::Int => ("int", f64::from(i32::MIN), f64::from(i32::MAX)),
        Scalar::Uint => ("uint", 0.0, f64::from(u32::MAX)),
        Scalar::Float => ("float", f64::from(f32::MIN), f64::from(f32::MAX)),
    }
}

/// Reports an error under `bytes` if the type cannot hold `value`.
fn check(cursor: &Cursor<'_>, bytes: &Range<usize>, scalar: Scalar, value: f64) -> Result<(), Box<Diagnostic>> {
    let (name, least, most) = limits(scalar);
    if (least..=most).contains(&value) {
        return Ok(());
    }
    let (least, most) = match scalar {
        Scalar::Float => (format!("{least:e}"), format!("{most:e}")),
        _ => (least.to_string(), most.to_string()),
    };
    let message = format!("expected a value of the type {name}, {least} to {most}, found {value}");
    Err(cursor.error(bytes.clone(), message))
}

/// The numbers after `=`, one per component, with their byte range.
pub fn default(cursor: &mut Cursor<'_>, kind: ParameterType) -> Result<(Range<usize>, Vec<f64>), Box<Diagnostic>> {
    let start = cursor.position();
    let mut out = Vec::new();
    while !cursor.at_end() {
        let (bytes, word) = cursor.word();
        let value = match word {
            "true" => Some(1.0),
            "false" => Some(0.0),
            word => number(word),
        };
        let Some(value) = value else {
            return Err(cursor.error(bytes, format!("expected a number, since the default comes last, found `{word}`")));
        };
        check(cursor, &bytes, kind.scalar(), value)?;
        out.push(value);
    }
    let bytes = start..cursor.position();
    if out.len() != kind.components() {
        let message = format!("expected {} number(s) after `=`, found {}", kind.components(), out.len());
        return Err(cursor.error(bytes, message));
    }
    if kind.scalar() != Scalar::Float && out.iter().any(|value| value.fract() != 0.0) {
        return Err(cursor.error(bytes, "expected a whole number after `=`"));
    }
    Ok((bytes, out))
}

/// The keys of guaranteed properties.
const CLAIMS: [&str; 2] = ["conserves=", "reciprocal="];

/// The next guaranteed property, without its `=`.
pub fn claim(cursor: &mut Cursor<'_>) -> Option<&'static str> {
    CLAIMS.into_iter().find(|claim| cursor.peek_text(claim)).map(|claim| claim.trim_end_matches('='))
}

/// Parses `"A B"` after `conserves=` or `reciprocal=`. The names must be among `choices`.
pub fn claimed(cursor: &mut Cursor<'_>, choices: &[(String, i64)]) -> Result<Vec<String>, Box<Diagnostic>> {
    let (_, key) = cursor.key();
    let (bytes, value) = cursor.value(key)?;
    let names: Vec<String> = value.split_whitespace().map(str::to_owned).collect();
    match names.iter().find(|name| !choices.iter().any(|(choice, _)| choice == *name)) {
        Some(unknown) => {
            let message = format!("expected names of the choices before `{key}=`, found `{unknown}`");
            Err(cursor.error(bytes, message))
        }
        None => Ok(names),
    }
}

/// The option before the cursor if its value is free text: `group`, `doc` or `unit`.
pub fn text_key(cursor: &mut Cursor<'_>) -> Option<&'static str> {
    ["group=", "doc=", "unit="].into_iter().find(|key| cursor.peek_text(key)).map(|key| key.trim_end_matches('='))
}

/// Names and values of choices, and the description of each, which may be empty.
pub type Choices = (Vec<(String, i64)>, Vec<String>);

/// Parses `A=0 B=1 "What B does"` and so on, with values of the type.
pub fn choices(cursor: &mut Cursor<'_>, scalar: Scalar) -> Result<Choices, Box<Diagnostic>> {
    let (mut out, mut docs): Choices = (Vec::new(), Vec::new());
    while !cursor.at_end() && !cursor.peek('=') && claim(cursor).or_else(|| text_key(cursor)).is_none() {
        let (bytes, word) = cursor.word();
        let choice = word.split_once('=').and_then(|(name, value)| Some((name, value.parse::<i64>().ok()?)));
        let Some((name, value)) = choice.filter(|(name, _)| !name.is_empty()) else {
            return Err(cursor.error(bytes, format!("expected NAME=NUMBER after `choice`, found `{word}`")));
        };
        if out.iter().any(|(known, number)| known == name || *number == value) {
            return Err(cursor.error(bytes, format!("choice `{word}` repeats a name or a number")));
        }
        // All values of the type are exact in f64, and rounding never moves another value into its range.
        check(cursor, &bytes, scalar, value as f64)?;
        out.push((name.to_owned(), value));
        docs.push(cursor.string()?.unwrap_or_default());
    }
    if out.is_empty() { Err(cursor.expected("NAME=NUMBER after `choice`")) } else { Ok((out, docs)) }
}

/// Parses `lo..hi` in `word`. The type must be able to hold both ends.
pub fn range(
    cursor: &Cursor<'_>,
    bytes: Range<usize>,
    word: &str,
    scalar: Scalar,
) -> Result<(f64, f64), Box<Diagnostic>> {
    let ends = word.split_once("..").and_then(|(lo, hi)| Some((number(lo)?, number(hi)?)));
    match ends {
        Some((lo, hi)) if lo < hi => {
            check(cursor, &bytes, scalar, lo)?;
            check(cursor, &bytes, scalar, hi)?;
            Ok((lo, hi))
        }
        _ => Err(cursor.error(bytes, format!("expected a range lo..hi with lo < hi, found `{word}`"))),
    }
}

fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.is_finite())
}
