//! The files that the editor has open.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use lsp_types::{TextDocumentContentChangeEvent, Uri};

use super::source_file::SourceFile;
use super::source_text::SourceText;
use super::uri::path_of;

/// An open file.
#[derive(Clone, Debug)]
pub struct Document {
    /// Its path; `None` if it is no file.
    pub path: Option<PathBuf>,
    /// As the editor has it.
    pub file: Arc<SourceFile>,
}

/// All open files.
#[derive(Debug, Default)]
pub struct Documents {
    open: BTreeMap<String, Document>,
    /// The number of the last change.
    pub last: Option<PathBuf>,
}

impl Documents {
    /// Takes a file that was opened, or its whole new text.
    pub fn open(&mut self, uri: Uri, text: &str) {
        let path = path_of(&uri);
        self.last.clone_from(&path);
        let key = uri.as_str().to_owned();
        let file = Arc::new(SourceFile::new(uri, SourceText::new(text)));
        self.open.insert(key, Document { path, file });
    }

    /// Applies changes. Returns whether the file is open.
    pub fn change(&mut self, uri: &Uri, changes: &[TextDocumentContentChangeEvent]) -> bool {
        let Some(document) = self.open.get_mut(uri.as_str()) else { return false };
        let source = document.file.source.changed(changes);
        document.file = Arc::new(SourceFile::new(uri.clone(), source));
        self.last.clone_from(&document.path);
        true
    }

    /// Forgets a file. Returns its path.
    pub fn close(&mut self, uri: &Uri) -> Option<PathBuf> {
        self.open.remove(uri.as_str())?.path
    }

    /// The open file of a name.
    pub fn get(&self, uri: &Uri) -> Option<&Document> {
        self.open.get(uri.as_str())
    }

    /// The open files that lie on disk, or will.
    pub fn with_paths(&self) -> impl Iterator<Item = (&PathBuf, &Arc<SourceFile>)> {
        self.open.values().filter_map(|document| Some((document.path.as_ref()?, &document.file)))
    }
}
