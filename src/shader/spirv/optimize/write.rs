//! Drops the declarations that nothing uses.

use super::optimizer::Optimizer;
use crate::shader::spirv::enums::built_in::WORKGROUP_SIZE;
use crate::shader::spirv::enums::decoration::BUILT_IN;
use crate::shader::spirv::enums::storage::PRIVATE;
use crate::shader::spirv::module::{Id, Module};
use crate::shader::spirv::op::{Op, after_text};

/// Place of an entry point's name, before its interface.
const NAME: usize = 3;

impl Optimizer {
    /// The module with the globals that its functions use.
    pub(super) fn finish(mut self) -> Module {
        let code: Vec<_> = self.module.code().collect();
        code.iter().for_each(|i| self.resolve_operands(*i));
        let Self { mut module, mut decorations, .. } = self;
        let mut used = vec![false; module.bound() as usize];
        let mut mark = |id: Id| used[id as usize] = true;
        let mut locals = Vec::new();
        for i in code {
            module.ids_of(i).for_each(&mut mark);
            locals.extend(module.result(i).and_then(|id| decorations.remove(&id)).into_iter().flatten());
        }
        let modes = module.head.iter().filter(|i| i.op == Op::ExecutionMode);
        modes.for_each(|i| mark(module[*i][1]));
        // A forward pointer is used before it is defined.
        let forward = module.globals.iter().filter(|i| i.op == Op::TypeForwardPointer);
        forward.for_each(|i| mark(module[*i][1]));
        // A constant that counts even if nothing uses it.
        let sizes = module
            .decorations
            .iter()
            .filter(|i| i.op == Op::Decorate && module[**i][2..] == [BUILT_IN, WORKGROUP_SIZE]);
        sizes.for_each(|i| mark(module[*i][1]));
        // From the last definition to the first, since each comes before its uses. Variables of the interface stay.
        for i in module.globals.iter().rev() {
            let Some(id) = module.result(*i) else { continue };
            let is_interface = i.op == Op::Variable && module[*i][3] != PRIVATE;
            if is_interface || used[id as usize] {
                module.ids_of(*i).for_each(|id| used[id as usize] = true);
            }
        }
        let mut globals = std::mem::take(&mut module.globals);
        globals.retain(|i| module.result(*i).is_none_or(|id| used[id as usize]));
        let mut decorations = std::mem::take(&mut module.decorations);
        decorations.retain(|i| used[module[*i][1] as usize]);
        decorations.extend(locals);
        (module.globals, module.decorations) = (globals, decorations);
        drop_unused_interface(&mut module, &used);
        module
    }
}

/// Keeps the variables of the entry point's interface that are left.
fn drop_unused_interface(module: &mut Module, used: &[bool]) {
    for place in 0..module.head.len() {
        let i = module.head[place];
        if i.op == Op::EntryPoint {
            let words = &module[i];
            let (name, interface) = words.split_at(after_text(words, NAME));
            let kept = interface.iter().filter(|id| used[**id as usize]);
            let operands: Vec<u32> = name[1..].iter().chain(kept).copied().collect();
            module.head[place] = module.make(Op::EntryPoint, &operands);
        }
    }
}
