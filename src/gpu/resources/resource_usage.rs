//! The descriptors that a shader module reads or writes.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::interface::Resource;

/// The descriptors that the functions of a module use, or those of all modules of a pipeline. What a module only declares
/// does not count.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ResourceUsage {
    /// Bindings in `interface::SET_FRAME`.
    pub frame_bindings: BTreeSet<u32>,
    /// Bytes of the block `interface::Frame`. The ranges may overlap, and the last may end beyond the block.
    pub frame_bytes: Vec<Range<usize>>,
    /// Bindings in `interface::SET_PASS`.
    pub pass_bindings: BTreeSet<u32>,
    /// Resources that functions called from the entry points use.
    pub resources: BTreeSet<Resource>,
}

impl ResourceUsage {
    /// The union of both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            frame_bindings: &self.frame_bindings | &other.frame_bindings,
            frame_bytes: [&*self.frame_bytes, &*other.frame_bytes].concat(),
            pass_bindings: &self.pass_bindings | &other.pass_bindings,
            resources: &self.resources | &other.resources,
        }
    }

    /// Whether one of these ranges of bytes of the block `interface::Frame` is used.
    pub fn reads_frame(&self, bytes: &[Range<usize>]) -> bool {
        let overlap = |used: &Range<usize>| bytes.iter().any(|b| used.start < b.end && b.start < used.end);
        self.frame_bytes.iter().any(overlap)
    }
}
