//! A measured frame.

use crate::gpu::{DrawCounts, PassTime};

/// Passes that a frame runs even if the picture is unchanged.
const NOT_OF_PICTURE: [&str; 4] = ["tone map", "ui", "outline", "texture"];

/// Inputs of a frame. Times can be compared between frames with equal inputs.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Shown {
    /// Number of the shader tree.
    pub(in crate::app) tree: usize,
    /// Generation of the shaders.
    pub(in crate::app) generation: u64,
    /// Slug of the mode.
    pub(in crate::app) mode: String,
    /// Size of the picture in pixels.
    pub(in crate::app) size: (u32, u32),
    /// Name of the model.
    pub(in crate::app) model: String,
}

impl Shown {
    /// Whether only the generations differ.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        (self.tree, &self.mode, self.size, &self.model) == (other.tree, &other.mode, other.size, &other.model)
    }
}

/// CPU time of a frame, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::app) struct CpuTimes {
    /// Running the panels and making triangles of them; 0 in a frame that shows them as they were.
    pub(in crate::app) ui_ms: f64,
    /// Recording the commands of picture and panels.
    pub(in crate::app) record_ms: f64,
}

/// A frame that the device has finished.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Sample {
    pub(in crate::app) shown: Shown,
    pub(in crate::app) cpu: CpuTimes,
    /// Device time of the whole frame.
    pub(in crate::app) device_ms: f64,
    pub(in crate::app) passes: Vec<PassTime>,
    pub(in crate::app) counts: DrawCounts,
}

impl Sample {
    /// The time of a pass; `None` if the frame has none of this name. A reused pass took none.
    pub(in crate::app) fn pass_ms(&self, name: &str) -> Option<f64> {
        let mut of_name = self.passes.iter().filter(|pass| pass.name == name).map(|pass| pass.ms).peekable();
        of_name.peek()?;
        Some(of_name.sum())
    }

    /// Whether the frame has drawn the picture, and no other picture beside it.
    pub(super) fn is_of_picture(&self) -> bool {
        let draws = |pass: &PassTime| !pass.kept && !NOT_OF_PICTURE.contains(&pass.name.as_str());
        self.passes.iter().any(draws) && self.passes.iter().all(|pass| pass.name != "compare")
    }
}
