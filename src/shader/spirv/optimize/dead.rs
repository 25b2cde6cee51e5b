//! Drops instructions whose results nothing uses.

use foldhash::{HashMap, HashMapExt};

use super::optimizer::Optimizer;
use crate::shader::spirv::enums::extended::{FREXP, MODF};
use crate::shader::spirv::module::{Function, Id, Instruction, Module};
use crate::shader::spirv::op::{Class, Op};

/// Whether an instruction does something besides giving a value.
fn has_effect(module: &Module, i: Instruction) -> bool {
    match i.op {
        Op::FunctionCall => true,
        // They write through a pointer.
        Op::ExtInst => matches!(module[i][4], MODF | FREXP),
        op => !op.has_type() || (op.class() == Class::Synchronization && op != Op::AtomicLoad),
    }
}

pub(super) fn drop_unused(optimizer: &mut Optimizer, function: &mut Function) {
    let mut defined: HashMap<Id, (usize, usize)> = HashMap::new();
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (block, within) in function.blocks.iter().enumerate() {
        for (place, &i) in within.body.iter().enumerate() {
            optimizer.resolve_operands(i);
            if has_effect(&optimizer.module, i) {
                open.push((block, place));
            }
            defined.extend(optimizer.module.result(i).map(|id| (id, (block, place))));
        }
    }
    let mut is_used: Vec<Vec<bool>> = function.blocks.iter().map(|block| vec![false; block.body.len()]).collect();
    open.iter().for_each(|(block, place)| is_used[*block][*place] = true);
    while let Some((block, place)) = open.pop() {
        for id in optimizer.module.ids_of(function.blocks[block].body[place]) {
            if let Some(&(block, place)) = defined.get(&id)
                && !std::mem::replace(&mut is_used[block][place], true)
            {
                open.push((block, place));
            }
        }
    }
    for (block, is_used) in function.blocks.iter_mut().zip(is_used) {
        let mut is_used = is_used.into_iter();
        block.body.retain(|_| is_used.next().unwrap_or(true));
    }
}
