//! Checks that variables are set where they are read: see `track.rs`.

use super::suspect::Suspect;
use super::unset::Act;
use super::{Checker, Rule};
use crate::shader::spirv::module::{Id, Instruction};
use crate::shader::spirv::op::Op;

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
