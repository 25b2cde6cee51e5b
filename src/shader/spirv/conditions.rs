//! Finds conditions that use a constant glslang computed in another function. glslang computes a global constant of
//! `&&` or `||` inside the first function that uses it; other functions then use an undefined id.

use super::module::{Id, Module};
use super::op::{Class, Op};

/// The ids that conditions use, but that neither the same function nor a constant defines.
pub fn without_value(module: &Module) -> Vec<Id> {
    // The functions that define ids, by their places; 0 stands for constants.
    let mut owners = vec![None; module.bound() as usize];
    let mut own = |id: Id, place: usize| owners[id as usize] = Some(place);
    module.globals.iter().filter(|i| i.op.class() == Class::Constant).for_each(|i| own(module[*i][2], 0));
    for (place, function) in (1..).zip(&module.functions) {
        function.results(module).for_each(|id| own(id, place));
    }
    let mut missing = Vec::new();
    let mut check = |ids: &[Id], place: usize| {
        let is_missing =
            |id: &&Id| !owners.get(**id as usize).is_some_and(|owner| *owner == Some(0) || *owner == Some(place));
        missing.extend(ids.iter().filter(is_missing));
    };
    for i in module.globals.iter().filter(|i| i.op == Op::SpecConstantOp) {
        let words = &module[*i];
        if is_condition(Op::of(words[3])) || is_comparison(Op::of(words[3])) {
            check(&words[4..], 0);
        }
    }
    for (place, function) in (1..).zip(&module.functions) {
        for i in function.body() {
            match i.op {
                Op::BranchConditional => check(&module[i][1..2], place),
                op if is_condition(op) => check(&module[i][3..], place),
                _ => {}
            }
        }
    }
    missing
}

/// Operations on booleans, and the choice between two values by one.
fn is_condition(op: Op) -> bool {
    use Op::{LogicalAnd, LogicalEqual, LogicalNot, LogicalNotEqual, LogicalOr, Select};
    matches!(op, LogicalEqual | LogicalNotEqual | LogicalOr | LogicalAnd | LogicalNot | Select)
}

/// Comparisons of integers.
fn is_comparison(op: Op) -> bool {
    (Op::IEqual..=Op::SLessThanEqual).contains(&op)
}
