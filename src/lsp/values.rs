//! The pinned pixel, and the values of the files at it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use lsp_server::RequestId;

use super::traced::{Asked, Traced, TracedFile};
use crate::shader::TreePath;

/// A pixel of a tree that is traced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pin {
    /// The folder of the tree.
    pub root: PathBuf,
    /// Counted from the upper left corner.
    pub at: (u32, u32),
    /// The socket of the window in which it is pinned; `None` if the editor has pinned it.
    pub window: Option<PathBuf>,
}

/// The values at the pinned pixel.
#[derive(Debug, Default)]
pub struct Values {
    pin: Option<Pin>,
    files: BTreeMap<TreePath, TracedFile>,
    /// Files that were asked for since they changed.
    asked: BTreeSet<TreePath>,
}

impl Values {
    /// Pins a pixel, or none.
    pub fn pin(&mut self, pin: Option<Pin>) {
        *self = Self { pin, ..Self::default() };
    }

    /// The values of a file.
    pub fn of(&self, root: &Path, path: &TreePath) -> Option<&TracedFile> {
        self.pin.as_ref().filter(|pin| pin.root == root)?;
        self.files.get(path)
    }

    /// The question for the values of a file, if they were not asked for yet.
    pub fn question(&mut self, root: &Path, path: &TreePath) -> Option<Asked> {
        let pin = self.pin.as_ref().filter(|pin| pin.root == root)?;
        self.asked.insert(path.clone()).then(|| Asked {
            root: pin.root.clone(),
            at: pin.at,
            files: BTreeSet::from([path.clone()]),
            window: pin.window.clone(),
            ..Asked::default()
        })
    }

    /// The question for the values of files once more, since these have changed on disk, or for a request.
    pub fn again(
        &mut self,
        files: BTreeSet<TreePath>,
        changed: BTreeSet<TreePath>,
        request: Option<RequestId>,
    ) -> Option<Asked> {
        let pin = self.pin.as_ref()?;
        self.asked.clone_from(&files);
        let (root, window) = (pin.root.clone(), pin.window.clone());
        Some(Asked { root, at: pin.at, files, changed, requests: request.into_iter().collect(), window })
    }

    /// The pinned pixel.
    pub fn pinned(&self) -> Option<&Pin> {
        self.pin.as_ref()
    }

    /// Takes an answer. Returns whether it is about the pinned pixel.
    pub fn take(&mut self, traced: &Traced) -> bool {
        let is_current = self.pin.as_ref().is_some_and(|pin| {
            let asked = &traced.asked;
            (&pin.root, pin.at, &pin.window) == (&asked.root, asked.at, &asked.window)
        });
        if is_current {
            // Of what was asked for, nothing older stays.
            self.files.retain(|path, _| !traced.asked.files.contains(path));
        }
        if is_current && let Ok((files, _)) = &traced.result {
            self.files.extend(files.iter().map(|file| (file.path.clone(), file.clone())));
        }
        is_current
    }
}
