//! The capabilities that a linked module declares.

use std::collections::BTreeSet;

use foldhash::HashSet;

use crate::shader::spirv::enums::built_in::{PRIMITIVE_ID, SAMPLE_ID, SAMPLE_POSITION};
use crate::shader::spirv::enums::decoration::BUILT_IN;
use crate::shader::spirv::enums::{extended, model};
use crate::shader::spirv::fold::drop_results;
use crate::shader::spirv::module::{Id, Instruction, Module};
use crate::shader::spirv::op::{Class, Op};

const GEOMETRY: u32 = 2;
const SAMPLE_RATE_SHADING: u32 = 35;
const IMAGE_QUERY: u32 = 50;
const DERIVATIVE_CONTROL: u32 = 51;
const INTERPOLATION_FUNCTION: u32 = 52;
/// The capabilities that depend on the code of functions, and that [`needed`] finds in the linked module.
const KNOWN: [u32; 5] = [GEOMETRY, SAMPLE_RATE_SHADING, IMAGE_QUERY, DERIVATIVE_CONTROL, INTERPOLATION_FUNCTION];

/// The capability of [`KNOWN`] that an instruction needs.
fn needed(module: &Module, i: Instruction) -> Option<u32> {
    match (i.op, &module[i]) {
        (Op::Decorate, [_, _, BUILT_IN, PRIMITIVE_ID]) => Some(GEOMETRY),
        (Op::Decorate, [_, _, BUILT_IN, SAMPLE_ID | SAMPLE_POSITION]) => Some(SAMPLE_RATE_SHADING),
        (op, _) if op.class() == Class::Query && op != Op::Image => Some(IMAGE_QUERY),
        // Fine and coarse derivatives
        (op, _) if (Op::DPdxFine..=Op::FwidthCoarse).contains(&op) => Some(DERIVATIVE_CONTROL),
        (Op::ExtInst, [_, _, _, _, extended::INTERPOLATE_AT_CENTROID..=extended::INTERPOLATE_AT_OFFSET, ..]) => {
            Some(INTERPOLATION_FUNCTION)
        }
        _ => None,
    }
}

fn declared(module: &Module) -> impl Iterator<Item = u32> {
    module.head.iter().filter(|i| i.op == Op::Capability).map(|i| module[*i][1])
}

/// Declares the capabilities of a linked module, whose parts come from it and from `base`. `None` if only glslang can tell.
pub fn declare(module: &mut Module, base: &Module) -> Option<()> {
    let others = |module: &Module| declared(module).filter(|c| !KNOWN.contains(c)).collect::<BTreeSet<u32>>();
    let mut all = others(base);
    if all != others(module) {
        return None;
    }
    drop_unused(module);
    let code = module.decorations.iter().copied().chain(module.code());
    // Other stages than the fragment stage have gl_PrimitiveID anyway.
    let is_needed = |capability: &u32| *capability != GEOMETRY || module.model() == Some(model::FRAGMENT);
    all.extend(code.filter_map(|i| needed(module, i)).filter(is_needed));
    all.extend((module.model() == Some(model::GEOMETRY)).then_some(GEOMETRY));
    // glslang orders them by number, too.
    let capabilities: Vec<Instruction> = all.into_iter().map(|c| module.make(Op::Capability, &[c])).collect();
    module.head.retain(|i| i.op != Op::Capability);
    module.head.splice(0..0, capabilities);
    Some(())
}

/// Takes out the built-in values of a capability that the thin module declares for functions that nothing calls.
fn drop_unused(module: &mut Module) {
    let used: HashSet<Id> = module.code().flat_map(|i| module.ids_of(i)).collect();
    let of_unused = |i: &Instruction| {
        (i.op == Op::Decorate && needed(module, *i).is_some()).then(|| module[*i][1]).filter(|id| !used.contains(id))
    };
    let unused: HashSet<Id> = module.decorations.iter().filter_map(of_unused).collect();
    if unused.is_empty() {
        return;
    }
    let mut globals = std::mem::take(&mut module.globals);
    globals.retain(|i| module.result(*i).is_none_or(|id| !unused.contains(&id)));
    module.globals = globals;
    drop_results(module, &unused);
    module.leave_interface(&unused);
}
