//! How a frame shows the picture.

/// How the next frame shows the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum Plan {
    /// The whole picture, drawn with the frame if it is not there yet.
    #[default]
    Whole,
    /// The whole picture as it is, while its next one, which improves it, is drawn between frames.
    Kept,
    /// A preview.
    Preview,
}
