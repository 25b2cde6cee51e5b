//! A tree at one moment: each file is read once, so all stages of one update see the same text.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use super::{Source, SourceError, TreePath};

/// What reading a file gave.
pub type Read = Result<Arc<str>, SourceError>;

/// A lazily filled copy of a tree; shared by the compile threads.
#[derive(Debug)]
pub struct Snapshot<'a> {
    source: &'a Source,
    files: Mutex<BTreeMap<TreePath, Read>>,
}

impl<'a> Snapshot<'a> {
    /// An empty snapshot: files are read when first asked for.
    pub fn new(source: &'a Source) -> Self {
        Self { source, files: Mutex::default() }
    }

    /// The text of a file, as it was at the first call.
    pub fn read(&self, path: &TreePath) -> Read {
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = files.get(path) {
            return known.clone();
        }
        let read: Read = self.source.read(path).map(Arc::from);
        files.insert(path.clone(), read.clone());
        read
    }

    /// The path to print for a file.
    pub fn display_path(&self, path: &TreePath) -> String {
        self.source.display_path(path)
    }

    /// A hash of paths and their contents, absence and errors included: equal hashes compile to equal modules.
    pub fn closure_hash<'p>(&self, paths: impl IntoIterator<Item = &'p TreePath>) -> u64 {
        let mut hasher = DefaultHasher::new();
        for path in paths {
            path.hash(&mut hasher);
            match self.read(path) {
                Ok(text) => text.hash(&mut hasher),
                Err(error) => error.to_string().hash(&mut hasher),
            }
        }
        hasher.finish()
    }
}
