//! Counts at run time which parts of variables are set, where that is not certain: see `unset.rs`.

use std::collections::BTreeSet;

use foldhash::HashMap;

use super::unset::{Act, OutParameters, Unset};
use crate::shader::spirv::enums::storage;
use crate::shader::spirv::module::{Function, Id, Instruction, Module};
use crate::shader::spirv::op::Op;

/// The variables of all functions that may be read before they are set.
#[derive(Default)]
pub(super) struct Tracked {
    functions: HashMap<Id, Unset>,
    /// Variables with the bits of `out` parameters.
    outs: HashMap<(Id, usize), Id>,
}

/// The same of one function.
#[derive(Default)]
pub(super) struct TrackedFunction {
    pub(super) acts: HashMap<(usize, usize), Vec<Act>>,
    pub(super) names: HashMap<Id, String>,
    /// The variables with the bits of each variable.
    pub(super) bits: HashMap<Id, Id>,
    /// The variables with bits that the function declares itself.
    own: Vec<Id>,
    /// Those of its `out` parameters.
    cleared: Vec<Id>,
    /// Those of all `out` parameters.
    pub(super) outs: HashMap<(Id, usize), Id>,
}

impl Tracked {
    /// `order`: the places of the functions, callees before their callers.
    pub(super) fn of(module: &mut Module, functions: &[Function], order: &[usize], silent: &BTreeSet<Id>) -> Self {
        let mut known = OutParameters::new(module, functions);
        let wanted = order.iter().map(|place| &functions[*place]).filter(|of| !silent.contains(&of.id));
        let found: Vec<(Id, Unset)> = wanted.map(|of| (of.id, Unset::of(module, of, &mut known))).collect();
        let mut open: Vec<(Id, usize)> = known.open.into_iter().collect();
        open.sort_unstable();
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let pointer = module.declare(Op::TypePointer, &[storage::PRIVATE, uint]);
        let outs: HashMap<(Id, usize), Id> =
            open.into_iter().map(|of| (of, module.variable(pointer, storage::PRIVATE))).collect();
        let mut all: Vec<Id> = outs.values().copied().collect();
        all.sort_unstable();
        module.join_interface(&all);
        Self { functions: found.into_iter().collect(), outs }
    }

    /// The variables of a function, with new ids for their bits.
    pub(super) fn take(&mut self, module: &mut Module, function: Id) -> TrackedFunction {
        let Some(unset) = self.functions.remove(&function) else { return TrackedFunction::default() };
        let Unset { acts, names, outs } = unset;
        let (mut bits, mut cleared): (HashMap<Id, Id>, Vec<Id>) = Default::default();
        for (id, at) in outs {
            let of = self.outs[&(function, at)];
            bits.insert(id, of);
            cleared.push(of);
        }
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let pointer = module.declare(Op::TypePointer, &[storage::FUNCTION, uint]);
        let mut others: Vec<Id> = names.keys().filter(|id| !bits.contains_key(id)).copied().collect();
        others.sort_unstable();
        let own: Vec<Id> = others.iter().map(|_| module.fresh(pointer)).collect();
        bits.extend(others.into_iter().zip(own.iter().copied()));
        TrackedFunction { acts, names, bits, own, cleared, outs: self.outs.clone() }
    }
}

impl TrackedFunction {
    /// Declares the variables with bits in their function, where they begin as 0.
    pub(super) fn declare(self, module: &mut Module, function: &mut Function) {
        let Some(first) = function.blocks.first_mut().filter(|_| !self.bits.is_empty()) else { return };
        let uint = module.declare(Op::TypeInt, &[32, 0]);
        let pointer = module.declare(Op::TypePointer, &[storage::FUNCTION, uint]);
        let zero = module.constant(uint, 0);
        let start = first.body.iter().position(|i| i.op != Op::Variable).unwrap_or(first.body.len());
        let declared = self.own.iter().map(|id| module.make(Op::Variable, &[pointer, *id, storage::FUNCTION]));
        let mut added: Vec<Instruction> = declared.collect();
        // A function may be called again.
        added.extend(self.own.iter().chain(&self.cleared).map(|id| module.make(Op::Store, &[*id, zero])));
        first.body.splice(start..start, added);
    }
}
