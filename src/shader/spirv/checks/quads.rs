//! Instructions that ask which invocations of a quad run along.

use crate::shader::spirv::module::{Id, Module};
use crate::shader::spirv::op::Op;

/// The capability of queries of images.
const IMAGE_QUERY: u32 = 50;

/// The identifiers of a module for quads, and the number of checked derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quads {
    /// The function that asks for missing invocations, and the array that keeps them.
    pub(super) names: Option<(Id, Id)>,
    pub(super) count: usize,
}

impl Quads {
    /// Those with these names in a module, which gets the capability to ask for levels; nothing is checked if its text lacks the names.
    pub(super) fn of(module: &mut Module, [gone, quads]: [&str; 2]) -> Self {
        let function = module.named(&format!("{gone}(")).next();
        let quads = module.named(&format!("{quads}\0")).next();
        let names = function.zip(quads);
        let has = module.head.iter().any(|i| i.op == Op::Capability && module[*i][1] == IMAGE_QUERY);
        if names.is_some() && !has {
            let capability = module.make(Op::Capability, &[IMAGE_QUERY]);
            module.head.insert(0, capability);
        }
        Self { names, count: 0 }
    }
}
