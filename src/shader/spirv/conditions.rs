//! Finds conditions that use a constant glslang computed in another function. glslang computes a global constant of
//! `&&` or `||` inside the first function that uses it; other functions then use an undefined id.

use std::collections::HashSet;

use super::opcode as op;

type Id = u32;

/// OpLogicalEqual to OpSelect, whose operands are all ids.
const OF_IDS: std::ops::RangeInclusive<u32> = 164..=169;

/// Ids that conditions in these functions use, but that neither the same function nor `globals` define.
pub fn missing_in_conditions(functions: &[u32], globals: &HashSet<Id>) -> Vec<Id> {
    let (mut known, mut used, mut missing) = (HashSet::<Id>::new(), Vec::<Id>::new(), Vec::new());
    let mut rest = functions;
    while let Some(first) = rest.first() {
        let (opcode, length) = (first & 0xffff, (first >> 16) as usize);
        let Some(operands) = rest.get(1..length) else { break };
        match opcode {
            op::FUNCTION_END => {
                missing.extend(used.drain(..).filter(|id| !known.contains(id) && !globals.contains(id)));
                known.clear();
            }
            op::BRANCH_CONDITIONAL => used.extend(operands.first()),
            opcode if OF_IDS.contains(&opcode) => used.extend(operands.get(2..).unwrap_or_default()),
            _ => {}
        }
        if !op::WITHOUT_RESULT.contains(&opcode) {
            known.extend(operands.get(1));
        }
        rest = &rest[length..];
    }
    missing
}
