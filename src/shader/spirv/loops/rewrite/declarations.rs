//! The variables, constants and the buffer that counting loops need, and the entry point's interface that lists them.

use super::{Buffer, Module, Shared};
use crate::shader::spirv::loops::Bounds;
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::specialize::{Id, Instruction, instruction, opcode};

impl Module {
    /// The id of a global declaration with these operands behind its result; declares it if it is not there.
    fn global(&mut self, opcode_: u32, operands: &[u32]) -> Id {
        let same = |i: &&Instruction| opcode(i) == opcode_ && i.get(2..) == Some(operands);
        if let Some(i) = self.globals.iter().chain(&self.more).find(same) {
            return i[1];
        }
        let id = self.id();
        self.more.push(instruction(opcode_, &[&[id], operands].concat()));
        id
    }

    pub(super) fn constant(&mut self, of: Id, bits: u32) -> Id {
        let is_same =
            |i: &&Instruction| opcode(i) == op::CONSTANT && i.get(1) == Some(&of) && i.get(3..) == Some(&[bits]);
        if let Some(i) = self.globals.iter().chain(&self.more).find(is_same) {
            return i[2];
        }
        let id = self.id();
        self.more.push(instruction(op::CONSTANT, &[of, id, bits]));
        id
    }

    pub(super) fn declare(&mut self, bounds: &Bounds) -> Shared {
        const PRIVATE: u32 = 6;
        let uint = self.global(op::TYPE_INT, &[32, 0]);
        let boolean = self.global(op::TYPE_BOOL, &[]);
        let pointer = self.global(op::TYPE_POINTER, &[PRIVATE, uint]);
        let [counter, culprit] = std::array::from_fn(|_| {
            let id = self.id();
            self.more.push(instruction(op::VARIABLE, &[pointer, id, PRIVATE]));
            id
        });
        Shared {
            uint,
            boolean,
            counter,
            culprit,
            zero: self.constant(uint, 0),
            budget: self.constant(uint, bounds.rounds),
            half: self.constant(uint, bounds.rounds / 2),
            over: self.constant(uint, bounds.rounds + 1),
        }
    }

    /// Declares the buffer that names the loop: `buffer { uint words[3]; }`.
    pub(super) fn buffer(&mut self, shared: &Shared, (set, binding): (u32, u32)) -> Buffer {
        const STORAGE_BUFFER: u32 = 12;
        let (one, two) = (self.constant(shared.uint, 1), self.constant(shared.uint, 2));
        let three = self.constant(shared.uint, 3);
        let [array, block, to_block, variable] = std::array::from_fn(|_| self.id());
        self.more.extend([
            instruction(op::TYPE_ARRAY, &[array, shared.uint, three]),
            instruction(op::TYPE_STRUCT, &[block, array]),
            instruction(op::TYPE_POINTER, &[to_block, STORAGE_BUFFER, block]),
            instruction(op::VARIABLE, &[to_block, variable, STORAGE_BUFFER]),
        ]);
        let pointer = self.global(op::TYPE_POINTER, &[STORAGE_BUFFER, shared.uint]);
        // ArrayStride, Block, Offset, DescriptorSet, Binding.
        let decorations = [
            instruction(op::DECORATE, &[array, 6, 4]),
            instruction(op::DECORATE, &[block, 2]),
            instruction(op::MEMBER_DECORATE, &[block, 0, 35, 0]),
            instruction(op::DECORATE, &[variable, 34, set]),
            instruction(op::DECORATE, &[variable, 33, binding]),
        ];
        // Decorations come before the first type.
        let is_type = |i: &Instruction| {
            (op::TYPE_VOID..=op::TYPE_POINTER).contains(&opcode(i)) || opcode(i) == op::TYPE_FORWARD_POINTER
        };
        let types = self.globals.iter().position(is_type).unwrap_or(self.globals.len());
        self.globals.splice(types..types, decorations);
        Buffer { variable, pointer, one, two }
    }

    /// The output variable at location 0, if it is a `vec4`.
    pub(super) fn output(&self, entry: &[u32]) -> Option<Id> {
        const LOCATION: u32 = 30;
        const OUTPUT: u32 = 3;
        let is_first = |id: &Id| {
            let decorated = |i: &Instruction| opcode(i) == op::DECORATE && i.get(1..) == Some(&[*id, LOCATION, 0]);
            let declared = |i: &Instruction| opcode(i) == op::VARIABLE && i[2..] == [*id, OUTPUT];
            self.globals.iter().any(decorated) && self.globals.iter().any(declared) && self.vec4(*id).is_some()
        };
        entry.iter().skip(3).copied().find(is_first)
    }

    /// The type that a variable points to, with the type of its components, if it is a `vec4`.
    fn vec4(&self, variable: Id) -> Option<(Id, Id)> {
        let made = |operation: u32, at: usize, id: Id| {
            self.globals.iter().find(|i| opcode(i) == operation && i.get(at) == Some(&id))
        };
        let pointer = made(op::VARIABLE, 2, variable)?[1];
        let vector = *made(op::TYPE_POINTER, 1, pointer)?.get(3)?;
        let component = made(op::TYPE_VECTOR, 1, vector).filter(|i| i.get(3) == Some(&4))?[2];
        made(op::TYPE_FLOAT, 1, component).map(|_| (vector, component))
    }

    pub(super) fn color(&mut self, to: Id, color: [f32; 4]) -> Id {
        let id = self.id();
        if let Some((vector, component)) = self.vec4(to) {
            let parts = color.map(|x| self.constant(component, x.to_bits()));
            self.more.push(instruction(op::CONSTANT_COMPOSITE, &[&[vector, id], &parts[..]].concat()));
        }
        id
    }

    /// Lists the new variables in the entry point's interface. A fragment stage that writes a buffer would run its
    /// depth test late; without `discard` and own depth, the early test makes no difference but the time.
    pub(super) fn join_interface(&mut self, entry: &[u32], shared: &Shared, report: Option<Buffer>) {
        const FRAGMENT: u32 = 4;
        const EARLY_FRAGMENT_TESTS: u32 = 9;
        const DEPTH_REPLACING: u32 = 12;
        const BUILT_IN: u32 = 11;
        const SAMPLE_MASK: u32 = 20;
        let Some(at) = self.globals.iter().position(|i| i == entry) else { return };
        let more = [Some(shared.counter), Some(shared.culprit), report.map(|report| report.variable)];
        let operands: Vec<u32> = entry[1..].iter().copied().chain(more.into_iter().flatten()).collect();
        self.globals[at] = instruction(op::ENTRY_POINT, &operands);
        let blocks = self.functions.iter().flat_map(|function| &function.blocks);
        let mut ends = blocks.filter_map(|block| block.body.last());
        let discards = ends.any(|i| matches!(opcode(i), op::KILL | op::TERMINATE_INVOCATION));
        let changes_test = self.globals.iter().any(|i| match opcode(i) {
            op::EXECUTION_MODE => matches!(i.get(2), Some(&(EARLY_FRAGMENT_TESTS | DEPTH_REPLACING))),
            op::DECORATE => i.get(2..) == Some(&[BUILT_IN, SAMPLE_MASK]),
            _ => false,
        });
        if entry.get(1) == Some(&FRAGMENT) && report.is_some() && !discards && !changes_test {
            self.globals.insert(at + 1, instruction(op::EXECUTION_MODE, &[entry[2], EARLY_FRAGMENT_TESTS]));
        }
    }
}
