//! The last step before the driver: initial values, loops that end, copies for hits, optimization.

use super::draw_index::index_draws;
use super::hits::separate_hits;
use super::initial::initialize;
use super::loops::{self, Bounds};
use super::module::Module;
use super::optimize::optimized;

/// A module as the driver gets it.
#[derive(Debug)]
pub struct Finished {
    /// The words of the module.
    pub words: Vec<u32>,
    /// How many words it had before it was optimized.
    pub unoptimized: usize,
    /// Whether it has loops that count their rounds.
    pub is_bounded: bool,
}

/// Finishes a specialization of the module `original`. With `draws_by_index`, it reads its draw from a buffer. Words that are not SPIR-V stay as
/// they are.
pub fn finish(words: Vec<u32>, original: &[u32], bounds: &Bounds, draws_by_index: bool) -> Finished {
    let Some(mut module) = Module::parse(&words) else {
        return Finished { unoptimized: words.len(), words, is_bounded: false };
    };
    initialize(&mut module);
    let is_bounded = loops::bound(&mut module, original, bounds);
    separate_hits(&mut module);
    if draws_by_index {
        index_draws(&mut module);
    }
    let words = module.write();
    let unoptimized = words.len();
    let words = optimized(module).map_or(words, |module| module.write());
    Finished { words, unoptimized, is_bounded }
}
