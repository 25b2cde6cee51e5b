//! Types as a shader spells them, in place of glslang's descriptions.

use crate::shader::glsl::QUALIFIERS;

/// The message with each quoted description of a type replaced by the type: `vec3` for `global highp 3-component vector of float`.
pub fn with_types(message: &str) -> String {
    let parts = message.split('\'').enumerate().map(|(at, part)| match at % 2 == 1 && part.contains(' ') {
        true => spelled(part).unwrap_or_else(|| part.to_owned()),
        false => part.to_owned(),
    });
    parts.collect::<Vec<_>>().join("'")
}

/// The type of a description.
fn spelled(description: &str) -> Option<String> {
    /// Words that only glslang has in front of a type.
    const OF_GLSLANG: [&str; 3] = ["global", "temp", "specialization-constant"];
    let mut rest = description.trim();
    loop {
        let next = match rest.strip_prefix("layout(") {
            Some(inside) => inside.split_once(')')?.1,
            None => match rest.split_once(' ') {
                Some((word, next)) if QUALIFIERS.contains(&word) || OF_GLSLANG.contains(&word) => next,
                _ => break,
            },
        };
        rest = next.trim_start();
    }
    if rest.starts_with("structure{") {
        return Some("a struct".to_owned());
    }
    if let Some((count, element)) = rest.split_once("-element array of ") {
        return Some(format!("{}[{}]", spelled(element)?, count.parse::<u32>().ok()?));
    }
    if let Some((count, scalar)) = rest.split_once("-component vector of ") {
        return Some(format!("{}vec{}", prefix(scalar)?, count.parse::<u32>().ok()?));
    }
    if let Some((size, scalar)) = rest.split_once(" matrix of ") {
        let (columns, rows) = size.split_once('X')?;
        let size = if columns == rows { columns.to_owned() } else { format!("{columns}x{rows}") };
        return Some(format!("{}mat{size}", prefix(scalar)?));
    }
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    (!rest.is_empty() && rest.chars().all(is_word)).then(|| rest.to_owned())
}

/// The beginning of the vector types of a scalar.
fn prefix(scalar: &str) -> Option<&'static str> {
    Some(match scalar.trim().rsplit(' ').next()? {
        "float" => "",
        "int" => "i",
        "uint" => "u",
        "bool" => "b",
        "double" => "d",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_spelled_as_in_a_shader() {
        for (description, expected) in [
            (" const 3-component vector of float", "vec3"),
            ("layout( location=0) out highp 4-component vector of float", "vec4"),
            (" temp highp uint", "uint"),
            (" const 2-component vector of bool", "bvec2"),
            (" uniform highp 3X3 matrix of float", "mat3"),
            (" global highp 2X4 matrix of float", "mat2x4"),
            (" temp 4-element array of highp 2-component vector of int", "ivec2[4]"),
            (" inout structure{ global highp 3-component vector of float n", "a struct"),
            ("two words", "two words"),
        ] {
            let message = format!("'assign' : cannot convert from '{description}' to ' const float'");
            assert_eq!(with_types(&message), format!("'assign' : cannot convert from '{expected}' to 'float'"));
        }
        let other = "'x' : undeclared identifier, and isn't known";
        assert_eq!(with_types(other), other);
    }
}
