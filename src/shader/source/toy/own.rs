//! The names that a toy declares or defines itself, which the stage leaves to it.

use std::collections::BTreeSet;
use std::ops::Range;

use super::adapt::NAMES_OF_ES;
use super::declared::declarations;
use super::plain::renamed;
use crate::shader::glsl::{Token, TokenKind, tokens};

/// Macros of toy.glsl and of the stage for names that a file may define or declare itself.
const MACROS: [&str; 13] = [
    "texture2D",
    "textureCube",
    "texture2DProj",
    "texture2DLod",
    "texture2DLodEXT",
    "textureCubeLodEXT",
    "texture2DGradEXT",
    "gl_FragDepthEXT",
    "lowp",
    "mediump",
    "highp",
    "HW_PERFORMANCE",
    "iChannelResolution",
];
const PRECISIONS: [&str; 3] = ["lowp", "mediump", "highp"];

/// The variables, functions, types and macros of some texts, at file level and outside of `#if`: only the compiler knows which of
/// the others exist.
#[derive(Default)]
pub(super) struct OwnNames {
    pub(super) declared: BTreeSet<String>,
    defined: BTreeSet<String>,
}

impl OwnNames {
    /// Adds the names of a text. Uniforms, inputs and outputs, which the stage replaces, are left out.
    pub(super) fn add(&mut self, text: &str) {
        let tokens = unconditional(text);
        let is_define = |three: &&[Token<'_>]| three[0].kind == TokenKind::Directive && three[1].text == "define";
        self.defined.extend(tokens.windows(3).filter(is_define).map(|three| three[2].text.to_owned()));
        let code: Vec<Token<'_>> = tokens.into_iter().filter(|token| !token.in_directive).collect();
        let replaced: Vec<Range<usize>> =
            declarations(&code).into_iter().map(|declaration| declaration.bytes).collect();
        let mut depth = 0_usize;
        for (at, (before, token)) in code.iter().zip(code.iter().skip(1)).enumerate() {
            match before.text {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth = depth.saturating_sub(1),
                _ => {}
            }
            let may_follow = before.kind == TokenKind::Word || matches!(before.text, "," | "}" | "]");
            let is_name = token.kind == TokenKind::Word && !PRECISIONS.contains(&token.text);
            let is_replaced = || replaced.iter().any(|bytes| bytes.contains(&token.bytes.start));
            if depth == 0 && may_follow && is_name && !is_replaced() && !is_overload(&code[at + 1..]) {
                self.declared.insert(token.text.to_owned());
            }
        }
    }

    /// The lines that remove the macros of these names.
    pub(super) fn removed_macros(&self) -> String {
        let is_own = |name: &&&str| self.declared.contains(**name) || self.defined.contains(**name);
        let removed = |name: &&str| match NAMES_OF_ES.contains(name) {
            true => format!("#undef {}\n", renamed(name)),
            false => format!("#undef {name}\n"),
        };
        MACROS.iter().filter(is_own).map(removed).collect()
    }
}

/// Whether these tokens are the name and the parameters of a function that overloads one of GLSL ES 1.00, whose macro then stands for both.
fn is_overload(code: &[Token<'_>]) -> bool {
    let is_sampling = code[0].text == "texture2D" || code[0].text == "textureCube";
    if !is_sampling || code.get(1).is_none_or(|open| open.text != "(") {
        return false;
    }
    let is_end = |token: &&Token<'_>| token.text != ")";
    let parameters: Vec<&str> = code[2..].iter().take_while(is_end).map(|token| token.text).collect();
    let is_type = |word: &&&str| !matches!(**word, "in" | "const" | "lowp" | "mediump" | "highp");
    let types: Vec<&str> =
        parameters.split(|text| *text == ",").filter_map(|words| words.iter().find(is_type)).copied().collect();
    let is_built_in = |flat: [&str; 2]| types.starts_with(&flat) && matches!(types[2..], [] | ["float"]);
    !is_built_in(["sampler2D", "vec2"]) && !is_built_in(["samplerCube", "vec3"])
}

/// The tokens of a text outside of comments and of `#if`.
fn unconditional(text: &str) -> Vec<Token<'_>> {
    let all: Vec<Token<'_>> = tokens(text).filter(|token| token.kind != TokenKind::Comment).collect();
    let (mut out, mut depth) = (Vec::new(), 0_usize);
    for (at, token) in all.iter().enumerate() {
        match all.get(at + 1).map_or("", |next| next.text) {
            _ if token.kind != TokenKind::Directive => {}
            "if" | "ifdef" | "ifndef" => depth += 1,
            "endif" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            out.push(token.clone());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_at_file_level_are_a_files_own() {
        let mut own = OwnNames::default();
        own.add(
            "precision lowp float;\nuniform float time;\nconst vec4 iMouse = vec4(a, b.x), other[2];\nfloat iTime = f(c), after;\n\
             void u_time(float parameter) { float local; }\nstruct Own { float field; } v_texcoord;\n#define texture2D(a) a\n\
             #ifdef GL_ES\nfloat maybe;\n#define mediump\n#endif\nfloat last;\n",
        );
        let declared: Vec<&str> = own.declared.iter().map(String::as_str).collect();
        for name in ["iMouse", "other", "iTime", "after", "u_time", "Own", "v_texcoord", "last"] {
            assert!(declared.contains(&name), "{name}: {declared:?}");
        }
        for name in ["time", "a", "b", "c", "parameter", "local", "field", "maybe", "lowp"] {
            assert!(!declared.contains(&name), "{name}: {declared:?}");
        }
        assert_eq!(own.removed_macros(), "#undef texture2_\n");
    }

    #[test]
    fn a_function_replaces_a_macro_or_overloads_it() {
        for (parameters, is_own) in [
            ("sampler2D s, vec2 p", true),
            ("in sampler2D s, const in highp vec2 p, float bias", true),
            ("sampler2D s, vec2 p, vec2 size", false),
            ("vec2 p", false),
        ] {
            let mut own = OwnNames::default();
            own.add(&format!("vec4 texture2D({parameters}) {{ return vec4(0.0); }}\n"));
            assert_eq!(own.declared.contains("texture2D"), is_own, "{parameters}");
        }
    }
}
