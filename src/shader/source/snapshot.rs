//! A snapshot of a tree. It reads each file once, so all stages of an update see the same text.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use super::{Source, SourceError, TreePath};

/// The result of reading a file.
pub type Read = Result<Arc<str>, SourceError>;

/// A lazily filled copy of a tree, which the compile threads share.
#[derive(Debug)]
pub struct Snapshot<'a> {
    source: &'a Source,
    files: Arc<Mutex<BTreeMap<TreePath, Read>>>,
    /// Texts that replace those in `files` in this snapshot.
    over: BTreeMap<TreePath, Read>,
}

impl<'a> Snapshot<'a> {
    /// An empty snapshot. It reads a file at its first use.
    pub fn new(source: &'a Source) -> Self {
        Self::holding(source, BTreeMap::new())
    }

    /// A snapshot that already contains these files.
    pub fn holding(source: &'a Source, files: BTreeMap<TreePath, Read>) -> Self {
        Self { source, files: Arc::new(Mutex::new(files)), over: BTreeMap::new() }
    }

    /// The same snapshot with other texts in place of some.
    #[must_use]
    pub fn over(&self, texts: BTreeMap<TreePath, Read>) -> Self {
        Self { source: self.source, files: self.files.clone(), over: texts }
    }

    /// Sets the text of a file that the tree does not have.
    pub fn put(&self, path: &TreePath, read: Read) {
        self.files.lock().unwrap_or_else(PoisonError::into_inner).insert(path.clone(), read);
    }

    /// The text of a file at the first call.
    pub fn read(&self, path: &TreePath) -> Read {
        if let Some(over) = self.over.get(path) {
            return over.clone();
        }
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = files.get(path) {
            return known.clone();
        }
        let read: Read = self.source.read(path).map(Arc::from);
        files.insert(path.clone(), read.clone());
        read
    }

    /// The paths, in the tree, where a file was looked for that is not there.
    pub fn looked_for(&self, paths: &[TreePath]) -> String {
        let shown = paths.iter().map(|path| self.source.in_tree(&self.display_path(path)).to_owned());
        shown.collect::<Vec<_>>().join(" and ")
    }

    /// The path of a file for messages.
    pub fn display_path(&self, path: &TreePath) -> String {
        self.source.display_path(path)
    }

    /// The tree.
    pub fn source(&self) -> &Source {
        self.source
    }

    /// A hash of paths and their contents, including missing files and errors. Equal hashes compile to equal modules.
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
