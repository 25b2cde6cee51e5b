//! Instructions, and the functions and blocks that they form.

use crate::shader::spirv::op::Op;

/// The number of a result. 0 stands for none.
pub type Id = u32;

/// An instruction: a range of the words of its module. `module[instruction]` are its words, of which the first holds the operation and
/// the length.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    pub op: Op,
    pub(super) length: u16,
    pub(super) start: u32,
}

/// A function: the instructions before its first block, and its blocks.
#[derive(Debug)]
pub struct Function {
    pub id: Id,
    pub head: Vec<Instruction>,
    pub blocks: Vec<Block>,
}

/// A basic block: its label and its instructions, including the branch at its end.
#[derive(Debug)]
pub struct Block {
    pub label: Id,
    pub body: Vec<Instruction>,
}

impl Function {
    /// Adds the next instruction of a module with these words.
    pub(super) fn push(&mut self, i: Instruction, words: &[u32]) {
        match (i.op, self.blocks.last_mut()) {
            (Op::Label, _) => self.blocks.push(Block { label: words[i.start as usize + 1], body: Vec::new() }),
            (_, Some(block)) => block.body.push(i),
            (_, None) => self.head.push(i),
        }
    }

    /// All instructions but the labels and the end.
    pub fn instructions(&self) -> impl Iterator<Item = Instruction> {
        self.head.iter().copied().chain(self.body())
    }

    /// The instructions of all blocks.
    pub fn body(&self) -> impl Iterator<Item = Instruction> + Clone {
        self.blocks.iter().flat_map(|block| &block.body).copied()
    }
}

impl Block {
    /// The last instruction.
    pub fn end(&self) -> Option<Instruction> {
        self.body.last().copied()
    }

    /// Whether the last instruction has this operation.
    pub fn ends_with(&self, op: Op) -> bool {
        self.end().is_some_and(|i| i.op == op)
    }
}
