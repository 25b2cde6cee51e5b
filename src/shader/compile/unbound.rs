//! Finds the uniforms and buffers that a text declares without a binding.

use std::collections::BTreeSet;

use crate::shader::glsl::syntax::outside_brackets;
use crate::shader::glsl::{Token, code, is_name};

/// The names of uniforms, and of uniform and buffer blocks, that are declared without `layout(binding = ...)` and need one. Knows no
/// macros.
pub fn unbound(text: &str) -> BTreeSet<String> {
    if !text.contains("uniform") && !text.contains("buffer") {
        return BTreeSet::new();
    }
    let code = code(text);
    let (mut names, mut first, mut depth) = (BTreeSet::new(), 0, 0_u32);
    for (at, token) in code.iter().enumerate() {
        if depth == 0 && matches!(token.text, "{" | ";") {
            names.extend(declared(&code[first..at]));
        }
        match token.text {
            "{" => depth += 1,
            "}" => (depth, first) = (depth.saturating_sub(1), at + 1),
            ";" => first = at + 1,
            _ => {}
        }
    }
    names
}

/// The names that a statement at file level declares, if it declares uniforms or buffers without a binding.
fn declared(statement: &[Token<'_>]) -> Vec<String> {
    // Without what is in brackets: the layout, and lengths of arrays.
    let plain: Vec<&str> = outside_brackets(statement).map(|(_, token)| token.text).collect();
    let is = |word: &str| statement.iter().any(|token| token.text == word);
    let has_none = ["binding", "push_constant", "buffer_reference"].into_iter().any(is);
    if !(plain.contains(&"uniform") || plain.contains(&"buffer")) || has_none {
        return Vec::new();
    }
    let names = plain.split(|token| *token == ",").filter_map(|part| part.iter().rev().find(|token| is_name(token)));
    names.map(|name| (*name).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_without_a_binding() {
        let text = "#define uniform x\n\
            layout(set = 0, binding = 1) uniform sampler2D bound;\n\
            uniform sampler2D a, b[2]; // uniform sampler2D c;\n\
            layout(push_constant) uniform Push { float x; } push;\n\
            layout(rgba16f) uniform writeonly image2D\n  image;\n\
            uniform Block { float uniform_like; } block;\n\
            layout(buffer_reference, scalar) readonly buffer Pointed { vec4 at[]; };\n\
            layout(std430) readonly buffer Particles { vec4 at[N(2)]; };\n\
            layout(scalar,\n  binding = 3) uniform Other { float y; };\n\
            float f(int buffer) { int uniform; }\n\
            void main() {}\n";
        let names: Vec<String> = unbound(text).into_iter().collect();
        assert_eq!(names, ["Block", "Particles", "a", "b", "image"]);
    }
}
