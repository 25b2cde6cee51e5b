//! The text of an opened file with words that WebGL has as names, macros that stand for `uniform`, and arrays of samplers replaced by what
//! the rest of this module knows. Each line keeps its number, and all but those with such a macro their columns.

use std::ops::Range;

use super::initial::{Edit, apply, blank};
use crate::shader::glsl::syntax::closing;
use crate::shader::glsl::{Token, TokenKind, find_word, tokens};

/// Names that toy.glsl declares for itself.
const OURS: [&str; 9] =
    ["toy", "Pass", "toy_begin", "toy_end", "toy_variables", "toy_uv", "toy_color", "toyFragCoord", "toyFragColor"];
/// Types, words and functions of later GLSL that may be names of variables in GLSL ES 1.00.
const LATER: [&str; 7] = ["uint", "uvec2", "uvec3", "uvec4", "case", "layout", "texture"];

/// A text in which no name is one of toy.glsl's, and no variable a word of GLSL 4.60.
pub(super) fn plain(text: &str) -> String {
    let all: Vec<Token<'_>> = tokens(text).filter(|token| token.kind != TokenKind::Comment).collect();
    let mut edits = with_uniforms(&all);
    edits.extend(single_samplers(text, &all));
    let later: Vec<&str> = LATER.into_iter().filter(|name| is_declared(&all, name)).collect();
    let is_name = |token: &&Token<'_>| OURS.contains(&token.text) || later.contains(&token.text);
    edits.extend(all.iter().filter(is_name).map(|token| (token.bytes.clone(), renamed(token.text))));
    if edits.is_empty() { text.to_owned() } else { apply(text, edits) }
}

/// A message with the names that the author has written.
pub(super) fn with_plain_names(message: &str) -> String {
    let names = OURS.iter().chain(&LATER);
    names.fold(message.to_owned(), |message, name| with_word(&message, &renamed(name), name))
}

/// A text with another word in place of one. A longer word that begins with it stays.
pub(super) fn with_word(text: &str, word: &str, by: &str) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some(bytes) = find_word(rest, word) {
        out += &rest[..bytes.start];
        out += by;
        rest = &rest[bytes.end..];
    }
    out + rest
}

/// Another name of the same length.
pub(super) fn renamed(name: &str) -> String {
    format!("{}_", &name[..name.len() - 1])
}

/// Whether a text declares a variable of this name: a type or another name stands before it, and none behind it.
fn is_declared(all: &[Token<'_>], name: &str) -> bool {
    let ends = |token: &Token<'_>| matches!(token.text, ";" | "=" | "," | ")" | "[");
    let is_type = |text: &str| !matches!(text, "return" | "switch" | "else");
    let leads = |token: &Token<'_>| token.kind == TokenKind::Word && is_type(token.text) || token.text == ",";
    all.windows(3).any(|three| three[1].text == name && leads(&three[0]) && ends(&three[2]))
}

/// Blanks in place of the brackets of sampler arrays. Nothing gives their elements different images, so one sampler stands for all.
fn single_samplers(text: &str, all: &[Token<'_>]) -> Vec<Edit> {
    let is = |at: usize, sign: &str| all.get(at).is_some_and(|token| token.text == sign);
    let is_name = |at: usize| all.get(at).is_some_and(|token| token.kind == TokenKind::Word);
    let brackets = |open: usize| Some(all[open].bytes.start..all[closing(all, open)?].bytes.end);
    let (mut names, mut edits) = (Vec::new(), Vec::new());
    for at in (0..all.len()).filter(|at| all[*at].text.contains("sampler") && all[*at].kind == TokenKind::Word) {
        if is(at + 1, "[") {
            let Some(close) = closing(all, at + 1).filter(|close| is_name(close + 1)) else { continue };
            edits.extend(brackets(at + 1));
            names.push(close + 1);
            continue;
        }
        // Each name up to the end of the declaration may be an array.
        let mut name = at + 1;
        while is_name(name) {
            let end = if is(name + 1, "[") { closing(all, name + 1).map(|close| close + 1) } else { Some(name + 1) };
            if is(name + 1, "[") {
                names.push(name);
            }
            match end.filter(|end| is(*end, ",")) {
                Some(comma) => name = comma + 1,
                None => break,
            }
        }
    }
    let is_type = |at: usize| {
        is_name(at) && !matches!(all[at].text, "return" | "else" | "case") && !all[at].text.contains("sampler")
    };
    let others = (1..all.len()).filter(|at| is_name(*at) && is(at + 1, "[") && is_type(at - 1));
    // An array of numbers may have the same name where the samplers are not seen, or in place of them.
    let declared = names.iter().map(|name| (*name, true)).chain(others.map(|name| (name, false)));
    let declared: Vec<(Range<usize>, bool)> =
        declared.map(|(name, is_sampler)| (name..scope_end(all, name), is_sampler)).collect();
    let is_sampler = |at: usize| {
        let seen = declared.iter().filter(|(scope, _)| scope.contains(&at) && all[scope.start].text == all[at].text);
        seen.max_by_key(|(scope, _)| scope.start).is_some_and(|(_, is_sampler)| *is_sampler)
    };
    let uses = (1..all.len()).filter(|at| is(*at, "[") && is_sampler(at - 1));
    edits.extend(uses.filter_map(brackets));
    edits.into_iter().map(|bytes| blank(text, bytes)).collect()
}

/// Where the scope of a name ends: that of a parameter with the function, another one with the block around it.
fn scope_end(all: &[Token<'_>], name: usize) -> usize {
    let (mut parentheses, mut braces, mut is_parameter) = (0, 0, false);
    for (at, token) in all.iter().enumerate().skip(name) {
        match token.text {
            "(" => parentheses += 1,
            ")" if parentheses == 0 => is_parameter = true,
            ")" => parentheses -= 1,
            ";" if is_parameter && braces == 0 => return at,
            "{" => braces += 1,
            "}" if braces == 0 || is_parameter && braces == 1 => return at,
            "}" => braces -= 1,
            _ => {}
        }
    }
    all.len()
}

/// `uniform` in place of the macros that stand for it alone.
fn with_uniforms(all: &[Token<'_>]) -> Vec<Edit> {
    let is_end = |at: usize| all.get(at).is_none_or(|next| !next.in_directive || next.kind == TokenKind::Directive);
    let names = (0..all.len().saturating_sub(3)).filter(|at| {
        all[*at].kind == TokenKind::Directive
            && all[at + 1].text == "define"
            && all[at + 3].text == "uniform"
            && is_end(at + 4)
    });
    let names: Vec<&str> = names.map(|at| all[at + 2].text).collect();
    let used = all.iter().filter(|token| !token.in_directive && names.contains(&token.text));
    used.map(|token| (token.bytes.clone(), "uniform".to_owned())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_later_glsl_and_of_the_stage_are_replaced() {
        let text = "uniform sampler2D texture;\nfloat f(float case) { uvec2 = 1.0; return texture2D(texture, p).x + case; }\nvec3 toy;\n";
        let found = "uniform sampler2D textur_;\nfloat f(float cas_) { uvec2 = 1.0; return texture2D(textur_, p).x + cas_; }\nvec3 to_;\n";
        assert_eq!(plain(text), found);
        assert_eq!(with_plain_names("'textur_' : no 'to_'"), "'texture' : no 'toy'");
        for text in [
            "void f(in uint x) { uint a = uint(1); switch (a) { case 1u: return; } }\n",
            "layout(location = 0) out vec4 color;\nvec4 texture(vec2 p) { return texture(noise, p); }\n",
        ] {
            assert_eq!(plain(text), text);
        }
    }

    #[test]
    fn a_longer_name_stays_in_a_message() {
        assert_eq!(with_plain_names("'to_light' and 'to_'"), "'to_light' and 'toy'");
    }

    #[test]
    fn an_array_of_samplers_becomes_one_sampler() {
        let text = "uniform sampler2D a[N + 1], b;\nuniform samplerCube[2] c;\nfloat x[2];\n\
                    vec4 f(sampler2D d[2], float y) { return texture(d[0], p) + texture(a[x[0] > y ? 0 : 1], p) + c[\n1]; }\n";
        let found = plain(text);
        assert_eq!(found.len(), text.len());
        let squeezed = found.split_whitespace().collect::<Vec<_>>().join(" ");
        let expected = "uniform sampler2D a , b; uniform samplerCube c; float x[2]; \
                        vec4 f(sampler2D d , float y) { return texture(d , p) + texture(a , p) + c ; }";
        assert_eq!(squeezed, expected);
        assert_eq!(found.lines().count(), text.lines().count());
    }

    #[test]
    fn an_array_of_numbers_keeps_its_brackets_beside_samplers_of_the_same_name() {
        let text = "vec4 f(sampler2D d[2]) { return texture(d[0], p); }\nfloat g(float d[2]) { return d[1]; }\n\
                    uniform sampler2D a[2];\nfloat h() { { float a[3]; a[2] = 1.0; } return texture(a[1], p).x; }\n";
        let squeezed = plain(text).split_whitespace().collect::<Vec<_>>().join(" ");
        let expected = "vec4 f(sampler2D d ) { return texture(d , p); } float g(float d[2]) { return d[1]; } \
                        uniform sampler2D a ; float h() { { float a[3]; a[2] = 1.0; } return texture(a , p).x; }";
        assert_eq!(squeezed, expected);
    }

    #[test]
    fn a_macro_may_stand_for_uniform() {
        assert_eq!(plain("#define U uniform\nU float a; // U\n"), "#define U uniform\nuniform float a; // U\n");
        let more = "#define U uniform float\nU a;\n";
        assert_eq!(plain(more), more);
    }
}
