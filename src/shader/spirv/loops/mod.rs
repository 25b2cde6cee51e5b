//! Bounds the loops of a module: every invocation counts the rounds of all loops whose end is not plain to see, and
//! leaves them when its budget is used up. On a GPU an endless loop would hang the device, and the process with it.
//!
//! The counter is a private variable, so nested loops and loops in functions share the budget. A loop that takes a
//! small constant number of rounds is left as it is, and so is a module that has no other. When the budget runs out,
//! the invocation names the loop in a storage buffer before it ends.

mod place;
mod plan;
mod rewrite;
mod rounds;

pub use place::{Overrun, Place};

use super::opcode as op;
use super::specialize::{instructions, opcode};
use rewrite::Module;

/// How a module's loops are bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Rounds that an invocation may take in all of its bounded loops together.
    pub rounds: u32,
    /// The same once an invocation has used up its budget, so that one endless loop does not cost the whole budget in
    /// every pixel.
    pub rounds_after: u32,
    /// Descriptor set and binding of the buffer that names the loop: see [`Overrun`]. `None` if the stage cannot write
    /// buffers.
    pub report: Option<(u32, u32)>,
    /// Color of a fragment whose loops were cut short.
    pub mark: Option<[f32; 4]>,
}

/// Bounds the loops of `specialized`, a specialization of the module `original`. Returns whether the module has a loop
/// that needs it; otherwise, and for words that are not valid SPIR-V, the module stays as it is.
pub fn bound(specialized: &mut Vec<u32>, original: &[u32], bounds: &Bounds) -> bool {
    // Most specialized modules have no loop at all.
    let has_loops = instructions(specialized).is_some_and(|all| all.iter().any(|i| opcode(i) == op::LOOP_MERGE));
    let module = has_loops.then(|| Module::parse(specialized)).flatten();
    let rewritten = module.and_then(|mut module| module.bound(original, bounds));
    let is_bounded = rewritten.is_some();
    if let Some(words) = rewritten {
        *specialized = words;
    }
    is_bounded
}

#[cfg(test)]
mod tests;
