//! The timestamps of a submission, and the passes that they belong to.

use ash::vk;

/// Number of passes of a submission that are timed. Passes beyond it have a label only.
pub(in crate::gpu) const MAX_TIMED_PASSES: u32 = 64;

/// Timestamps of a submission: two for the whole, then two for each pass.
pub(in crate::gpu) const MAX_TIMESTAMPS: u32 = 2 + 2 * MAX_TIMED_PASSES;

/// Device time of a pass.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct PassTime {
    /// The pass's name.
    pub name: String,
    /// Milliseconds from the end of all earlier commands to the end of the pass; 0 if its image is reused.
    pub ms: f64,
    /// Whether the pass reused its image of an earlier frame, since it would be unchanged.
    pub kept: bool,
}

/// A pass of the commands being recorded.
pub(in crate::gpu) struct TimedPass {
    pub(in crate::gpu) name: String,
    pub(in crate::gpu) kept: bool,
}

/// The query pool of the commands being recorded, and the passes timed so far.
pub(in crate::gpu) struct PassTimer {
    queries: vk::QueryPool,
    pub(in crate::gpu) passes: Vec<TimedPass>,
}

impl PassTimer {
    /// `queries` holds [`MAX_TIMESTAMPS`] timestamps, all reset.
    pub(in crate::gpu) fn new(queries: vk::QueryPool) -> Self {
        Self { queries, passes: Vec::new() }
    }

    /// The first of the two timestamps of a new pass, if one is free.
    pub(in crate::gpu) fn reserve(&mut self, name: &str, kept: bool) -> Option<(vk::QueryPool, u32)> {
        let pass = u32::try_from(self.passes.len()).ok().filter(|pass| *pass < MAX_TIMED_PASSES)?;
        self.passes.push(TimedPass { name: name.to_owned(), kept });
        Some((self.queries, 2 + 2 * pass))
    }
}
