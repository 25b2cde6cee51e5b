//! Adds types, constants, variables and decorations to a module.

use foldhash::HashSet;

use super::instruction::{Id, Instruction};
use super::words::Module;
use crate::shader::spirv::op::{Op, after_text};

impl Module {
    /// The id of the type or constant with these operands besides its result, declared if the module lacks it. The operands of a
    /// constant begin with its type.
    pub fn declare(&mut self, op: Op, operands: &[u32]) -> Id {
        let (before, behind) = operands.split_at(usize::from(op.has_type()));
        let place = before.len() + 1;
        let is_same = |words: &[u32]| words[1..place] == *before && words[place + 1..] == *behind;
        let known = self.globals.iter().find(|i| i.op == op && is_same(&self[**i]));
        let known = known.map(|i| self[*i][place]);
        known.unwrap_or_else(|| self.declare_another(op, operands))
    }

    /// Declares a type, a constant or a variable, even if the module has one like it.
    pub fn declare_another(&mut self, op: Op, operands: &[u32]) -> Id {
        let id = self.fresh(0);
        let (before, behind) = operands.split_at(usize::from(op.has_type()));
        let made = self.make(op, &[before, &[id], behind].concat());
        self.globals.push(made);
        id
    }

    /// A 32-bit constant.
    pub fn constant(&mut self, kind: Id, bits: u32) -> Id {
        self.declare(Op::Constant, &[kind, bits])
    }

    /// A variable outside of functions.
    pub fn variable(&mut self, pointer: Id, class: u32) -> Id {
        self.declare_another(Op::Variable, &[pointer, class])
    }

    /// The end of a function that returns the zero of its type.
    pub fn return_zero(&mut self, kind: Id) -> Instruction {
        if self.defined(Op::TypeVoid, kind).is_some() {
            return self.make(Op::Return, &[]);
        }
        let zero = self.declare(Op::ConstantNull, &[kind]);
        self.make(Op::ReturnValue, &[zero])
    }

    /// Decorates an id: its target, the decoration and its literals.
    pub fn decorate(&mut self, operands: &[u32]) {
        let made = self.make(Op::Decorate, operands);
        self.decorations.push(made);
    }

    /// Takes variables out of the interface of the entry points.
    pub fn leave_interface(&mut self, variables: &HashSet<Id>) {
        for place in 0..self.head.len() {
            let entry = self.head[place];
            if entry.op == Op::EntryPoint {
                let (before, interface) = self[entry].split_at(after_text(&self[entry], 3));
                let left = interface.iter().filter(|id| !variables.contains(id));
                let operands: Vec<u32> = before[1..].iter().chain(left).copied().collect();
                self.head[place] = self.make(Op::EntryPoint, &operands);
            }
        }
    }

    /// Adds variables to the interface of the entry points.
    pub fn join_interface(&mut self, variables: &[Id]) {
        for place in 0..self.head.len() {
            let entry = self.head[place];
            if entry.op == Op::EntryPoint {
                let operands = [&self[entry][1..], variables].concat();
                self.head[place] = self.make(Op::EntryPoint, &operands);
            }
        }
    }
}
