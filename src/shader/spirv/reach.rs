//! Finds the resources that the entry point of a module reaches through its functions, and the source line of a use.

use std::collections::{BTreeMap, BTreeSet};

use super::bindings::{BINDING, DESCRIPTOR_SET};
use super::opcode as op;
use super::operands::{is_id, text};
use super::specialize::instructions;

const PUSH_CONSTANT: u32 = 9;

/// A resource that a module uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Used {
    /// The descriptor at a set and binding.
    Descriptor(u32, u32),
    /// The push constants.
    PushConstants,
}

/// The descriptors and push constants that functions of the module use, as far as an entry point calls them. What a module only
/// declares does not count.
pub fn reached(words: &[u32]) -> BTreeSet<Used> {
    let module = Module::of(words);
    let uses = module.reachable().into_iter().flat_map(|function| &module.functions[&function].uses);
    uses.filter_map(|id| module.resources.get(id)).copied().collect()
}

/// The functions that an entry point calls, directly or not, and the entry points.
pub fn reachable_functions(words: &[u32]) -> BTreeSet<u32> {
    Module::of(words).reachable()
}

/// The file and line of the first use of a resource in a module with debug information.
pub fn line_of(words: &[u32], used: Used) -> Option<(String, u32)> {
    let module = Module::of(words);
    let reachable = module.reachable();
    let wanted: BTreeSet<u32> = module.resources.iter().filter(|(_, of)| **of == used).map(|(id, _)| *id).collect();
    let (mut at_line, mut function) = (None, 0);
    let all = instructions(words)?;
    let mut is_use = |i: &&[u32]| {
        match i[0] & 0xffff {
            op::LINE => at_line = i.get(1).copied().zip(i.get(2).copied()),
            op::FUNCTION => function = i.get(2).copied().unwrap_or_default(),
            _ => return reachable.contains(&function) && ids(i).any(|id| wanted.contains(&id)),
        }
        false
    };
    all.iter().find(|i| is_use(i))?;
    let (file, line) = at_line?;
    let name = all.iter().find(|i| i[0] & 0xffff == op::STRING && i.get(1) == Some(&file))?;
    Some((text(name.get(2..)?), line))
}

#[derive(Default)]
struct Function {
    calls: Vec<u32>,
    /// Ids of the resources that it names.
    uses: BTreeSet<u32>,
}

/// The call graph of a module.
#[derive(Default)]
struct Module {
    entries: Vec<u32>,
    /// The variables that are resources.
    resources: BTreeMap<u32, Used>,
    functions: BTreeMap<u32, Function>,
}

impl Module {
    fn of(words: &[u32]) -> Self {
        let mut module = Self::default();
        let (mut sets, mut bindings) = (BTreeMap::new(), BTreeMap::new());
        let mut current = None;
        for i in instructions(words).unwrap_or_default() {
            match (i[0] & 0xffff, &i[1..]) {
                (op::ENTRY_POINT, [_, function, ..]) => module.entries.push(*function),
                (op::DECORATE, [id, DESCRIPTOR_SET, set]) => {
                    sets.insert(*id, *set);
                }
                (op::DECORATE, [id, BINDING, binding]) => {
                    bindings.insert(*id, *binding);
                }
                (op::VARIABLE, [_, id, class, ..]) if current.is_none() => {
                    let place = sets.get(id).zip(bindings.get(id)).map(|(set, at)| Used::Descriptor(*set, *at));
                    let push = (*class == PUSH_CONSTANT).then_some(Used::PushConstants);
                    module.resources.extend(push.or(place).map(|used| (*id, used)));
                }
                (op::FUNCTION, [_, id, ..]) => {
                    current = Some(*id);
                    module.functions.insert(*id, Function::default());
                }
                _ => {
                    let Some(function) = current.and_then(|id| module.functions.get_mut(&id)) else { continue };
                    if i[0] & 0xffff == op::FUNCTION_CALL {
                        function.calls.extend(i.get(3));
                    }
                    function.uses.extend(ids(i).filter(|id| module.resources.contains_key(id)));
                }
            }
        }
        module
    }

    /// The functions that an entry point calls, directly or not, and the entry points.
    fn reachable(&self) -> BTreeSet<u32> {
        let mut open = self.entries.clone();
        let mut found = BTreeSet::new();
        while let Some(id) = open.pop() {
            if let Some(function) = self.functions.get(&id).filter(|_| found.insert(id)) {
                open.extend(&function.calls);
            }
        }
        found
    }
}

/// The ids among the operands of an instruction within a function. Of an unknown instruction every word counts.
pub(super) fn ids(i: &[u32]) -> impl Iterator<Item = u32> + '_ {
    let counts = |at: usize| !matches!(i[0] & 0xffff, op::LINE | op::NO_LINE) && is_id(i, at).unwrap_or(true);
    (1..i.len()).filter(move |at| counts(*at)).map(|at| i[at])
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
        let used = |functions: &str| reached(&compile(functions).0).into_iter().collect::<Vec<_>>();
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
            assert!(reached(&words).is_empty());
            assert!(line_of(&words, Used::PushConstants).is_none());
        }
    }
}
