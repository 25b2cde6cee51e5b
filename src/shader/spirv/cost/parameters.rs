//! The parameters of functions.

use crate::shader::spirv::module::{Function, Id, Module};
use crate::shader::spirv::op::Op;

/// The parameters of a function.
pub(super) fn parameters(module: &Module, function: &Function) -> impl Iterator<Item = Id> {
    function.head.iter().filter(|i| i.op == Op::FunctionParameter).map(|i| module[*i][2])
}

/// The type of a value, or that to which a pointer points.
pub(super) fn value_type(module: &Module, kind: Id) -> Id {
    module.pointer(kind).map_or(kind, |(_, to)| to)
}
