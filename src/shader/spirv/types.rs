//! The types that a module declares (SPIR-V specification, section 3.52.6).

use super::opcode as op;

type Id = u32;

/// A declared type.
#[derive(Clone, Debug)]
pub(super) enum Type {
    Bool,
    Int { bits: u32, signed: bool },
    Float { bits: u32 },
    Vector { of: Id, count: u32 },
    Matrix { column: Id, count: u32 },
    Image { sampled: Id, dim: u32, depth: bool, arrayed: bool, multi: bool, storage: bool, format: u32 },
    Sampler,
    SampledImage { image: Id },
    Array { of: Id, length: Id },
    RuntimeArray { of: Id },
    Struct { members: Vec<Id> },
    Pointer { to: Id },
}

/// The type that an instruction declares, or `Some(None)` if it declares none; `None` if operands are missing.
pub(super) fn type_of(opcode: u32, operands: &[u32]) -> Option<Option<Type>> {
    let at = |index: usize| operands.get(index).copied();
    Some(Some(match opcode {
        op::TYPE_BOOL => Type::Bool,
        op::TYPE_INT => Type::Int { bits: at(1)?, signed: at(2)? != 0 },
        op::TYPE_FLOAT => Type::Float { bits: at(1)? },
        op::TYPE_VECTOR => Type::Vector { of: at(1)?, count: at(2)? },
        op::TYPE_MATRIX => Type::Matrix { column: at(1)?, count: at(2)? },
        op::TYPE_IMAGE => {
            let (depth, arrayed, multi) = (at(3)? == 1, at(4)? != 0, at(5)? != 0);
            Type::Image { sampled: at(1)?, dim: at(2)?, depth, arrayed, multi, storage: at(6)? == 2, format: at(7)? }
        }
        op::TYPE_SAMPLER => Type::Sampler,
        op::TYPE_SAMPLED_IMAGE => Type::SampledImage { image: at(1)? },
        op::TYPE_ARRAY => Type::Array { of: at(1)?, length: at(2)? },
        op::TYPE_RUNTIME_ARRAY => Type::RuntimeArray { of: at(1)? },
        op::TYPE_STRUCT => Type::Struct { members: operands.get(1..)?.to_vec() },
        op::TYPE_POINTER => Type::Pointer { to: at(2)? },
        _ => return Some(None),
    }))
}
