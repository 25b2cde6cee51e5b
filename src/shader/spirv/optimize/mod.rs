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
//! The optimizer knows the instructions that glslang emits for Vulkan (`operands.rs`). A module with any other
//! instruction goes to the driver unchanged (those of task and mesh stages do), as does one with separate samplers or a
//! `debugPrintfEXT`.

mod dead;
mod graph;
mod inline;
mod module;
mod promote;
mod simplify;
mod tidy;
mod variables;
mod write;

use foldhash::{HashSet, HashSetExt};
use module::Module;

use super::specialize::control_flow::Function;

/// The instructions that inlining may make of a module: more would take longer than they save.
const MOST_INSTRUCTIONS: usize = 150_000;

/// Optimizes a module with one entry point. Returns words with instructions that are unknown here as they are.
pub fn optimize(words: Vec<u32>) -> Vec<u32> {
    optimized(&words).unwrap_or(words)
}

/// `None` if the module has unknown instructions, or grows too much.
fn optimized(words: &[u32]) -> Option<Vec<u32>> {
    let mut module = Module::parse(words)?;
    for function in &mut module.functions {
        // Unreachable blocks still lead to others, whose phis would lack them.
        function.drop_unreached(&mut HashSet::new());
        // A switch that a constant decided would keep a function from being inlined.
        tidy::tidy(function);
    }
    inline::inline_calls(&mut module)?;
    let mut functions = std::mem::take(&mut module.functions);
    let is_whole = functions.len() == 1;
    for function in &mut functions {
        reduce(&mut module, function, is_whole);
    }
    module.functions = functions;
    Some(module.write())
}

/// Reduces a function to what it computes, with `with_private` also the private variables of the module.
fn reduce(module: &mut Module, function: &mut Function, with_private: bool) {
    tidy::tidy(function);
    promote::promote(module, function, with_private);
    simplify::simplify(module, function);
    // Values of parameters decide branches.
    tidy::fold(module, function);
    tidy::drop_single_phis(module, function);
    dead::drop_unused(module, function);
    tidy::tidy(function);
}

#[cfg(test)]
mod tests;
