//! The types that a module declares (SPIR-V specification, section 3.52.6).

use super::instruction::Id;
use super::words::Module;
use crate::shader::spirv::op::Op;

/// A declared type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Type<'a> {
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
    Struct { members: &'a [Id] },
    Pointer { class: u32, to: Id },
}

impl Module {
    /// The type with this id.
    pub fn get_type(&self, id: Id) -> Option<Type<'_>> {
        let i = self.definition(id)?;
        Some(match (i.op, &self[i][2..]) {
            (Op::TypeBool, _) => Type::Bool,
            (Op::TypeInt, [bits, signed, ..]) => Type::Int { bits: *bits, signed: *signed != 0 },
            (Op::TypeFloat, [bits, ..]) => Type::Float { bits: *bits },
            (Op::TypeVector, [of, count, ..]) => Type::Vector { of: *of, count: *count },
            (Op::TypeMatrix, [column, count, ..]) => Type::Matrix { column: *column, count: *count },
            (Op::TypeImage, [sampled, dim, depth, arrayed, multi, access, format, ..]) => Type::Image {
                sampled: *sampled,
                dim: *dim,
                depth: *depth == 1,
                arrayed: *arrayed != 0,
                multi: *multi != 0,
                storage: *access == 2,
                format: *format,
            },
            (Op::TypeSampler, _) => Type::Sampler,
            (Op::TypeSampledImage, [image, ..]) => Type::SampledImage { image: *image },
            (Op::TypeArray, [of, length, ..]) => Type::Array { of: *of, length: *length },
            (Op::TypeRuntimeArray, [of, ..]) => Type::RuntimeArray { of: *of },
            (Op::TypeStruct, members) => Type::Struct { members },
            (Op::TypePointer, [class, to, ..]) => Type::Pointer { class: *class, to: *to },
            _ => return None,
        })
    }

    /// The storage class of a pointer type, and the type that it points to.
    pub fn pointer(&self, id: Id) -> Option<(u32, Id)> {
        match self.get_type(id)? {
            Type::Pointer { class, to } => Some((class, to)),
            _ => None,
        }
    }
}
