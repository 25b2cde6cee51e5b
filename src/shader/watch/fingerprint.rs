//! A cheap test whether a file's content differs from what it was.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// For larger files (models, images), size and modification time replace the content.
const MAX_HASHED_BYTES: u64 = 4 << 20;

/// Equal for equal content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

/// `None` when there is no such file.
pub fn fingerprint(path: &Path) -> Option<Fingerprint> {
    let metadata = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
    let mut hasher = DefaultHasher::new();
    metadata.len().hash(&mut hasher);
    if metadata.len() > MAX_HASHED_BYTES {
        metadata.modified().ok().hash(&mut hasher);
    } else {
        // A file that cannot be read still exists. When it can be read again, that is a change.
        std::fs::read(path).ok().hash(&mut hasher);
    }
    Some(Fingerprint(hasher.finish()))
}
