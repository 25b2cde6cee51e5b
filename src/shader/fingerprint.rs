//! Tells a file's content from another's, cheaply.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// Larger files (models, images) are told apart by size and time instead of content.
const MAX_HASHED_BYTES: u64 = 4 << 20;

/// Deep enough for any tree, and an end for directories that link to themselves.
const MAX_DEPTH: u32 = 16;

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
        // A file that cannot be read still exists; when it can be read again, that is a change.
        std::fs::read(path).ok().hash(&mut hasher);
    }
    Some(Fingerprint(hasher.finish()))
}

/// All files below a directory. `.git` is left out: it changes with every command and holds no shader.
pub fn walk(directory: &Path) -> Vec<PathBuf> {
    let mut out = Vec::new();
    descend(directory, 0, &mut out);
    out
}

fn descend(directory: &Path, depth: u32, out: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(directory) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_file() {
            out.push(path);
        } else if depth < MAX_DEPTH && path.is_dir() && !path.ends_with(".git") {
            descend(&path, depth + 1, out);
        }
    }
}
