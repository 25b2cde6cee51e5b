//! Specializes a module for one value of each constant.

use foldhash::{HashMap, HashMapExt, HashSet, HashSetExt};

use crate::shader::spirv::enums::decoration::SPEC_ID;
use crate::shader::spirv::evaluate::evaluate;
use crate::shader::spirv::fold::{drop_results, fold};
use crate::shader::spirv::module::{Id, Module};
use crate::shader::spirv::op::Op;

/// Returns the module with these values (`constant_id` and the four bytes) for its specialization constants; the others
/// get their defaults. Returns words that are not valid SPIR-V unchanged.
pub fn specialize(words: &[u32], values: &[(u32, u32)]) -> Vec<u32> {
    let Some(mut module) = Module::parse(words) else { return words.to_vec() };
    let constants = constants(&module, values);
    set_constants(&mut module, &constants);
    match take_branches(&mut module, HashSet::new()) {
        Some(()) => module.write(),
        None => words.to_vec(),
    }
}

/// The specialization constants of a module and what is computed from them, with these values.
pub(super) fn constants(module: &Module, values: &[(u32, u32)]) -> HashMap<Id, u32> {
    let mut given = HashMap::new();
    for words in module.decorations.iter().filter(|i| i.op == Op::Decorate).map(|i| &module[*i]) {
        if let [_, id, SPEC_ID, number] = words {
            let value = values.iter().find(|(wanted, _)| wanted == number).map(|(_, value)| *value);
            given.extend(value.map(|value| (*id, value)));
        }
    }
    let mut known: HashMap<Id, u32> = HashMap::new();
    for i in &module.globals {
        let words = &module[*i];
        let value = |default: u32| Some(given.get(&words[2]).copied().unwrap_or(default));
        let value = match i.op {
            Op::SpecConstantTrue => value(1),
            Op::SpecConstantFalse => value(0),
            Op::SpecConstant if words.len() == 4 => value(words[3]),
            Op::SpecConstantOp => {
                let lookup = |id: Id| known.get(&id).copied().or_else(|| module.number(id));
                evaluate(Op::of(words[3]), &words[4..], &lookup)
            }
            _ => None,
        };
        known.extend(value.map(|value| (words[2], value)));
    }
    known
}

/// Declares plain constants with these values in place of specialization constants.
pub(super) fn set_constants(module: &mut Module, constants: &HashMap<Id, u32>) {
    for place in 0..module.globals.len() {
        let i = module.globals[place];
        let Some(value) = module.result(i).and_then(|id| constants.get(&id)) else { continue };
        let (kind, id) = (module[i][1], module[i][2]);
        module.globals[place] = match (module.defined(Op::TypeBool, kind).is_some(), value) {
            (true, 0) => module.make(Op::ConstantFalse, &[kind, id]),
            (true, _) => module.make(Op::ConstantTrue, &[kind, id]),
            (false, value) => module.make(Op::Constant, &[kind, id, *value]),
        };
    }
    // A constant with a value needs no SpecId.
    let mut decorations = std::mem::take(&mut module.decorations);
    decorations.retain(|i| i.op != Op::Decorate || module[*i][2] != SPEC_ID);
    module.decorations = decorations;
}

/// Takes the branches that constants decide. Drops the functions that the entry point no longer reaches, and the names and
/// decorations of everything that is dropped. `removed`: ids that were dropped before. `None` if there is no entry point.
pub(super) fn take_branches(module: &mut Module, mut removed: HashSet<Id>) -> Option<()> {
    let mut returned = HashMap::new();
    for function in &module.functions {
        if let [block] = &*function.blocks
            && let [only] = &*block.body
            && only.op == Op::ReturnValue
        {
            returned.extend(module.number(module[*only][1]).map(|value| (function.id, value)));
        }
    }
    let mut functions = std::mem::take(&mut module.functions);
    for function in &mut functions {
        fold(module, function, &HashMap::new(), &returned, &mut removed);
    }
    module.functions = functions;
    let mut is_called = vec![false; module.functions.len()];
    module.callees_first(module.entry_function()?)?.into_iter().for_each(|place| is_called[place] = true);
    for (function, _) in module.functions.iter().zip(&is_called).filter(|(_, is_called)| !**is_called) {
        removed.extend(function.results(module));
        removed.insert(function.id);
    }
    let mut is_called = is_called.into_iter();
    module.functions.retain(|_| is_called.next().unwrap_or(true));
    drop_results(module, &removed);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::specialize_several;

    const TEXT: &str = "#version 460
        layout(constant_id = 7) const uint KIND = 1u;
        layout(constant_id = 8) const bool TWICE = false;
        layout(location = 0) in vec4 x;
        layout(location = 0) out vec4 color;
        const bool IS_SECOND = KIND == 2u;
        bool is_third() { return KIND == 3u; }
        vec4 first() { return sin(x); }
        vec4 second() { vec4 y = x; for (int i = 0; i < 4; ++i) { if (y.x > 2.0) break; y = cos(y); } return y; }
        vec4 third() { return exp(x); }
        void main() {
            if (IS_SECOND && x.y > 0.0) color = second();
            else if (is_third()) { color = third(); return; }
            else color = first();
            if (TWICE) color *= 2.0;
        }";

    fn module() -> Vec<u32> {
        let source = Source::memory([("m.frag", TEXT)]);
        Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap()
    }

    /// The GLSL.std.450 functions that the module calls.
    fn extended(words: &[u32]) -> Vec<u32> {
        let module = Module::parse(words).expect("a module");
        module.code().filter(|i| i.op == Op::ExtInst).map(|i| module[i][4]).collect()
    }

    fn count(words: &[u32], op: Op) -> usize {
        let module = Module::parse(words).expect("a module");
        module.globals.iter().copied().chain(module.code()).filter(|i| i.op == op).count()
    }

    #[test]
    fn only_what_the_values_choose_is_left() {
        let module = module();
        assert_eq!(count(&module, Op::Function), 5);
        // GLSL.std.450: sin is 13, cos 14, exp 27.
        for (kind, functions, branches, called) in [(1, 3, 0, vec![13]), (2, 4, 3, vec![14, 13]), (3, 3, 0, vec![27])] {
            let folded = specialize(&module, &[(7, kind)]);
            // main, the function it calls, and is_third, whose call remains.
            assert_eq!(count(&folded, Op::Function), functions, "kind {kind}");
            assert_eq!(count(&folded, Op::BranchConditional), branches, "kind {kind}");
            let mut found = extended(&folded);
            found.sort_by_key(|number| called.iter().position(|c| c == number));
            assert_eq!(found, called, "kind {kind}");
            assert_eq!(count(&folded, Op::SpecConstant), 0);
            assert!(folded.len() < module.len());
        }
    }

    #[test]
    fn several_values_keep_the_code_that_one_of_them_needs() {
        let module = module();
        let both = specialize_several(&module, &[(8, 1)], 7, &[2, 3]).unwrap();
        let mut found = extended(&both);
        found.sort_unstable();
        // first() stays, since second() is taken for x.y > 0 only.
        assert_eq!(found, [13, 14, 27]);
        assert_eq!(count(&both, Op::SpecConstant) + count(&both, Op::SpecConstantOp), 0);
        // The condition of the loop over the values is one more than those of the stage.
        assert_eq!(count(&both, Op::LoopMerge), count(&module, Op::LoopMerge) + 1);
        let third = specialize_several(&module, &[(8, 1)], 7, &[3, 3]).map(|words| extended(&words));
        assert_eq!(third, None, "values that are the same leave nothing to choose");
        assert_eq!(specialize_several(&module, &[], 9, &[2, 3]), None, "the stage has no such constant");
    }

    #[test]
    fn garbage_comes_back() {
        for words in
            [vec![], vec![1, 2, 3], vec![0x0723_0203, 0, 0, 9, 0, 0], vec![0x0723_0203, 0, 0, 9, 0, 0xffff_0036]]
        {
            assert_eq!(specialize(&words, &[]), words);
        }
    }
}
