//! Finds the resources that the entry point of a module reaches through its functions, and the source line of a use.

use std::collections::BTreeSet;

use super::enums::decoration::{BINDING, DESCRIPTOR_SET};
use super::enums::storage::PUSH_CONSTANT;
use super::module::{Function, Id, Instruction, Module};
use super::op::{Op, text};

/// A resource that a module uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Used {
    /// The descriptor at a set and binding.
    Descriptor(u32, u32),
    /// The push constants.
    PushConstants,
}

impl Used {
    /// The bindings in `set` among resources.
    pub fn bindings(used: &BTreeSet<Self>, set: u32) -> BTreeSet<u32> {
        let binding = |used: &Self| match used {
            Self::Descriptor(of, binding) if *of == set => Some(*binding),
            _ => None,
        };
        used.iter().filter_map(binding).collect()
    }
}

/// The descriptors and push constants that functions of the module use, as far as the entry point calls them. What a module only
/// declares does not count.
pub fn reached(module: &Module) -> BTreeSet<Used> {
    let resources = resources(module);
    let code = reachable(module).into_iter().flat_map(Function::body);
    code.flat_map(|i| uses(module, i)).filter_map(|id| *resources.get(id as usize)?).collect()
}

/// The file and line of the first use of a resource in a module with debug information.
pub fn line_of(words: &[u32], used: Used) -> Option<(String, u32)> {
    let module = Module::parse(words)?;
    let resources = resources(&module);
    let is_use = |id: Id| resources.get(id as usize) == Some(&Some(used));
    let mut at_line = None;
    for i in reachable(&module).into_iter().flat_map(Function::body) {
        match i.op {
            Op::Line => at_line = Some(i),
            _ if uses(&module, i).any(is_use) => break,
            _ => {}
        }
    }
    let line = at_line.filter(|_| reached(&module).contains(&used)).map(|i| &module[i])?;
    file_of(&module, line)
}

/// The file and line that an `OpLine` names.
pub fn file_of(module: &Module, line: &[u32]) -> Option<(String, u32)> {
    Some((text(&module.defined(Op::String, line[1])?[2..]), line[2]))
}

/// The variables that are resources, by id.
fn resources(module: &Module) -> Vec<Option<Used>> {
    let (mut sets, mut bindings) = (vec![None; module.bound() as usize], vec![None; module.bound() as usize]);
    for i in module.decorations.iter().filter(|i| i.op == Op::Decorate) {
        match module[*i] {
            [_, id, DESCRIPTOR_SET, set] if id < module.bound() => sets[id as usize] = Some(set),
            [_, id, BINDING, binding] if id < module.bound() => bindings[id as usize] = Some(binding),
            _ => {}
        }
    }
    let mut resources = vec![None; module.bound() as usize];
    for i in module.globals.iter().filter(|i| i.op == Op::Variable) {
        let (id, class) = (module[*i][2] as usize, module[*i][3]);
        let place = sets[id].zip(bindings[id]).map(|(set, binding)| Used::Descriptor(set, binding));
        resources[id] = if class == PUSH_CONSTANT { Some(Used::PushConstants) } else { place };
    }
    resources
}

/// The functions that the entry point calls, directly or not, and itself, in the order of the module.
pub(super) fn reachable(module: &Module) -> Vec<&Function> {
    let mut places = module.entry_function().and_then(|entry| module.callees_first(entry)).unwrap_or_default();
    places.sort_unstable();
    places.into_iter().map(|place| &module.functions[place]).collect()
}

/// The ids that an instruction uses. Of an unknown one every word counts.
pub(super) fn uses(module: &Module, i: Instruction) -> impl Iterator<Item = Id> {
    let words = &module[i];
    (1..words.len()).filter(move |at| !i.op.is_known() || i.op.is_id(words, *at)).map(|at| words[at])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;

    const HEAD: &str = "#version 460\nlayout(set = 0, binding = 4) uniform A { vec4 a; };\n\
        layout(set = 1, binding = 0) uniform B { vec4 b; } block;\nlayout(set = 1, binding = 2) uniform sampler2D image;\n\
        layout(push_constant) uniform P { vec4 p; };\nlayout(location = 0) out vec4 color;\n";

    fn compile(functions: &str) -> (Vec<u32>, Vec<u32>) {
        let source = Source::memory([("m.frag", format!("{HEAD}{functions}").as_str())]);
        let (snapshot, stage) = (Snapshot::new(&source), "m.frag".into());
        let compiler = Compiler::new().unwrap();
        let plain = compiler.compile(&snapshot, &stage).result.unwrap();
        (plain, compiler.compile_with_lines(&snapshot, &stage).unwrap())
    }

    #[test]
    fn what_main_reaches_counts() {
        let used = |functions: &str| {
            let module = Module::parse(&compile(functions).0).expect("a module");
            reached(&module).into_iter().collect::<Vec<_>>()
        };
        assert_eq!(used("void main() { color = vec4(1.0); }"), []);
        assert_eq!(used("void main() { color = a; }"), [Used::Descriptor(0, 4)]);
        let nested = "vec4 f(sampler2D s) { return texture(s, p.xy); }\nvec4 g() { return block.b; }\n";
        assert_eq!(used(&format!("{nested}void main() {{ color = g(); }}")), [Used::Descriptor(1, 0)]);
        assert_eq!(
            used(&format!("{nested}void main() {{ color = f(image); }}")),
            [Used::Descriptor(1, 2), Used::PushConstants]
        );
    }

    #[test]
    fn a_use_has_a_line() {
        let (_, words) =
            compile("vec4 unused() { return a; }\nvec4 f() {\n    return a;\n}\nvoid main() { color = f(); }");
        assert_eq!(line_of(&words, Used::Descriptor(0, 4)), Some(("m.frag".to_owned(), 9)));
        assert_eq!(line_of(&words, Used::PushConstants), None);
    }

    #[test]
    fn garbage_is_no_panic() {
        for words in [vec![], vec![0; 40], vec![0x0723_0203, 0, 0, 9, 0, 0xffff_003b, 1]] {
            assert!(line_of(&words, Used::PushConstants).is_none());
        }
    }
}
