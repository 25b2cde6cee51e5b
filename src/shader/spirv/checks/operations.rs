//! The operations that may break a rule, and when they do.

use super::suspect::Suspect;
use super::{Checker, Rule};
use crate::shader::spirv::enums::extended;
use crate::shader::spirv::module::{Id, Instruction, Type};
use crate::shader::spirv::op::Op;

/// 2^31 and -2^31: `int` holds what is below the first and not below the second.
const INT: [f32; 2] = [2_147_483_648.0, -2_147_483_648.0];
/// 2^32.
const UINT: f32 = 4_294_967_296.0;

impl Checker<'_> {
    /// The rules that an instruction may break. What decides about them is appended.
    pub(super) fn suspects(&mut self, out: &mut Vec<Instruction>, i: Instruction) -> Vec<Suspect> {
        let words = self.module[i].to_vec();
        match (i.op, &words[1..]) {
            (Op::FDiv | Op::FRem | Op::FMod, [_, _, a, b]) => self.unless_zero(out, Op::FOrdEqual, [*a, *b]),
            (Op::SDiv | Op::SRem | Op::SMod | Op::UDiv | Op::UMod, [_, _, a, b]) => {
                self.unless_zero(out, Op::IEqual, [*a, *b])
            }
            (Op::ConvertFToS, [_, _, x]) => {
                let above = self.compare(out, Op::FUnordGreaterThanEqual, *x, INT[0].to_bits());
                let below = self.compare(out, Op::FUnordLessThan, *x, INT[1].to_bits());
                self.either(out, Rule::ToInteger, [above, below], &[*x])
            }
            (Op::ConvertFToU, [_, _, x]) => {
                let above = self.compare(out, Op::FUnordGreaterThanEqual, *x, UINT.to_bits());
                let below = self.compare(out, Op::FUnordLessThanEqual, *x, (-1.0_f32).to_bits());
                self.either(out, Rule::ToInteger, [above, below], &[*x])
            }
            (Op::ShiftLeftLogical | Op::ShiftRightLogical | Op::ShiftRightArithmetic, [_, _, x, shift]) => {
                self.when(out, Rule::Shift, Op::UGreaterThanEqual, (*shift, 32), &[*x, *shift])
            }
            (Op::BitFieldSExtract | Op::BitFieldUExtract, [_, _, _, offset, count])
            | (Op::BitFieldInsert, [_, _, _, _, offset, count]) => self.bits(out, *offset, *count),
            (Op::VectorExtractDynamic, [_, _, vector, index]) | (Op::VectorInsertDynamic, [_, _, vector, _, index]) => {
                let count = self.components(*vector);
                self.when(out, Rule::Index, Op::UGreaterThanEqual, (*index, count), &[*index])
            }
            (Op::AccessChain | Op::InBoundsAccessChain, [_, _, base, indices @ ..]) => {
                self.indices(out, *base, indices)
            }
            (Op::ExtInst, [_, _, set, instruction, operands @ ..]) if Some(*set) == self.extended => {
                self.extended(out, *instruction, operands)
            }
            _ => Vec::new(),
        }
    }

    /// Whether a value is a plain constant for which `op` does not hold.
    fn keeps(&self, op: Op, value: Id, bits: u32) -> bool {
        if let Some(words) = self.module.defined(Op::ConstantComposite, value) {
            return words[3..].iter().all(|part| self.keeps(op, *part, bits));
        }
        let is_plain = self.module.defined(Op::Constant, value).is_some();
        self.module.number(value).filter(|_| is_plain).is_some_and(|number| !holds(op, number, bits))
    }

    fn compare(&mut self, out: &mut Vec<Instruction>, op: Op, value: Id, bits: u32) -> Id {
        let (bools, other) = (self.bools(value), self.same(value, bits));
        self.module.emit(out, op, bools, &[value, other])
    }

    /// The rule is broken where `op` holds for a value and a number.
    fn when(
        &mut self,
        out: &mut Vec<Instruction>,
        rule: Rule,
        op: Op,
        (value, bits): (Id, u32),
        operands: &[Id],
    ) -> Vec<Suspect> {
        if self.keeps(op, value, bits) {
            return Vec::new();
        }
        let broken = self.compare(out, op, value, bits);
        vec![Suspect::new(rule, broken, operands)]
    }

    fn either(&mut self, out: &mut Vec<Instruction>, rule: Rule, [a, b]: [Id; 2], operands: &[Id]) -> Vec<Suspect> {
        let kind = self.module.type_of(a);
        let broken = self.module.emit(out, Op::LogicalOr, kind, &[a, b]);
        vec![Suspect::new(rule, broken, operands)]
    }

    fn unless_zero(&mut self, out: &mut Vec<Instruction>, equal: Op, [a, b]: [Id; 2]) -> Vec<Suspect> {
        self.when(out, Rule::DivisionByZero, equal, (b, 0), &[a, b])
    }

    fn bits(&mut self, out: &mut Vec<Instruction>, offset: Id, count: Id) -> Vec<Suspect> {
        let (mut unsigned, kind) = ([offset, count], self.uint);
        for id in &mut unsigned {
            if self.module.type_of(*id) != kind {
                *id = self.module.emit(out, Op::Bitcast, kind, &[*id]);
            }
        }
        let end = self.module.emit(out, Op::IAdd, kind, &unsigned);
        // The sum may wrap around.
        let [mut broken, first, length] =
            [end, unsigned[0], unsigned[1]].map(|value| self.compare(out, Op::UGreaterThan, value, 32));
        let kind = self.module.type_of(broken);
        for more in [first, length] {
            broken = self.module.emit(out, Op::LogicalOr, kind, &[broken, more]);
        }
        vec![Suspect::new(Rule::Bits, broken, &[offset, count])]
    }

    /// Indices that are computed, into parts whose length is known.
    fn indices(&mut self, out: &mut Vec<Instruction>, base: Id, indices: &[Id]) -> Vec<Suspect> {
        let mut kind = self.module.pointer(self.module.type_of(base)).map(|(_, to)| to);
        let mut found = Vec::new();
        for index in indices {
            let Some(of) = kind else { break };
            let (length, next) = match self.module.get_type(of) {
                Some(Type::Array { of, length }) => (self.module.number(length), Some(of)),
                Some(Type::RuntimeArray { of }) => (None, Some(of)),
                Some(Type::Vector { of, count }) => (Some(count), Some(of)),
                Some(Type::Matrix { column, count }) => (Some(count), Some(column)),
                Some(Type::Struct { members }) => {
                    (None, self.module.number(*index).and_then(|at| members.get(at as usize)).copied())
                }
                _ => (None, None),
            };
            kind = next;
            if let Some(length) = length {
                found.extend(self.when(out, Rule::Index, Op::UGreaterThanEqual, (*index, length), &[*index]));
            }
        }
        found
    }

    /// The rules of the extended instructions (GLSL.std.450).
    fn extended(&mut self, out: &mut Vec<Instruction>, instruction: u32, operands: &[Id]) -> Vec<Suspect> {
        let one = 1.0_f32.to_bits();
        let zero = 0;
        match (instruction, operands) {
            (extended::SQRT, [x]) => self.when(out, Rule::Sqrt, Op::FOrdLessThan, (*x, zero), operands),
            (extended::INVERSE_SQRT, [x]) => {
                self.when(out, Rule::InverseSqrt, Op::FOrdLessThanEqual, (*x, zero), operands)
            }
            (extended::LOG | extended::LOG2, [x]) => {
                self.when(out, Rule::Log, Op::FOrdLessThanEqual, (*x, zero), operands)
            }
            (extended::ACOSH, [x]) => self.when(out, Rule::Acosh, Op::FOrdLessThan, (*x, one), operands),
            (extended::ASIN | extended::ACOS | extended::ATANH, [x]) => {
                let (rule, op) = match instruction {
                    extended::ATANH => (Rule::Atanh, Op::FOrdGreaterThanEqual),
                    _ => (Rule::Arc, Op::FOrdGreaterThan),
                };
                let kind = self.module.type_of(*x);
                let size = self.extend(out, kind, extended::FABS, &[*x]);
                let broken = self.compare(out, op, size, one);
                vec![Suspect::new(rule, broken, operands)]
            }
            (extended::ATAN2, [y, x]) => {
                let [a, b] = [*y, *x].map(|value| self.compare(out, Op::FOrdEqual, value, zero));
                self.both(out, Rule::Atan, [a, b], operands)
            }
            (extended::POW, [x, y]) => {
                let negative = self.compare(out, Op::FOrdLessThan, *x, zero);
                let base = self.compare(out, Op::FOrdEqual, *x, zero);
                let exponent = self.compare(out, Op::FOrdLessThanEqual, *y, zero);
                let kind = self.module.type_of(base);
                let of_zero = self.module.emit(out, Op::LogicalAnd, kind, &[base, exponent]);
                self.either(out, Rule::Pow, [negative, of_zero], operands)
            }
            (extended::NORMALIZE, [x]) => {
                let square = match self.components(*x) {
                    1 => *x,
                    _ => {
                        let Some(Type::Vector { of, .. }) = self.module.get_type(self.module.type_of(*x)) else {
                            return Vec::new();
                        };
                        self.module.emit(out, Op::Dot, of, &[*x, *x])
                    }
                };
                let broken = self.compare(out, Op::FOrdEqual, square, zero);
                vec![Suspect::new(Rule::Normalize, broken, operands)]
            }
            (extended::SMOOTHSTEP, [low, high, ..]) => {
                self.ordered(out, Rule::Smoothstep, Op::FOrdGreaterThanEqual, [*low, *high])
            }
            (extended::FCLAMP, [_, low, high]) => self.ordered(out, Rule::Clamp, Op::FOrdGreaterThan, [*low, *high]),
            (extended::SCLAMP, [_, low, high]) => self.ordered(out, Rule::Clamp, Op::SGreaterThan, [*low, *high]),
            (extended::UCLAMP, [_, low, high]) => self.ordered(out, Rule::Clamp, Op::UGreaterThan, [*low, *high]),
            (extended::MATRIX_INVERSE, [matrix]) => {
                let Some(Type::Matrix { column, .. }) = self.module.get_type(self.module.type_of(*matrix)) else {
                    return Vec::new();
                };
                let Some(Type::Vector { of, .. }) = self.module.get_type(column) else { return Vec::new() };
                let determinant = self.extend(out, of, extended::DETERMINANT, &[*matrix]);
                let broken = self.compare(out, Op::FOrdEqual, determinant, zero);
                vec![Suspect::new(Rule::Inverse, broken, &[determinant])]
            }
            _ => Vec::new(),
        }
    }

    fn extend(&mut self, out: &mut Vec<Instruction>, kind: Id, instruction: u32, operands: &[Id]) -> Id {
        let set = self.extended.unwrap_or_default();
        self.module.emit(out, Op::ExtInst, kind, &[&[set, instruction], operands].concat())
    }

    fn both(&mut self, out: &mut Vec<Instruction>, rule: Rule, [a, b]: [Id; 2], operands: &[Id]) -> Vec<Suspect> {
        let kind = self.module.type_of(a);
        let broken = self.module.emit(out, Op::LogicalAnd, kind, &[a, b]);
        vec![Suspect::new(rule, broken, operands)]
    }

    /// The rule is broken where `op` holds for two limits.
    fn ordered(&mut self, out: &mut Vec<Instruction>, rule: Rule, op: Op, limits: [Id; 2]) -> Vec<Suspect> {
        let [low, high] = limits.map(|limit| self.module.defined(Op::Constant, limit).map(|words| words[3]));
        if low.zip(high).is_some_and(|(low, high)| !holds(op, low, high)) {
            return Vec::new();
        }
        let bools = self.bools(limits[0]);
        let broken = self.module.emit(out, op, bools, &limits);
        vec![Suspect::new(rule, broken, &limits)]
    }
}

/// Whether a comparison holds for the bits of two numbers.
fn holds(op: Op, a: u32, b: u32) -> bool {
    let (x, y) = (f32::from_bits(a), f32::from_bits(b));
    match op {
        Op::FOrdEqual => x == y,
        Op::FOrdLessThan => x < y,
        Op::FOrdLessThanEqual => x <= y,
        Op::FOrdGreaterThan => x > y,
        Op::FOrdGreaterThanEqual => x >= y,
        Op::IEqual => a == b,
        Op::UGreaterThan => a > b,
        Op::UGreaterThanEqual => a >= b,
        Op::SGreaterThan => a.cast_signed() > b.cast_signed(),
        // It is compared at run time.
        _ => true,
    }
}
