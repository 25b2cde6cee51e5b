//! The functions and blocks of a module, read from its words.

use super::instruction::{Block, Function, Id};
use super::words::Module;
use crate::shader::spirv::op::Op;

impl Function {
    /// The functions that it calls, as often as it calls them.
    pub fn calls(&self, module: &Module) -> impl Iterator<Item = Id> {
        self.body().filter(|i| i.op == Op::FunctionCall).map(|i| module[i][3])
    }

    /// The type that it returns.
    pub fn returns(&self, module: &Module) -> Id {
        module.type_of(self.id)
    }

    /// All ids that it defines but its own.
    pub fn results(&self, module: &Module) -> impl Iterator<Item = Id> {
        let labels = self.blocks.iter().map(|block| block.label);
        labels.chain(self.instructions().skip(1).filter_map(|i| module.result(i)))
    }
}

impl Block {
    /// The merge and continue blocks that the block's merge instruction names.
    pub fn structure(&self, module: &Module) -> (Option<Id>, Option<Id>) {
        match self.body.iter().rev().nth(1) {
            Some(i) if i.op == Op::SelectionMerge => (Some(module[*i][1]), None),
            Some(i) if i.op == Op::LoopMerge => (Some(module[*i][1]), Some(module[*i][2])),
            _ => (None, None),
        }
    }

    /// The blocks that may follow.
    pub fn targets<'a>(&self, module: &'a Module) -> impl Iterator<Item = Id> + 'a {
        let (words, step) = match self.end() {
            Some(i) if i.op == Op::Branch => (&module[i][1..], 1),
            Some(i) if i.op == Op::BranchConditional => (&module[i][2..4], 1),
            Some(i) if i.op == Op::Switch => (&module[i][2..], 2),
            _ => (&[][..], 1),
        };
        words.iter().copied().step_by(step)
    }
}
