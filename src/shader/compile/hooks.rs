//! A hook of the author's with other parameters than the tree calls it with: trees of older versions have others.

use std::collections::BTreeSet;

use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{find_word, lines};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// The hooks of the shipped tree: name and declaration.
const HOOKS: [(&str, &str); 6] = [
    ("user_surface", "void user_surface(inout Surface s, Fragment f, vec3 v)"),
    ("user_light", "void user_light(inout Light light, uint index, vec3 position_ws)"),
    ("user_radiance", "vec3 user_radiance(Surface s, vec3 v, vec3 radiance)"),
    ("user_vertex", "void user_vertex(inout Vertex vertex)"),
    ("user_background", "vec3 user_background(vec3 direction_ws, vec3 radiance)"),
    ("user_display", "vec3 user_display(vec3 light, vec2 uv)"),
];

/// The error at the author's hook `name`, if the line `call` calls it as the shipped tree does and a file of the stage defines it with
/// other parameters.
pub(super) fn other_parameters(
    name: &str,
    call: &str,
    snapshot: &Snapshot<'_>,
    files: &BTreeSet<TreePath>,
) -> Option<Diagnostic> {
    let (_, declaration) = HOOKS.iter().find(|(hook, _)| *hook == name)?;
    if count(call, name)? != count(declaration, name)? {
        return None;
    }
    files.iter().find_map(|path| {
        let text = snapshot.read(path).ok()?;
        let lines = lines(&text);
        let is_definition = |code: &str| {
            let at = find_word(code, name)?;
            let is_typed = matches!(code[..at.start].trim(), "void" | "vec3");
            is_typed.then_some(at)
        };
        let (bytes, line) = lines.iter().find_map(|line| Some((is_definition(&line.code)?, line)))?;
        let message = format!("`{name}` has other parameters than this tree calls it with");
        let error = Diagnostic::error(snapshot.display_path(path), message);
        let error = error.on_line(line.number, Some(line.raw)).under(bytes);
        Some(error.with_help(format!("write `{declaration}`")))
    })
}

/// How many arguments or parameters follow a name on a line.
fn count(code: &str, name: &str) -> Option<usize> {
    let rest = code[find_word(code, name)?.end..].trim_start().strip_prefix('(')?;
    let inside = &rest[..rest.find(')')?];
    Some(inside.split(',').count())
}
