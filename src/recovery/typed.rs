//! Texts that the user has typed into files and not saved.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::files;
use crate::shader::TreePath;

/// The record of these texts in the session's folder.
pub(super) const TYPED: &str = "typed.json";

/// A file that is typed, with changes that were not saved.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TypedText {
    /// The folder of the file's tree.
    pub root: PathBuf,
    /// The file below it.
    pub file: TreePath,
    /// Its path in the tree, which for a single file is not the one on disk.
    pub path: TreePath,
    /// The text with which the typing began, or that was saved last.
    pub base: String,
    /// The text now.
    pub text: String,
}

/// The texts that were recorded in a session's folder.
pub(super) fn read(folder: &Path) -> Vec<TypedText> {
    files::read(folder, TYPED).unwrap_or_default()
}

/// Records them.
pub(super) fn write(folder: &Path, typed: &[TypedText]) -> std::io::Result<()> {
    files::write(folder, TYPED, &typed)
}
