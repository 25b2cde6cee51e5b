//! The shader tree that is embedded in the binary. `specula new` writes it to a directory.

use std::fs::{self, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use include_dir::{Dir, DirEntry, include_dir};

use super::TreePath;

static TREE: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/shaders");

/// The bytes of an embedded file.
pub fn read(path: &TreePath) -> Option<&'static [u8]> {
    TREE.get_file(path.as_str()).map(|file| file.contents())
}

/// All embedded files, sorted.
pub fn list() -> Vec<TreePath> {
    let mut out = Vec::new();
    collect(&TREE, &mut out);
    out.sort();
    out
}

fn collect(directory: &Dir<'_>, out: &mut Vec<TreePath>) {
    for entry in directory.entries() {
        match entry {
            DirEntry::Dir(directory) => collect(directory, out),
            DirEntry::File(file) => out.extend(file.path().to_str().and_then(TreePath::parse)),
        }
    }
}

/// Writes the tree into `directory`, creating it if needed. Returns the files in order.
///
/// # Errors
/// `AlreadyExists` if the directory is not empty, so that no file of the user is overwritten. Otherwise the system's error
/// with the path.
pub fn write_to(directory: &Path) -> io::Result<Vec<PathBuf>> {
    let named = |path: &Path, error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
    fs::create_dir_all(directory).map_err(|error| named(directory, error))?;
    if fs::read_dir(directory).map_err(|error| named(directory, error))?.next().is_some() {
        let message = format!("{} is not empty; choose a new directory", directory.display());
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, message));
    }
    let mut written = Vec::new();
    for path in list() {
        let target = directory.join(path.as_str());
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent).map_err(|error| named(parent, error))?;
        }
        let bytes = read(&path).unwrap_or_default();
        OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&target)
            .and_then(|mut file| file.write_all(bytes))
            .map_err(|error| named(&target, error))?;
        written.push(target);
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::source::{Source, is_specula_tree};

    #[test]
    fn new_writes_a_tree_once() {
        let directory = tempfile::tempdir().unwrap();
        let target = directory.path().join("mine");
        let written = write_to(&target).unwrap();
        assert_eq!(written.len(), list().len());
        assert!(is_specula_tree(&target));
        assert_eq!(Source::Disk(target.clone()).list(), Source::embedded().list());
        let error = write_to(&target).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert!(error.to_string().contains("not empty"), "{error}");
    }
}
