//! The values of a statement that can be traced: initializers, assignments and returned values.

use std::collections::BTreeSet;
use std::ops::Range;

use super::types::{FLOATS, OTHERS, Types};
use crate::shader::glsl::syntax::outside_brackets;
use crate::shader::glsl::{Token, assigns, is_name};

/// The target of a trace call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Traced {
    /// The value of these bytes, which become the argument of a call.
    Value(Range<usize>),
    /// The variable of this name, by a call after the statement.
    After(String),
}

/// A value that is traced, and the bytes of the code that makes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct TracedValue {
    pub traced: Traced,
    pub shown: Range<usize>,
}

fn range(tokens: &[Token<'_>]) -> Option<Range<usize>> {
    Some(tokens.first()?.bytes.start..tokens.last()?.bytes.end)
}

/// Splits at the commas that stand in no bracket.
fn parts<'a, 'b>(tokens: &'a [Token<'b>]) -> Vec<&'a [Token<'b>]> {
    let commas = outside_brackets(tokens).filter(|(_, token)| token.text == ",").map(|(at, _)| at);
    let ends: Vec<usize> = commas.chain([tokens.len()]).collect();
    let starts = std::iter::once(0).chain(ends.iter().map(|end| end + 1));
    starts.zip(&ends).map(|(start, end)| &tokens[start..*end]).collect()
}

/// Whether a value is a struct that is made in place: `NAME(...)`.
fn is_made<'a>(value: &'a [Token<'a>], types: &Types) -> Option<&'a str> {
    match value {
        [name, open, ..] if open.text == "(" && types.structs.contains(name.text) => Some(name.text),
        _ => None,
    }
}

/// Finds the traced value of `return e;`. `kind` is the type that the function returns.
pub(super) fn of_return(tokens: &[Token<'_>], kind: &str, types: &Types) -> Vec<TracedValue> {
    let [first, value @ .., _] = tokens else { return Vec::new() };
    if first.text != "return" || !(FLOATS.contains(&kind) || is_made(value, types) == Some(kind)) {
        return Vec::new();
    }
    let Some(bytes) = range(value) else { return Vec::new() };
    vec![TracedValue { traced: Traced::Value(bytes), shown: first.bytes.start..tokens[tokens.len() - 1].bytes.end }]
}

/// Finds the traced values of a declaration, an assignment or a call, with its `;`. `opaque`: variables that are structs or arrays.
pub(super) fn of_simple(
    tokens: &[Token<'_>],
    is_in_block: bool,
    types: &Types,
    opaque: &BTreeSet<String>,
) -> Vec<TracedValue> {
    const QUALIFIERS: [&str; 5] = ["const", "precise", "highp", "mediump", "lowp"];
    let [statement @ .., _] = tokens else { return Vec::new() };
    let qualifiers = statement.iter().take_while(|token| QUALIFIERS.contains(&token.text)).count();
    let is_const = statement[..qualifiers].iter().any(|token| token.text == "const");
    let rest = &statement[qualifiers..];
    let is_type = |text: &str| FLOATS.contains(&text) || OTHERS.contains(&text) || types.all.contains(text);
    let found = match rest {
        [kind, name, ..] if is_name(kind.text) && is_name(name.text) => {
            declared(kind.text, &rest[1..], is_const, is_in_block, types)
        }
        [kind, open, ..] if is_type(kind.text) && open.text == "[" => Vec::new(),
        _ => parts(rest).into_iter().filter_map(|part| assigned(part, types, opaque)).map(Traced::Value).collect(),
    };
    let Some(shown) = range(tokens) else { return Vec::new() };
    found.into_iter().map(|traced| TracedValue { traced, shown: shown.clone() }).collect()
}

fn declared(kind: &str, names: &[Token<'_>], is_const: bool, is_in_block: bool, types: &Types) -> Vec<Traced> {
    let of = |part: &[Token<'_>]| match part {
        [name, sign, value @ ..] if sign.text == "=" => {
            let is_float = FLOATS.contains(&kind);
            match is_const {
                // The initializer of a constant stays a constant expression.
                true => (is_float && is_in_block).then(|| Traced::After(name.text.to_owned())),
                false => range(value).filter(|_| is_float || is_made(value, types) == Some(kind)).map(Traced::Value),
            }
        }
        _ => None,
    };
    parts(names).into_iter().filter_map(of).collect()
}

/// The bytes of an assignment whose value is traced.
fn assigned(part: &[Token<'_>], types: &Types, opaque: &BTreeSet<String>) -> Option<Range<usize>> {
    let (at, _) = outside_brackets(part).find(|(at, _)| assigns(part, *at))?;
    let (target, value) = (&part[..at], &part[at + 1..]);
    let is_made = is_made(value, types).is_some();
    let last = target.iter().rposition(|token| is_name(token.text) || token.text == "]")?;
    let is_traced = match (target[last].text, last.checked_sub(1).map(|at| target[at].text)) {
        // A number of a vector; an element of an array may be a struct.
        ("]", _) => target.iter().find(|token| is_name(token.text)).is_none_or(|name| !opaque.contains(name.text)),
        (name, Some(".")) => !types.members.contains(name),
        (name, _) => !opaque.contains(name) && !types.globals.contains(name),
    };
    range(part).filter(|_| is_traced || is_made)
}
