//! Optimizes a specialized module before the driver sees it: functions are inlined, local variables become values, and what is
//! computed twice or never used goes.
//!
//! A driver does the same, but the time it takes follows the words and the memory traffic that it is given: on NVIDIA, half of
//! the time of a pipeline goes into what glslang leaves undone. SPIRV-Tools' optimizer needs as much time as it saves. This one
//! does only what pays: it keeps the structure of control flow, moves no code, and does no arithmetic on floats.
//!
//! Of the picture's module a fifth remains, and its pipeline takes half the time. The passes: `inline.rs`; local
//! variables become values in `variables.rs` and `promote.rs`; `simplify.rs` replaces what is known or was computed
//! before; `dead.rs` drops what is unused, and `tidy.rs` the control flow around it. A function that returns early
//! becomes a switch with one case, which each return leaves by a break; one that returns from a loop stays a function.
//! A variable stays in memory if an unknown index reaches into it.
//!
//! The optimizer knows the instructions that glslang emits for Vulkan (`op.rs`). A module with any other
//! instruction goes to the driver unchanged (those of task and mesh stages do), as does one with separate samplers or a
//! `debugPrintfEXT`.

mod dead;
mod graph;
mod inline;
mod optimizer;
mod promote;
mod simplify;
mod tidy;
mod variables;
mod write;

use foldhash::{HashSet, HashSetExt};

use super::fold::drop_unreached;
use super::module::{Function, Module};
use optimizer::Optimizer;

/// Optimizes a module with one entry point. Returns words with instructions that are unknown here as they are.
pub fn optimize(words: Vec<u32>) -> Vec<u32> {
    Module::parse(&words).and_then(optimized).map_or(words, |module| module.write())
}

/// `None` if the module has unknown instructions, or grows too much.
pub(super) fn optimized(module: Module) -> Option<Module> {
    let mut optimizer = Optimizer::new(module)?;
    let mut functions = std::mem::take(&mut optimizer.module.functions);
    for function in &mut functions {
        // Unreachable blocks still lead to others, whose phis would lack them.
        drop_unreached(&mut optimizer.module, function, &mut HashSet::new());
        // A switch that a constant decided would keep a function from being inlined.
        tidy::tidy(&mut optimizer.module, function);
    }
    optimizer.module.functions = functions;
    inline::inline_calls(&mut optimizer)?;
    let mut functions = std::mem::take(&mut optimizer.module.functions);
    let is_whole = functions.len() == 1;
    for function in &mut functions {
        reduce(&mut optimizer, function, is_whole);
    }
    optimizer.module.functions = functions;
    Some(optimizer.finish())
}

/// Reduces a function to what it computes, with `with_private` also the private variables of the module.
fn reduce(optimizer: &mut Optimizer, function: &mut Function, with_private: bool) {
    tidy::tidy(&mut optimizer.module, function);
    promote::promote(optimizer, function, with_private);
    simplify::simplify(optimizer, function);
    // Values of parameters decide branches.
    tidy::fold(optimizer, function);
    tidy::drop_single_phis(optimizer, function);
    loop {
        dead::drop_unused(optimizer, function);
        // The condition of a selection without content is unused, too.
        if !tidy::tidy(&mut optimizer.module, function) {
            return;
        }
    }
}

#[cfg(test)]
mod tests;
