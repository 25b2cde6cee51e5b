//! A temporary copy of a shader tree, which measurements edit.

use std::path::{Path, PathBuf};

use specula::shader::Source;

use crate::commands::Failure;

/// Copies every file of a tree into an empty folder.
pub(super) fn copy_tree(source: &Source, folder: &Path) -> Result<(), Failure> {
    for path in source.list() {
        let to = folder.join(path.as_str());
        let content = source.read_bytes(&path).map_err(|e| Failure::Input(e.to_string()))?;
        let made = to.parent().map_or(Ok(()), std::fs::create_dir_all);
        made.and_then(|()| std::fs::write(&to, content))
            .map_err(|e| Failure::Input(format!("{}: {e}", to.display())))?;
    }
    Ok(())
}

/// A temporary folder. Dropping this deletes it.
pub(super) struct TempFolder(pub(super) PathBuf);

impl TempFolder {
    pub(super) fn new() -> Result<Self, Failure> {
        let path = std::env::temp_dir().join(format!("specula-bench-{}", std::process::id()));
        std::fs::create_dir(&path).map_err(|e| Failure::Input(format!("{}: {e}", path.display())))?;
        Ok(Self(path))
    }
}

impl Drop for TempFolder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
