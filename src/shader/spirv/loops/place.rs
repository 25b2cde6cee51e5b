//! Names of loops: which loop of a module's source ran out of rounds.

use xxhash_rust::xxh3::xxh3_64;

use super::rounds::{self, Loop};
use crate::shader::spirv::module::{Id, Module};
use crate::shader::spirv::op::Op;
use crate::shader::spirv::reach::file_of;

/// The first two of the three words that a bounded module writes to its buffer; both are 0 at first. The third is 1 at
/// first, and 0 once an invocation has used up its budget. (Mesa's lavapipe reads 0 for helper invocations, and would
/// wait for them.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrun {
    /// The loop that took at least half of an invocation's budget, as [`LoopPlace::find`] knows it; 0 if there is none.
    pub one: u32,
    /// A module whose loops used up a budget together; 0 if there is none.
    pub together: u32,
}

/// The loop that an [`Overrun`] names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopPlace {
    /// Number of the loop among the loops of its function before specialization; `None` if several loops used up the
    /// budget together.
    pub number: Option<usize>,
    /// glslang's name of its function, which has the types of the parameters: `f(vf3;`. Empty if it is unknown.
    pub function: String,
    /// Whether the loop ends after more rounds than it may take.
    pub is_finite: bool,
}

impl LoopPlace {
    /// Finds the loop in a module before specialization. `None` if the overrun is of another module.
    pub fn find(overrun: Overrun, words: &[u32]) -> Option<Self> {
        let seed = seed(words);
        if overrun.one == 0 {
            let is_module = overrun.together == name(seed, 0);
            return is_module.then(|| Self { number: None, function: String::new(), is_finite: false });
        }
        let module = Module::parse(words)?;
        module.functions.iter().find_map(|function| {
            let mut headers = function.blocks.iter().filter(|block| block.structure(&module).1.is_some());
            let number = headers.position(|block| overrun.one == name(seed, block.label))?;
            let found = rounds::find(&module, function);
            let is_it = |of: &&Loop| overrun.one == name(seed, function.blocks[of.header].label);
            let is_finite = found.iter().find(is_it).is_some_and(|of| of.is_finite);
            Some(Self { number: Some(number), function: module.name(function.id).unwrap_or_default(), is_finite })
        })
    }

    /// The function's name in GLSL.
    pub fn function_in_glsl(&self) -> &str {
        self.function.split('(').next().unwrap_or_default()
    }

    /// File and line of the loop, in a module of the same text that was compiled with debug information. An edit may
    /// have moved functions, so the loop is found by its function.
    pub fn line(&self, words: &[u32]) -> Option<(String, u32)> {
        let module = Module::parse(words)?;
        let function = module.functions.iter().find(|f| module.name(f.id).unwrap_or_default() == self.function)?;
        let all: Vec<_> = function.instructions().collect();
        let mut merges = all.iter().enumerate().filter(|(_, i)| i.op == Op::LoopMerge);
        let (at, _) = merges.nth(self.number?)?;
        let line = all[..at].iter().rev().find(|i| i.op == Op::Line)?;
        file_of(&module, &module[*line])
    }
}

/// Identifies a module before specialization.
pub(super) fn seed(words: &[u32]) -> u64 {
    xxh3_64(bytemuck::cast_slice(words))
}

/// The number by which a buffer names the loop with this header; 0 names the module.
pub(super) fn name(seed: u64, header: Id) -> u32 {
    let hash = xxh3_64(&(seed ^ u64::from(header)).to_le_bytes());
    (hash as u32).max(1)
}
