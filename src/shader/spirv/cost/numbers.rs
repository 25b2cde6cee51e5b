//! Values as 32-bit numbers: how many they have, and how they are taken apart and made again.

use crate::shader::spirv::module::{Id, Instruction, Module, Type};
use crate::shader::spirv::op::Op;

/// How many numbers a value of a type has. `None` if it is not made of numbers of 32 bits and bools, or of a length that is not known.
pub(super) fn count(module: &Module, kind: Id) -> Option<usize> {
    match module.get_type(kind)? {
        Type::Bool | Type::Int { bits: 32, .. } | Type::Float { bits: 32 } => Some(1),
        _ => parts(module, kind)?.iter().map(|part| count(module, *part)).sum(),
    }
}

/// The types of the parts of a composite.
fn parts(module: &Module, kind: Id) -> Option<Vec<Id>> {
    Some(match module.get_type(kind)? {
        Type::Vector { of, count } | Type::Matrix { column: of, count } => vec![of; count as usize],
        Type::Array { of, length } => vec![of; module.number(length).filter(|length| *length <= 1024)? as usize],
        Type::Struct { members } => members.to_vec(),
        _ => return None,
    })
}

/// Takes a value apart: appends its numbers as `uint` to `bits`.
pub(super) fn split(module: &mut Module, out: &mut Vec<Instruction>, value: Id, bits: &mut Vec<Id>) {
    let kind = module.type_of(value);
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    if let Some(parts) = parts(module, kind) {
        for (at, part) in (0..).zip(parts) {
            let part = module.emit(out, Op::CompositeExtract, part, &[value, at]);
            split(module, out, part, bits);
        }
        return;
    }
    bits.push(match module.get_type(kind) {
        Some(Type::Bool) => {
            let [one, zero] = [1, 0].map(|number| module.constant(uint, number));
            module.emit(out, Op::Select, uint, &[value, one, zero])
        }
        Some(Type::Int { signed: false, .. }) => value,
        _ => module.emit(out, Op::Bitcast, uint, &[value]),
    });
}

/// Makes a value of a type from its numbers, which it takes from the front of `bits`.
pub(super) fn join(
    module: &mut Module,
    out: &mut Vec<Instruction>,
    kind: Id,
    bits: &mut impl Iterator<Item = Id>,
) -> Id {
    if let Some(parts) = parts(module, kind) {
        let parts: Vec<Id> = parts.into_iter().map(|part| join(module, out, part, bits)).collect();
        return module.emit(out, Op::CompositeConstruct, kind, &parts);
    }
    let uint = module.declare(Op::TypeInt, &[32, 0]);
    let zero = module.constant(uint, 0);
    let number = bits.next().unwrap_or(zero);
    match module.get_type(kind) {
        Some(Type::Bool) => module.emit(out, Op::INotEqual, kind, &[number, zero]),
        Some(Type::Int { signed: false, .. }) => number,
        _ => module.emit(out, Op::Bitcast, kind, &[number]),
    }
}
