//! The capabilities that a linked module declares.

use std::collections::BTreeSet;

use crate::shader::spirv::opcode as op;
use crate::shader::spirv::specialize::opcode;

const GEOMETRY: u32 = 2;
const GEOMETRY_MODEL: u32 = 3;
const FRAGMENT_MODEL: u32 = 4;
const SAMPLE_RATE_SHADING: u32 = 35;
const IMAGE_QUERY: u32 = 50;
const DERIVATIVE_CONTROL: u32 = 51;
const INTERPOLATION_FUNCTION: u32 = 52;
/// The capabilities that depend on the code of functions, and that [`needed`] finds in the linked module.
const KNOWN: [u32; 5] = [GEOMETRY, SAMPLE_RATE_SHADING, IMAGE_QUERY, DERIVATIVE_CONTROL, INTERPOLATION_FUNCTION];

/// The decoration of built-in variables, and its values.
const BUILT_IN: u32 = 11;
const PRIMITIVE_ID: u32 = 7;
const SAMPLE_ID: u32 = 18;
const SAMPLE_POSITION: u32 = 19;

/// The capability of [`KNOWN`] that an instruction needs.
fn needed(i: &[u32]) -> Option<u32> {
    match (opcode(i), i) {
        (op::DECORATE, [_, _, BUILT_IN, PRIMITIVE_ID]) => Some(GEOMETRY),
        (op::DECORATE, [_, _, BUILT_IN, SAMPLE_ID | SAMPLE_POSITION]) => Some(SAMPLE_RATE_SHADING),
        // Sizes, levels and samples of images
        (103..=107, _) => Some(IMAGE_QUERY),
        // Fine and coarse derivatives
        (210..=215, _) => Some(DERIVATIVE_CONTROL),
        // InterpolateAtCentroid, InterpolateAtSample, InterpolateAtOffset
        (op::EXT_INST, [_, _, _, _, 76..=78, ..]) => Some(INTERPOLATION_FUNCTION),
        _ => None,
    }
}

/// The capabilities of a linked module. `model`: its execution model. `a`, `b`: the capabilities of its two sources.
/// `instructions`: its decorations and functions. `None` if only glslang can tell.
pub fn capabilities<'a>(
    model: u32,
    a: &[u32],
    b: &[u32],
    instructions: impl Iterator<Item = &'a [u32]>,
) -> Option<Vec<u32>> {
    let others = |list: &[u32]| list.iter().copied().filter(|c| !KNOWN.contains(c)).collect::<BTreeSet<u32>>();
    let mut all = others(a);
    if all != others(b) {
        return None;
    }
    // Other stages than the fragment stage have gl_PrimitiveID anyway.
    let is_needed = |capability: &u32| *capability != GEOMETRY || model == FRAGMENT_MODEL;
    all.extend(instructions.filter_map(needed).filter(is_needed));
    all.extend((model == GEOMETRY_MODEL).then_some(GEOMETRY));
    // glslang orders them by number, too.
    Some(all.into_iter().collect())
}
