//! The files of a folder, which a thread has read for the command palette.

use std::path::{Path, PathBuf};

use crate::file_kind::Listed;

/// The folder that was listed last.
#[derive(Default)]
pub(in crate::app) struct Listing {
    folder: PathBuf,
    /// `None` until it has been read.
    files: Option<Result<Vec<Listed>, String>>,
}

impl Listing {
    /// Whether this folder was asked for last.
    pub(in crate::app) fn is_of(&self, folder: &Path) -> bool {
        self.folder == folder
    }

    /// Notes that a folder is being read.
    pub(in crate::app) fn ask(&mut self, folder: PathBuf) {
        *self = Self { folder, files: None };
    }

    /// Takes the files of a folder, unless another was asked for since.
    pub(in crate::app) fn take(&mut self, folder: &Path, files: Result<Vec<Listed>, String>) {
        if self.is_of(folder) {
            self.files = Some(files);
        }
    }

    /// The files of a folder, or why there are none; `None` until it has been read.
    pub(in crate::app) fn of(&self, folder: &Path) -> Option<&Result<Vec<Listed>, String>> {
        self.files.as_ref().filter(|_| self.is_of(folder))
    }
}
