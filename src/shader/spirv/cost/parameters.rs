//! The parameters of functions.

use crate::shader::spirv::module::{Function, Id, Instruction, Module, Type};
use crate::shader::spirv::op::Op;

/// A part of a parameter that a function writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WrittenPart {
    /// The place of the parameter.
    pub(super) parameter: usize,
    /// The member of a struct; `None` for the whole value.
    pub(super) member: Option<u32>,
    /// Whether a caller gives the parameter a value.
    pub(super) is_given: bool,
}

impl WrittenPart {
    /// Its type, among those of the parameters.
    pub(super) fn kind(&self, module: &Module, parameters: &[Id]) -> Option<Id> {
        let kind = *parameters.get(self.parameter)?;
        match (self.member, module.get_type(kind)) {
            (None, _) => Some(kind),
            (Some(member), Some(Type::Struct { members })) => members.get(member as usize).copied(),
            _ => None,
        }
    }

    /// A pointer to it, among the parameters of its function.
    pub(super) fn pointer(&self, module: &mut Module, out: &mut Vec<Instruction>, parameters: &[Id]) -> Option<Id> {
        let parameter = *parameters.get(self.parameter)?;
        let Some(member) = self.member else { return Some(parameter) };
        let (class, of) = module.pointer(module.type_of(parameter))?;
        let Some(Type::Struct { members }) = module.get_type(of) else { return None };
        let kind = *members.get(member as usize)?;
        let pointer = module.declare(Op::TypePointer, &[class, kind]);
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let index = module.constant(uint, member);
        Some(module.emit(out, Op::AccessChain, pointer, &[parameter, index]))
    }
}

/// The parameters of a function.
pub(super) fn parameters(module: &Module, function: &Function) -> impl Iterator<Item = Id> {
    function.head.iter().filter(|i| i.op == Op::FunctionParameter).map(|i| module[*i][2])
}

/// The type of a value, or that to which a pointer points.
pub(super) fn value_type(module: &Module, kind: Id) -> Id {
    module.pointer(kind).map_or(kind, |(_, to)| to)
}
