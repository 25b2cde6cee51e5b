//! The error about a number that is declared as a uniform outside a block, with the lines that make a slider of it.

use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{Line, TokenKind};
use crate::shader::source::TreePath;

/// Text that glslang prints in place of a name.
pub(super) const OUTSIDE: &str = "non-opaque uniforms outside a block";

const PRECISIONS: [&str; 3] = ["lowp", "mediump", "highp"];

/// The error, with the caret under the name. `None` if the line does not declare a uniform.
pub(super) fn outside_a_block(file: &str, line: &Line<'_>, stage: &TreePath) -> Option<Diagnostic> {
    let tokens = line.tokens();
    let at = tokens.iter().position(|token| token.text == "uniform")?;
    let mut words = tokens[at + 1..].iter().filter(|token| !PRECISIONS.contains(&token.text));
    let kind = words.next().filter(|token| token.kind == TokenKind::Word)?.text;
    let declared = words.next().filter(|token| token.kind == TokenKind::Word)?;
    let name = declared.text;
    let message = format!("`{name}` is a {kind} outside a block; only samplers and images are uniforms of their own");
    let member = match slider(kind) {
        Some(ui) => format!("{kind} {name};   //@ui \"{}\" {ui}", label(name)),
        None => format!("{kind} {name};"),
    };
    // The picture's own stages share a block.
    let help = match stage.as_str().starts_with("passes/") {
        true => format!("put it into a block, where //@ui makes it a slider:\nuniform Sliders {{\n    {member}\n}};"),
        false => {
            format!("put it into the block `Params` of user/params.glsl, where //@ui makes it a slider:\n    {member}")
        }
    };
    let error = Diagnostic::error(file, message).on_line(line.number, Some(line.raw));
    Some(error.under(declared.bytes.clone()).with_help(help))
}

/// An example of the rest of a `//@ui`; `None` for a type that has none.
fn slider(kind: &str) -> Option<&'static str> {
    Some(match kind {
        "float" => "0..1 = 0.5",
        "int" | "uint" => "0..10 = 1",
        "bool" => "= true",
        "vec2" => "0..1 = 0.5 0.5",
        "vec3" => "color = 1 1 1",
        "vec4" => "color = 1 1 1 1",
        _ => return None,
    })
}

/// `rim_strength` as `Rim strength`.
fn label(name: &str) -> String {
    let words = name.replace('_', " ");
    let mut chars = words.trim().chars();
    chars.next().map_or_else(|| name.to_owned(), |first| first.to_uppercase().chain(chars).collect())
}
