//! Writes a module with the globals that are left in use.

use super::module::{BOUND, BUILT_IN, Module, PRIVATE, WORKGROUP_SIZE, typed_result};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::is_id;
use crate::shader::spirv::specialize::{Id, Instruction, instruction, opcode};

/// Place of an entry point's name, before its interface.
const NAME: usize = 3;

impl Module {
    /// The module with the globals that its functions use.
    pub(super) fn write(mut self) -> Vec<u32> {
        let mut functions = std::mem::take(&mut self.functions);
        for i in functions.iter_mut().flat_map(|f| &mut f.blocks).flat_map(|b| &mut b.body) {
            self.resolve_operands(i);
        }
        let mut used = vec![false; self.result_types.len()];
        let mark = |used: &mut [bool], i: &[u32]| {
            for at in (1..i.len()).filter(|at| is_id(i, *at) == Some(true)) {
                used[i[at] as usize] = true;
            }
        };
        let mut locals = Vec::new();
        for i in functions.iter().flat_map(|f| f.head.iter().chain(f.blocks.iter().flat_map(|b| &b.body))) {
            mark(&mut used, i);
            if let Some((_, id)) = typed_result(i) {
                locals.extend(self.decorations.remove(&id).into_iter().flatten());
            }
        }
        let defined = |i: &Instruction| match opcode(i) {
            op::EXT_INST_IMPORT | op::TYPE_VOID..=op::TYPE_FUNCTION => Some(i[1]),
            op::UNDEF | op::CONSTANT_TRUE..=op::SPEC_CONSTANT_OP | op::VARIABLE => Some(i[2]),
            _ => None,
        };
        let all: Vec<Instruction> = std::mem::take(&mut self.globals).into_iter().chain(self.more).collect();
        // A forward pointer is used before it is defined.
        let forward: Vec<Id> = all.iter().filter(|i| opcode(i) == op::TYPE_FORWARD_POINTER).map(|i| i[1]).collect();
        forward.iter().for_each(|id| used[*id as usize] = true);
        let sizes = all.iter().filter(|i| opcode(i) == op::DECORATE && i[2..] == [BUILT_IN, WORKGROUP_SIZE]);
        sizes.for_each(|i| used[i[1] as usize] = true);
        // From the last definition to the first, since each comes before its uses. Variables of the interface stay.
        for i in all.iter().rev() {
            let is_kept = match (opcode(i), defined(i)) {
                (op::VARIABLE, Some(id)) => i[3] != PRIVATE || used[id as usize],
                (_, Some(id)) => used[id as usize],
                (op::EXECUTION_MODE, _) => true,
                _ => false,
            };
            if is_kept {
                mark(&mut used, i);
                if let Some(id) = defined(i) {
                    used[id as usize] = true;
                }
            }
        }
        let mut out = self.header;
        out[BOUND] = self.result_types.len() as u32;
        let is_annotation = |i: &Instruction| defined(i).is_none() && opcode(i) != op::TYPE_FORWARD_POINTER;
        for i in all.iter().filter(|i| is_annotation(i) || opcode(i) == op::EXT_INST_IMPORT) {
            match opcode(i) {
                op::ENTRY_POINT => out.extend(entry_point(i, &used)),
                op::DECORATE | op::MEMBER_DECORATE if !used[i[1] as usize] => {}
                _ => out.extend(i),
            }
        }
        out.extend(locals.iter().flatten());
        let is_definition = |i: &&Instruction| !is_annotation(i) && opcode(i) != op::EXT_INST_IMPORT;
        for i in all.iter().filter(is_definition) {
            if defined(i).is_none_or(|id| used[id as usize]) {
                out.extend(i);
            }
        }
        functions.iter().for_each(|function| function.write(&mut out));
        out
    }
}

/// The entry point with the variables of its interface that are left.
fn entry_point(i: &[u32], used: &[bool]) -> Instruction {
    let ends = |word: &u32| word.to_le_bytes().contains(&0);
    let name = i[NAME..].iter().position(ends).map_or(i.len(), |end| NAME + end + 1);
    let kept = i[name..].iter().filter(|id| used[**id as usize]);
    instruction(op::ENTRY_POINT, &i[1..name].iter().chain(kept).copied().collect::<Vec<_>>())
}
