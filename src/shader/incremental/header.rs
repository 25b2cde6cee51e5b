//! The header of a function definition.

use crate::shader::glsl::{Token, TokenKind};

/// Return type, name and parameters of a function.
pub struct Header {
    /// The return type in GLSL.
    pub returns: String,
    pub name: String,
    /// `None` if a parameter has a form that [`Parameter::parse`] does not know.
    pub parameters: Option<Vec<Parameter>>,
}

/// The type of a parameter.
#[derive(Debug)]
pub struct Parameter {
    /// The type's name, with the array sizes behind it.
    kind: String,
    /// The array sizes behind the parameter's name.
    sizes: String,
}

impl Parameter {
    /// The declaration of a variable of this type, without a semicolon.
    pub fn declaration(&self, name: &str) -> String {
        format!("{} {name}{}", self.kind, self.sizes)
    }

    /// Parses a parameter such as `const in float x[3]`.
    fn parse(tokens: &[Token<'_>]) -> Option<Self> {
        const QUALIFIERS: [&str; 8] = ["const", "in", "out", "inout", "highp", "mediump", "lowp", "restrict"];
        // A local variable cannot have these types.
        const OPAQUE: [&str; 6] = ["sampler", "image", "texture", "subpass", "acceleration", "rayQuery"];
        let first = tokens.iter().position(|token| !QUALIFIERS.contains(&token.text))?;
        let (kind, rest) = tokens[first..].split_first()?;
        let is_opaque = OPAQUE.iter().any(|word| kind.text.trim_start_matches(['i', 'u']).starts_with(word));
        let is_sizes = |tokens: &[Token<'_>]| {
            let ends = tokens.first().is_none_or(|t| t.text == "[") && tokens.last().is_none_or(|t| t.text == "]");
            ends && tokens.iter().all(is_of_type)
        };
        // The first word outside of brackets is the name, which may be missing.
        let mut depth = 0_i32;
        let is_name = |token: &Token<'_>| {
            depth += i32::from(token.text == "[") - i32::from(token.text == "]");
            depth == 0 && token.kind == TokenKind::Word
        };
        let (before, after) = match rest.iter().position(is_name) {
            Some(at) => (&rest[..at], &rest[at + 1..]),
            None => (rest, &[][..]),
        };
        let is_known = kind.kind == TokenKind::Word && !is_opaque && is_sizes(before) && is_sizes(after);
        let text = |tokens: &[Token<'_>]| tokens.iter().map(|token| token.text).collect::<String>();
        is_known.then(|| Self { kind: format!("{}{}", kind.text, text(before)), sizes: text(after) })
    }
}

/// Whether a token can be part of a type: of its name, or of the sizes of an array.
fn is_of_type(token: &Token<'_>) -> bool {
    matches!(token.kind, TokenKind::Word | TokenKind::Number) || matches!(token.text, "[" | "]")
}

impl Header {
    /// Parses `TYPE NAME(PARAMETERS)`. `None` if the tokens are anything else, such as a macro with arguments.
    pub fn parse(tokens: &[Token<'_>]) -> Option<Self> {
        let open = tokens.iter().position(|token| token.text == "(")?;
        let (name, returns) = tokens[..open].split_last()?;
        let is_name =
            name.kind == TokenKind::Word && returns.first().is_some_and(|token| token.kind == TokenKind::Word);
        let (close, parameters) = tokens[open + 1..].split_last()?;
        let is_list = close.text == ")" && !parameters.iter().any(|token| matches!(token.text, "(" | ")" | "="));
        if !is_name || !is_list || !returns.iter().all(is_of_type) {
            return None;
        }
        let parameters = match parameters {
            [] => Some(Vec::new()),
            [only] if only.text == "void" => Some(Vec::new()),
            list => list.split(|token| token.text == ",").map(Parameter::parse).collect(),
        };
        let returns: Vec<&str> = returns.iter().map(|token| token.text).collect();
        Some(Self { returns: returns.join(" "), name: name.text.to_owned(), parameters })
    }
}
