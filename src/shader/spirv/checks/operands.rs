//! The operands of checked operations.

use super::suspect::Suspect;
use super::{Checker, MOST_OPERANDS};
use crate::shader::spirv::module::{Id, Instruction, Type};
use crate::shader::spirv::op::Op;
use crate::shader::spirv::trace::NumberKind;

impl Checker<'_> {
    /// How many components a value has; 1 for a scalar.
    pub(super) fn components(&self, value: Id) -> u32 {
        match self.module.get_type(self.module.type_of(value)) {
            Some(Type::Vector { count, .. }) => count,
            _ => 1,
        }
    }

    /// The type of a value's components.
    fn scalar_of(&self, value: Id) -> Id {
        let kind = self.module.type_of(value);
        match self.module.get_type(kind) {
            Some(Type::Vector { of, .. }) => of,
            _ => kind,
        }
    }

    /// The type of bools that stands beside a value.
    pub(super) fn bools(&mut self, value: Id) -> Id {
        let count = self.components(value);
        let bool = self.module.declare(Op::TypeBool, &[]);
        if count > 1 { self.module.declare(Op::TypeVector, &[bool, count]) } else { bool }
    }

    /// The constant of these bits in each component of the type of `value`.
    pub(super) fn same(&mut self, value: Id, bits: u32) -> Id {
        let (kind, scalar, count) = (self.module.type_of(value), self.scalar_of(value), self.components(value));
        let one = self.module.constant(scalar, bits);
        match count {
            1 => one,
            _ => self.module.declare(Op::ConstantComposite, &[&[kind][..], &vec![one; count as usize]].concat()),
        }
    }

    /// A component of a value, or the scalar itself.
    fn component(&mut self, out: &mut Vec<Instruction>, value: Id, at: u32) -> Id {
        if self.components(value) == 1 {
            return value;
        }
        let scalar = self.scalar_of(value);
        self.module.emit(out, Op::CompositeExtract, scalar, &[value, at])
    }

    /// Whether any of these is true.
    pub(super) fn any(&mut self, out: &mut Vec<Instruction>, broken: Id) -> Id {
        if self.components(broken) == 1 {
            return broken;
        }
        let bool = self.module.declare(Op::TypeBool, &[]);
        self.module.emit(out, Op::Any, bool, &[broken])
    }

    /// The suspect where a select takes its side: `condition` is true, if that is the first one, or false.
    pub(super) fn if_selected(
        &mut self,
        out: &mut Vec<Instruction>,
        suspect: Suspect,
        condition: Id,
        is_first: bool,
    ) -> Suspect {
        let kind = self.module.type_of(condition);
        let takes = if is_first { condition } else { self.module.emit(out, Op::LogicalNot, kind, &[condition]) };
        let (wide, narrow) = (self.components(suspect.broken), self.components(takes));
        let (broken, takes) = match (wide, narrow) {
            (a, b) if a == b => (suspect.broken, takes),
            // One condition for all components.
            (count, 1) => {
                let bools = self.module.type_of(suspect.broken);
                let all = self.module.emit(out, Op::CompositeConstruct, bools, &vec![takes; count as usize]);
                (suspect.broken, all)
            }
            _ => {
                let takes = self.any(out, takes);
                (self.any(out, suspect.broken), takes)
            }
        };
        let kind = self.module.type_of(broken);
        let both = self.module.emit(out, Op::LogicalAnd, kind, &[broken, takes]);
        Suspect { broken: both, ..suspect }
    }

    /// The type of a value's numbers.
    pub(super) fn kind(&self, value: Id) -> NumberKind {
        match self.module.get_type(self.scalar_of(value)) {
            Some(Type::Int { signed: true, .. }) => NumberKind::Int,
            Some(Type::Int { .. }) => NumberKind::Uint,
            Some(Type::Bool) => NumberKind::Bool,
            _ => NumberKind::Float,
        }
    }

    /// The operands that a check gives, and how many numbers of each: a rule of each component shows one of them, and a rule of the whole,
    /// as that of normalize(), the first ones.
    pub(super) fn shown(&self, suspect: &Suspect) -> Vec<(Id, u32)> {
        let is_whole = self.components(suspect.broken) == 1;
        let mut left = MOST_OPERANDS as u32;
        let shown = suspect.operands.iter().map(|operand| {
            let count = if is_whole { self.components(*operand).min(left) } else { left.min(1) };
            left -= count;
            (*operand, count)
        });
        shown.filter(|(_, count)| *count > 0).collect()
    }

    /// Calls the function with the operands: once for each component that may break the rule on its own.
    pub(super) fn call(&mut self, out: &mut Vec<Instruction>, function: Id, suspect: &Suspect, number: u32) {
        let shown = self.shown(suspect);
        let [zero, one, number] = [0, 1, number + 1].map(|bits| self.module.constant(self.uint, bits));
        for at in 0..self.components(suspect.broken) {
            let broken = self.component(out, suspect.broken, at);
            let number = self.module.emit(out, Op::Select, self.uint, &[broken, number, zero]);
            let mut words = Vec::new();
            for (operand, count) in &shown {
                for component in at..at + count {
                    let value = self.component(out, *operand, component);
                    words.push(match self.kind(value) {
                        NumberKind::Uint => value,
                        NumberKind::Bool => self.module.emit(out, Op::Select, self.uint, &[value, one, zero]),
                        _ => self.module.emit(out, Op::Bitcast, self.uint, &[value]),
                    });
                }
            }
            words.resize(MOST_OPERANDS, zero);
            let bits = self.module.emit(out, Op::CompositeConstruct, self.uvec4, &words);
            self.module.emit(out, Op::FunctionCall, self.void, &[function, number, bits]);
        }
    }
}
