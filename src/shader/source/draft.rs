//! A shader tree, some of whose files have other texts in memory: a number that is being dragged, or an older version.
//!
//! A draft replaces a file only as long as the file on disk is the one that the draft was made from, so an edit in the
//! editor wins. Dragged values become defaults in `rewrite/defaults.rs`, as edits of byte ranges in lines;
//! `write_back::write` applies them to the file on disk if each line is as the edit expects it.

use std::sync::Arc;

/// A text in memory, and the file's text from which it was made.
#[derive(Clone, Debug)]
pub struct DraftText {
    /// The text of the file.
    pub base: Arc<str>,
    /// The text in memory.
    pub text: Arc<str>,
}
