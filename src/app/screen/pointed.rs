//! A pixel whose exact value can be read.

use crate::frame::FrameState;
use crate::interface::MODE_FINAL;
use crate::shader::DrawAs;
use crate::shader::graph::RenderPhase;

/// A pixel of a mode whose value can be read in 32 bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct Pointed {
    /// Slug of the mode.
    pub(super) mode: String,
    /// Pixels from the upper left corner of its picture.
    pub(super) at: [u32; 2],
    /// Width and height of the picture, pixels.
    pub(super) size: (u32, u32),
    /// Whether the picture shows a color for each number of the mode.
    pub(super) is_number: bool,
}

impl Pointed {
    /// A pixel of a frame. `None` if the pixel drawn alone would have another value than in the frame: path tracing takes many
    /// frames, lines and layers are blended, and passes may follow the model.
    pub(super) fn new(frame_state: &FrameState, at: (u32, u32)) -> Option<Self> {
        let mode = frame_state.mode()?;
        let is_number = mode.numbers.is_some();
        let is_of_model = mode.pass.is_none() && mode.id != MODE_FINAL && !mode.is_displayed;
        let is_opaque = mode.draw == DrawAs::Surfaces && !mode.through && !mode.follows_paths();
        let mut passes = frame_state.pipelines.passes.iter();
        let has_no_others = passes
            .all(|pass| matches!(pass.phase, RenderPhase::BeforeModel | RenderPhase::Model | RenderPhase::Tonemap));
        let is_same = is_number || is_of_model && is_opaque && has_no_others;
        is_same.then(|| Self { mode: mode.slug.clone(), at: [at.0, at.1], size: frame_state.size, is_number })
    }
}
