//! Modes that one pipeline computes at once.

/// A mode that is drawn together with others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharedMode {
    /// Value of `MODE`.
    pub id: u32,
    /// `interface::ENCODE_*`.
    pub encode: u32,
}
