//! Finds the uniforms and buffers that a text declares without a binding.

use std::collections::BTreeSet;

use crate::shader::source::text::{is_word, lines, tokens};

/// The names of uniforms, and of uniform and buffer blocks, that are declared without `layout(binding = ...)`. Knows no macros.
pub fn unbound(text: &str) -> BTreeSet<String> {
    if !text.contains("uniform") && !text.contains("buffer") {
        return BTreeSet::new();
    }
    let lines = lines(text);
    let code: Vec<&str> =
        lines.iter().map(|line| line.code.as_str()).filter(|c| !c.trim_start().starts_with('#')).collect();
    let mut names = BTreeSet::new();
    let mut statement: Vec<&str> = Vec::new();
    let mut depth = 0_u32;
    for token in code.iter().flat_map(|code| tokens(code)).map(|(_, token)| token) {
        match token {
            "{" => {
                if depth == 0 {
                    names.extend(declared(&statement, true));
                }
                depth += 1;
            }
            "}" => {
                depth = depth.saturating_sub(1);
                statement.clear();
            }
            _ if depth > 0 => {}
            ";" => {
                names.extend(declared(&statement, false));
                statement.clear();
            }
            token => statement.push(token),
        }
    }
    names
}

/// The names that a statement at file level declares, if it declares uniforms or buffers without a binding.
fn declared(statement: &[&str], is_block: bool) -> Vec<String> {
    let is_name = |token: &&str| token.starts_with(|c: char| is_word(c) && !c.is_ascii_digit());
    // Without what is in brackets: the layout, and lengths of arrays.
    let mut depth = 0_u32;
    let plain: Vec<&str> = statement
        .iter()
        .copied()
        .filter(|token| {
            depth += u32::from(matches!(*token, "(" | "["));
            let keep = depth == 0;
            depth = depth.saturating_sub(u32::from(matches!(*token, ")" | "]")));
            keep
        })
        .collect();
    let is = |word: &str| statement.contains(&word);
    if !(plain.contains(&"uniform") || plain.contains(&"buffer")) || is("binding") || is("push_constant") {
        return Vec::new();
    }
    if is_block {
        return plain.iter().rev().find(|token| is_name(token)).map(|name| (*name).to_owned()).into_iter().collect();
    }
    plain
        .split(|token| *token == ",")
        .filter_map(|part| part.iter().rev().find(|token| is_name(token)))
        .map(|name| (*name).to_owned())
        .collect()
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
            layout(std430) readonly buffer Particles { vec4 at[N(2)]; };\n\
            layout(scalar,\n  binding = 3) uniform Other { float y; };\n\
            float f(int buffer) { int uniform; }\n\
            void main() {}\n";
        let names: Vec<String> = unbound(text).into_iter().collect();
        assert_eq!(names, ["Block", "Particles", "a", "b", "image"]);
    }
}
