//! The branches of a function before it is instrumented.

use foldhash::{HashMap, HashSet};

use super::functions::is_line;
use crate::shader::spirv::module::{Block, Function, Id, Instruction, Module};
use crate::shader::spirv::op::{Class, Op};

/// Blocks that are followed to the first line of a branch.
const MOST_BLOCKS: usize = 16;

/// A branch by a constant, to which the compiler gives no line.
pub(super) struct ConstantBranch {
    /// The line of the first code in the first branch.
    pub(super) line: Option<Instruction>,
    /// How many other conditions are before that code; `None` if the statement goes on behind the branch on the same line, as `? :` does.
    pub(super) between: Option<usize>,
}

/// The branches of a function.
pub(super) struct Branches {
    /// The blocks that begin with a phi. glslang evaluates `&&` and `||` by a branch to such a block, which is no decision about statements.
    joins: HashSet<Id>,
    /// The first line of each block, and its end.
    blocks: HashMap<Id, (Option<Instruction>, Option<Instruction>)>,
}

impl Branches {
    pub(super) fn new(function: &Function) -> Self {
        let first = |block: &Block| block.body.iter().find(|i| !is_line(**i)).copied();
        let begins_with_phi = |block: &&Block| first(block).is_some_and(|i| i.op == Op::Phi);
        let joins = function.blocks.iter().filter(begins_with_phi).map(|block| block.label).collect();
        let blocks = function.blocks.iter().map(|block| (block.label, (line_of(block), block.end())));
        Self { joins, blocks: blocks.collect() }
    }

    /// Whether a merge instruction belongs to `&&` or `||`.
    pub(super) fn is_of_expression(&self, module: &Module, merge: Instruction) -> bool {
        self.joins.contains(&module[merge][1])
    }

    /// A branch by a constant; `None` if no constant decides. `merge`: the instruction before it, if there is one.
    pub(super) fn constant(
        &self,
        module: &Module,
        branch: Instruction,
        merge: Option<Instruction>,
    ) -> Option<ConstantBranch> {
        let words = &module[branch];
        let first = match branch.op {
            Op::BranchConditional => words[2],
            Op::Switch => words.get(4).copied().unwrap_or(words[2]),
            _ => return None,
        };
        module.definition(words[1]).filter(|i| i.op.class() == Class::Constant)?;
        let Some((line, between)) = self.first_line(module, first) else {
            return Some(ConstantBranch { line: None, between: None });
        };
        let after = merge.and_then(|merge| self.first_line(module, module[merge][1]));
        let goes_on = after.is_some_and(|(after, _)| module[after][1..3] == module[line][1..3]);
        Some(ConstantBranch { line: Some(line), between: (!goes_on).then_some(between) })
    }

    /// The line of the first code from a block on, and how many conditions are before it.
    fn first_line(&self, module: &Module, mut label: Id) -> Option<(Instruction, usize)> {
        let mut between = 0;
        for _ in 0..MOST_BLOCKS {
            let (line, end) = self.blocks.get(&label)?;
            if let Some(line) = line {
                return Some((*line, between));
            }
            let end = (*end)?;
            label = match end.op {
                Op::Branch => module[end][1],
                Op::BranchConditional => module[end][2],
                _ => return None,
            };
            between += usize::from(end.op == Op::BranchConditional);
        }
        None
    }
}

/// The line of the first instruction of a block. That of a branch by a constant is still that of the code before.
fn line_of(block: &Block) -> Option<Instruction> {
    let mut line = None;
    for &i in &block.body {
        match i.op {
            Op::Line => line = Some(i),
            Op::NoLine => line = None,
            Op::Variable | Op::Phi => {}
            Op::SelectionMerge | Op::BranchConditional | Op::Switch => return None,
            _ => return line,
        }
    }
    None
}
