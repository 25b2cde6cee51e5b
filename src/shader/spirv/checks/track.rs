//! Counts at run time which parts of variables are set, where that is not certain: see `unset.rs`.

use std::collections::BTreeSet;

use foldhash::HashMap;

use super::suspect::Suspect;
use super::unset::{Act, OutParameters, Unset};
use super::{Checker, Rule};
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
    acts: HashMap<(usize, usize), Vec<Act>>,
    names: HashMap<Id, String>,
    /// The variables with the bits of each variable.
    bits: HashMap<Id, Id>,
    /// The variables with bits that the function declares itself.
    own: Vec<Id>,
    /// Those of its `out` parameters.
    cleared: Vec<Id>,
    /// Those of all `out` parameters.
    outs: HashMap<(Id, usize), Id>,
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

impl Checker<'_> {
    /// The suspects of an instruction that reads variables.
    pub(super) fn unset(&mut self, out: &mut Vec<Instruction>, place: (usize, usize)) -> Vec<Suspect> {
        let acts = self.tracked.acts.get(&place).cloned().unwrap_or_default();
        let reads = acts.into_iter().filter_map(|act| match act {
            Act::Reads(id, parts) => Some((id, parts, *self.tracked.bits.get(&id)?)),
            _ => None,
        });
        let reads: Vec<(Id, u32, Id)> = reads.collect();
        let mut found = Vec::new();
        for (id, parts, bits) in reads {
            let bool = self.module.declare(Op::TypeBool, &[]);
            let parts = self.module.constant(self.uint, parts);
            let now = self.module.emit(out, Op::Load, self.uint, &[bits]);
            let set = self.module.emit(out, Op::BitwiseAnd, self.uint, &[now, parts]);
            let broken = self.module.emit(out, Op::INotEqual, bool, &[set, parts]);
            let name = self.tracked.names.get(&id).cloned().unwrap_or_default();
            found.push(Suspect { name, ..Suspect::new(Rule::Unset, broken, &[]) });
        }
        found
    }

    /// Notes what an instruction has set.
    pub(super) fn note_sets(&mut self, out: &mut Vec<Instruction>, place: (usize, usize)) {
        for act in self.tracked.acts.get(&place).cloned().unwrap_or_default() {
            let (id, parts) = match act {
                Act::Sets(id, parts) => (id, Ok(parts)),
                Act::Takes(id, parameter) => (id, Err(parameter)),
                Act::Reads(..) => continue,
            };
            let Some(bits) = self.tracked.bits.get(&id).copied() else { continue };
            let now = match parts {
                Ok(parts) => {
                    let parts = self.module.constant(self.uint, parts);
                    let before = self.module.emit(out, Op::Load, self.uint, &[bits]);
                    self.module.emit(out, Op::BitwiseOr, self.uint, &[before, parts])
                }
                Err(parameter) => {
                    let Some(of) = self.tracked.outs.get(&parameter).copied() else { continue };
                    self.module.emit(out, Op::Load, self.uint, &[of])
                }
            };
            out.push(self.module.make(Op::Store, &[bits, now]));
        }
    }
}
