//! Functions of the author's that have the name of one that is built into GLSL.
//!
//! GLSL allows them. glslang refuses one with the parameters of a built-in function, since that has no precision, and in Vulkan those of
//! an author have one. So such a stage is compiled again, with other names.

use std::collections::BTreeSet;

use super::names::is_no_type;
use crate::shader::glsl::{Code, is_name};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::rename_functions;

/// The beginning of the names that stand for those of the author.
const PREFIX: &str = "own_";
/// The error about a function with the parameters of another.
const OVERLOADED: &str = "overloaded functions must have the same";

/// The names of the functions that a log refuses.
pub(super) fn refused(log: &str, snapshot: &Snapshot<'_>) -> BTreeSet<String> {
    let places = log.lines().filter(|row| row.contains(OVERLOADED)).filter_map(|row| {
        let (file, line) = row.split(": error: ").next()?.rsplit_once(':')?;
        Some((TreePath::parse(file)?, line.parse().ok()?))
    });
    let places: BTreeSet<(TreePath, u32)> = places.collect();
    places.iter().flat_map(|(path, line)| declared(path, *line, snapshot)).collect()
}

/// The functions whose declarations end on a line, or else the last before it.
fn declared(path: &TreePath, line: u32, snapshot: &Snapshot<'_>) -> BTreeSet<String> {
    let Ok(text) = snapshot.read(path) else { return BTreeSet::new() };
    let code = Code::new(&text);
    let is_head = |at: &usize| {
        let [kind, name, open] = [0, 1, 2].map(|next| code.tokens[at + next].text);
        open == "(" && is_name(kind) && is_name(name) && !is_no_type(kind)
    };
    let heads = (0..code.tokens.len().saturating_sub(2)).filter(is_head).map(|at| {
        let name = &code.tokens[at + 1];
        (code.number_at(name.bytes.start), name.text.to_owned())
    });
    let mut before: Vec<(u32, String)> = heads.take_while(|(at, _)| *at <= line).collect();
    let last = before.last().map_or(line, |(at, _)| *at);
    before.retain(|(at, _)| *at == last);
    before.into_iter().map(|(_, name)| name).collect()
}

/// The name that stands for an author's.
pub(super) fn renamed(name: &str) -> String {
    format!("{PREFIX}{name}")
}

/// A log with the author's names.
pub(super) fn named_again(log: &str, names: &BTreeSet<String>) -> String {
    names.iter().fold(log.to_owned(), |log, name| log.replace(&renamed(name), name))
}

/// A module with the author's names.
pub(super) fn restore(words: &mut Vec<u32>, names: &BTreeSet<String>) {
    rename_functions(words, |name| {
        let own = name.strip_prefix(PREFIX)?;
        names.contains(own.split('(').next()?).then(|| own.to_owned())
    });
}

#[cfg(test)]
mod tests {
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::Module;

    #[test]
    fn functions_may_have_the_names_of_built_in_ones() {
        let library = "float min3(float a, float b,\n    float c) { return min(a, min(b, c)); }\n\
            float fma(float a, float b, float c) { return a * b + c; } int bitCount(int x) { return x + 1; }\n\
            float round(float x);\nfloat round(float x) { return floor(x + 0.5); }\n";
        let stage = "#version 460\n#include \"lib.glsl\"\nlayout(location = 0) out vec4 color;\n\
            layout(location = 0) in vec4 x;\n\
            void main() { color = vec4(min3(x.x, x.y, x.z), fma(x.x, x.y, x.z), float(bitCount(int(x.x))), round(x.w)); }\n";
        let source = Source::memory([("m.frag", stage), ("lib.glsl", library)]);
        let compiled = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into());
        let module = Module::parse(&compiled.result.unwrap()).unwrap();
        let mut names: Vec<String> = module.called_functions().collect();
        names.sort();
        assert_eq!(names, ["bitCount(i1;", "fma(f1;f1;f1;", "min3(f1;f1;f1;", "round(f1;"]);
    }

    #[test]
    fn errors_have_the_names_of_the_author() {
        let stage = "#version 460\nfloat fma(float a, float b, float c) { return a; }\n\
            void main() { vec2 x = fma(1.0, 2.0, 3.0); fma(vec4(1.0)); }\nint f() { return 1; }\nfloat f() { return 1.0; }\n";
        let source = Source::memory([("m.frag", stage)]);
        let errors = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap_err();
        let lines: Vec<String> = errors.iter().map(|error| error.one_line()).collect();
        assert!(lines.iter().any(|line| line.starts_with("m.frag:3:24: error: 'fma' : no matching")), "{lines:#?}");
        assert!(lines.iter().any(|line| line.contains("m.frag:5:") && line.contains("same return type")), "{lines:#?}");
        assert!(lines.iter().all(|line| !line.contains("own_")), "{lines:#?}");
    }
}
