//! Drops instructions whose results nothing uses.

use foldhash::{HashMap, HashMapExt};

use super::module::{Module, typed_result};
use crate::shader::spirv::opcode as op;
use crate::shader::spirv::operands::is_id;
use crate::shader::spirv::specialize::control_flow::Function;
use crate::shader::spirv::specialize::{Id, opcode};

/// Whether an instruction does something besides giving a value.
fn has_effect(i: &[u32]) -> bool {
    match opcode(i) {
        op::FUNCTION_CALL | 229..=242 => true,
        // Modf and Frexp write through a pointer.
        op::EXT_INST => matches!(i[4], 35 | 51),
        _ => false,
    }
}

pub(super) fn drop_unused(module: &mut Module, function: &mut Function) {
    let mut defined: HashMap<Id, (usize, usize)> = HashMap::new();
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (block, within) in function.blocks.iter_mut().enumerate() {
        for (place, i) in within.body.iter_mut().enumerate() {
            module.resolve_operands(i);
            match typed_result(i) {
                Some((_, id)) => {
                    defined.insert(id, (block, place));
                    if has_effect(i) {
                        open.push((block, place));
                    }
                }
                None => open.push((block, place)),
            }
        }
    }
    let mut is_used: Vec<Vec<bool>> = function.blocks.iter().map(|block| vec![false; block.body.len()]).collect();
    open.iter().for_each(|(block, place)| is_used[*block][*place] = true);
    while let Some((block, place)) = open.pop() {
        let i = &function.blocks[block].body[place];
        for at in (1..i.len()).filter(|at| is_id(i, *at) == Some(true)) {
            if let Some(&(block, place)) = defined.get(&i[at])
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
