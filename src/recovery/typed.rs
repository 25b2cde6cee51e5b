//! Texts that the user has typed into files and not saved.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::files;
use crate::shader::TreePath;
use crate::{regular_file, state_folder};

/// The record of these texts in the session's folder.
pub(super) const TYPED: &str = "typed.json";

/// A file that is typed, with changes that were not saved.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TypedText {
    /// The folder of the file's tree.
    #[serde(with = "super::paths::one")]
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

/// Copies the texts that were recorded in a session's folder to the user's folder for state, since no window will go on with them. Returns the
/// files.
pub fn keep_typed(folder: &Path) -> Vec<PathBuf> {
    state_folder::unsaved_texts().map(|to| copy(folder, &to)).unwrap_or_default()
}

/// The same to any folder.
pub(super) fn copy(folder: &Path, to: &Path) -> Vec<PathBuf> {
    let keep = |typed: TypedText| {
        std::fs::create_dir_all(to).ok()?;
        let name = typed.file.to_string().replace('/', "-");
        let free = |number: usize| to.join(if number == 1 { name.clone() } else { format!("{number}-{name}") });
        let path = (1..).map(free).find(|path| !path.exists())?;
        regular_file::create_private(&path).and_then(|mut file| file.write_all(typed.text.as_bytes())).ok()?;
        Some(path)
    };
    read(folder).into_iter().filter_map(keep).collect()
}
