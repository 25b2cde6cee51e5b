//! The words of a module: reads, writes, copies and makes instructions.

use std::ops::{Index, IndexMut};

use super::instruction::{Function, Id, Instruction};
use crate::shader::spirv::op::{Class, Op};

/// Words before the first instruction. The second is the version, the fourth is more than the largest id.
const HEADER: usize = 5;
pub(super) const MAGIC: u32 = 0x0723_0203;
/// The largest bound that the specification allows (section 2.17).
const MOST_IDS: usize = 4_194_303;
const VERSION: usize = 1;
const BOUND: usize = 3;

/// The properties of an id.
#[derive(Clone, Copy, Debug, Default)]
struct Definition {
    /// Its type, if it is a value.
    kind: Id,
    /// The instruction with this result, unless it is a label or still to be made.
    by: Option<Instruction>,
}

/// A module with the parts that the specification puts in this order (section 2.4).
#[derive(Debug)]
pub struct Module {
    header: [u32; HEADER],
    code: Vec<u32>,
    /// Indexed by id.
    definitions: Vec<Definition>,
    /// Capabilities, imports, the memory model, entry points and their modes.
    pub head: Vec<Instruction>,
    /// Sources and names.
    pub debug: Vec<Instruction>,
    /// Decorations.
    pub decorations: Vec<Instruction>,
    /// Types, constants, variables.
    pub globals: Vec<Instruction>,
    /// Functions, in the order of the module.
    pub functions: Vec<Function>,
}

impl Index<Instruction> for Module {
    type Output = [u32];

    fn index(&self, i: Instruction) -> &[u32] {
        &self.code[i.start as usize..][..usize::from(i.length)]
    }
}

impl IndexMut<Instruction> for Module {
    fn index_mut(&mut self, i: Instruction) -> &mut [u32] {
        &mut self.code[i.start as usize..][..usize::from(i.length)]
    }
}

impl Module {
    /// Reads a module. `None` if it is not SPIR-V, or an instruction is truncated.
    pub fn parse(words: &[u32]) -> Option<Self> {
        let header: [u32; HEADER] = *words.first_chunk()?;
        let bound = header[BOUND] as usize;
        if header[0] != MAGIC || bound > MOST_IDS {
            return None;
        }
        let mut module = Self {
            header,
            code: words.to_vec(),
            definitions: vec![Definition::default(); bound],
            head: Vec::new(),
            debug: Vec::new(),
            decorations: Vec::new(),
            globals: Vec::new(),
            functions: Vec::new(),
        };
        let (mut start, mut is_open) = (HEADER, false);
        while let Some(first) = words.get(start) {
            let (op, length) = (Op::of(*first), (first >> 16) as u16);
            let end = start + usize::from(length);
            if usize::from(length) < op.least_length() || end > words.len() {
                return None;
            }
            let i = Instruction { op, length, start: start as u32 };
            module.define(i)?;
            match op {
                Op::Function => {
                    module.functions.push(Function { id: module[i][2], head: vec![i], blocks: Vec::new() });
                    is_open = true;
                }
                Op::FunctionEnd => is_open = false,
                _ if is_open => module.functions.last_mut()?.push(i, words),
                _ => module.part_of(op).push(i),
            }
            start = end;
        }
        Some(module)
    }

    /// The list that a declaration belongs to.
    fn part_of(&mut self, op: Op) -> &mut Vec<Instruction> {
        match op.class() {
            Class::Mode => &mut self.head,
            Class::Annotation => &mut self.decorations,
            // Lines stay with what they are about.
            Class::Debug if !matches!(op, Op::Line | Op::NoLine) => &mut self.debug,
            _ => &mut self.globals,
        }
    }

    /// Records the result of an instruction. `None` if it is beyond the bound of the module. What may be the result of an unknown
    /// instruction is one only if nothing else defines it.
    fn define(&mut self, i: Instruction) -> Option<()> {
        let words = &self[i];
        let Some((at, id)) = i.op.result().and_then(|at| Some((at, *words.get(at)?))) else { return Some(()) };
        let kind = if at == 2 { words[1] } else { 0 };
        match self.definitions.get_mut(id as usize) {
            Some(definition) if i.op != Op::Unknown || definition.by.is_none() => {
                *definition = Definition { kind, by: (i.op != Op::Label).then_some(i) };
            }
            _ if i.op == Op::Unknown => {}
            _ => return None,
        }
        Some(())
    }

    /// The words of the module.
    pub fn write(&self) -> Vec<u32> {
        let mut out = Vec::with_capacity(self.code.len());
        out.extend(self.header);
        out[BOUND] = self.bound();
        let add = |out: &mut Vec<u32>, all: &[Instruction]| all.iter().for_each(|i| out.extend_from_slice(&self[*i]));
        [&self.head, &self.debug, &self.decorations, &self.globals].into_iter().for_each(|all| add(&mut out, all));
        for function in &self.functions {
            add(&mut out, &function.head);
            for block in &function.blocks {
                out.extend([2 << 16 | Op::Label as u32, block.label]);
                add(&mut out, &block.body);
            }
            out.push(1 << 16 | Op::FunctionEnd as u32);
        }
        out
    }

    /// The version of SPIR-V, as the header gives it.
    pub fn version(&self) -> u32 {
        self.header[VERSION]
    }

    /// More than the largest id.
    pub fn bound(&self) -> u32 {
        self.definitions.len() as u32
    }

    /// A new id for a value of this type; 0 for all that has no type.
    pub fn fresh(&mut self, kind: Id) -> Id {
        self.definitions.push(Definition { kind, by: None });
        self.bound() - 1
    }

    /// New ids, whose types follow from the instructions that define them.
    pub fn ids<const N: usize>(&mut self) -> [Id; N] {
        std::array::from_fn(|_| self.fresh(0))
    }

    /// Makes an instruction. It belongs to the module once it is in one of its lists.
    pub fn make(&mut self, op: Op, operands: &[u32]) -> Instruction {
        let (start, length) = (self.code.len() as u32, operands.len() as u16 + 1);
        self.code.push(u32::from(length) << 16 | op as u32);
        self.code.extend_from_slice(operands);
        let made = Instruction { op, length, start };
        self.define(made);
        made
    }

    /// Makes an instruction with a new id for its value, and appends it to a list.
    pub fn emit(&mut self, out: &mut Vec<Instruction>, op: Op, kind: Id, operands: &[u32]) -> Id {
        let id = self.fresh(kind);
        out.push(self.make(op, &[&[kind, id], operands].concat()));
        id
    }

    /// A copy of an instruction with other ids.
    pub fn copy(&mut self, i: Instruction, mut map: impl FnMut(Id) -> Id) -> Instruction {
        let start = self.code.len();
        self.code.extend_from_within(i.start as usize..i.start as usize + usize::from(i.length));
        let copy = Instruction { start: start as u32, ..i };
        for at in 1..usize::from(i.length) {
            if i.op.is_id(&self.code[start..], at) {
                self.code[start + at] = map(self.code[start + at]);
            }
        }
        self.define(copy);
        copy
    }

    /// A copy of an instruction about an id, such as a name or a decoration, about another.
    pub fn about(&mut self, i: Instruction, target: Id) -> Instruction {
        let copy = self.copy(i, |id| id);
        self[copy][1] = target;
        copy
    }

    /// The ids among the words of an instruction, its result included.
    pub fn ids_of(&self, i: Instruction) -> impl Iterator<Item = Id> {
        let words = &self[i];
        (1..words.len()).filter(move |at| i.op.is_id(words, *at)).map(|at| words[at])
    }

    /// The result of an instruction.
    pub fn result(&self, i: Instruction) -> Option<Id> {
        let id = self[i].get(i.op.result()?).copied();
        let is_own = |id: &Id| self.definition(*id).is_some_and(|by| by.start == i.start);
        id.filter(|id| i.op != Op::Unknown || is_own(id))
    }

    /// The instruction that defines an id.
    pub fn definition(&self, id: Id) -> Option<Instruction> {
        self.definitions.get(id as usize)?.by
    }

    /// The words of the instruction that defines an id, if it has this operation.
    pub fn defined(&self, op: Op, id: Id) -> Option<&[u32]> {
        self.definition(id).filter(|i| i.op == op).map(|i| &self[i])
    }

    /// The type of a value.
    pub fn type_of(&self, id: Id) -> Id {
        self.definitions.get(id as usize).map_or(0, |definition| definition.kind)
    }

    /// The value of a 32-bit constant or a boolean.
    pub fn number(&self, id: Id) -> Option<u32> {
        let i = self.definition(id)?;
        match (i.op, &self[i]) {
            (Op::ConstantTrue, _) => Some(1),
            (Op::ConstantFalse, _) => Some(0),
            (Op::Constant, [_, _, _, value]) => Some(*value),
            _ => None,
        }
    }
}
