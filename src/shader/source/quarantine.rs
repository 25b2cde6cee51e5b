//! A shader tree on disk, some of whose files are quarantined: the compiler reads their last good texts instead. A window starts
//! with such a tree after the device was lost, so that the text that may have caused the loss does not cause the next.

use std::collections::BTreeMap;

use xxhash_rust::xxh3::xxh3_64;

use super::{SourceError, TreePath};

/// The texts that are read instead of those on disk.
#[derive(Debug)]
pub struct Quarantine {
    /// The last good texts of files that differ from them.
    pub(super) texts: BTreeMap<TreePath, String>,
    /// Hashes of the quarantined texts on disk, see [`text_hash`]. A file without a last good text may be among them.
    pub(super) files: BTreeMap<TreePath, u64>,
    /// Why, for the diagnostics.
    pub(super) cause: String,
}

/// A hash of a file's text, or of the reason why it cannot be read. It is the same in every process.
pub fn text_hash(read: &Result<String, SourceError>) -> u64 {
    match read {
        Ok(text) => xxh3_64(text.as_bytes()),
        Err(error) => xxh3_64(error.to_string().as_bytes()).wrapping_add(1),
    }
}
