//! The shader tree that is embedded in the binary, and its examples. `specula new` writes one to a directory.

use std::collections::BTreeSet;
use std::fs::{self, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use include_dir::{Dir, DirEntry, include_dir};

use super::TreePath;

static TREE: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/shaders");
static EXAMPLES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/examples");

/// An example: files that are added to the tree, or take the place of files in it.
#[derive(Clone, Copy, Debug)]
pub struct Example(&'static Dir<'static>);

impl Example {
    /// The example of this name.
    pub fn named(name: &str) -> Option<Self> {
        EXAMPLES.get_dir(name).filter(|_| !name.contains('/')).map(Self)
    }

    /// The names of all examples, sorted.
    pub fn names() -> Vec<&'static str> {
        let mut names: Vec<&str> = EXAMPLES.dirs().filter_map(|directory| directory.path().to_str()).collect();
        names.sort_unstable();
        names
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        self.0.path().to_str().unwrap_or_default()
    }

    fn read(self, path: &TreePath) -> Option<&'static [u8]> {
        self.0.get_file(self.0.path().join(path.as_str())).map(|file| file.contents())
    }
}

/// The bytes of an embedded file, in the tree of an example or in the tree as it is.
pub fn read(example: Option<Example>, path: &TreePath) -> Option<&'static [u8]> {
    let of_example = example.and_then(|example| example.read(path));
    of_example.or_else(|| TREE.get_file(path.as_str()).map(|file| file.contents()))
}

/// Whether the tree as it is has a file.
pub fn has(path: &str) -> bool {
    static FILES: LazyLock<BTreeSet<String>> = LazyLock::new(|| list(None).iter().map(ToString::to_string).collect());
    FILES.contains(path)
}

/// All embedded files, sorted.
pub fn list(example: Option<Example>) -> Vec<TreePath> {
    let mut out = Vec::new();
    collect(&TREE, TREE.path(), &mut out);
    if let Some(Example(directory)) = example {
        collect(directory, directory.path(), &mut out);
    }
    out.sort();
    out.dedup();
    out
}

fn collect(directory: &Dir<'_>, root: &Path, out: &mut Vec<TreePath>) {
    for entry in directory.entries() {
        match entry {
            DirEntry::Dir(directory) => collect(directory, root, out),
            DirEntry::File(file) => {
                let path = file.path().strip_prefix(root).ok().and_then(Path::to_str);
                out.extend(path.and_then(TreePath::parse));
            }
        }
    }
}

/// Writes the tree, with an example, into `directory`, creating it if needed. Returns the files in order. Leaves nothing if a file cannot be
/// written.
///
/// # Errors
/// `AlreadyExists` if the directory is not empty, so that no file of the user is overwritten. Otherwise the system's error
/// with the path.
pub fn write_to(directory: &Path, example: Option<Example>) -> io::Result<Vec<PathBuf>> {
    let named = |path: &Path, error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
    fs::create_dir_all(directory).map_err(|error| named(directory, error))?;
    if fs::read_dir(directory).map_err(|error| named(directory, error))?.next().is_some() {
        let message = format!("{} is not empty; choose a new directory", directory.display());
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, message));
    }
    let mut begun = Vec::new();
    let result = list(example).iter().try_for_each(|path| {
        let target = directory.join(path.as_str());
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent).map_err(|error| named(parent, error))?;
        }
        let bytes = read(example, path).unwrap_or_default();
        begun.push(target.clone());
        let opened = OpenOptions::new().write(true).create_new(true).open(&target);
        opened.and_then(|mut file| file.write_all(bytes)).map_err(|error| named(&target, error))
    });
    if result.is_err() {
        remove(directory, &begun);
    }
    result.map(|()| begun)
}

/// Removes files below `directory`, and the folders that are then empty.
fn remove(directory: &Path, files: &[PathBuf]) {
    let folders = files.iter().flat_map(|file| file.ancestors().skip(1));
    let folders: BTreeSet<&Path> = folders.filter(|folder| folder.starts_with(directory)).collect();
    files.iter().for_each(|file| _ = fs::remove_file(file));
    // Inner folders come after outer ones. A folder with other files stays.
    folders.into_iter().rev().for_each(|folder| _ = fs::remove_dir(folder));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::source::{Source, is_specula_tree};

    #[test]
    fn new_writes_a_tree_once() {
        let directory = tempfile::tempdir().unwrap();
        let target = directory.path().join("mine");
        let written = write_to(&target, None).unwrap();
        assert_eq!(written.len(), list(None).len());
        assert!(is_specula_tree(&target));
        assert_eq!(Source::disk(target.clone()).list(), Source::embedded().list());
        let error = write_to(&target, None).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert!(error.to_string().contains("not empty"), "{error}");
    }

    #[test]
    fn an_example_adds_files_and_replaces_some() {
        let example = Example::named("reaction").unwrap();
        let (user, added) = (TreePath::from("user.glsl"), TreePath::from("passes/reaction.frag"));
        assert!(read(None, &added).is_none() && read(Some(example), &added).is_some());
        assert_ne!(read(None, &user), read(Some(example), &user));
        assert_eq!(list(Some(example)).len(), list(None).len() + 1);
        assert!(Example::names().contains(&example.name()));
        assert!(Example::named("reaction/passes").is_none() && Example::named("").is_none());
        let directory = tempfile::tempdir().unwrap();
        write_to(directory.path(), Some(example)).unwrap();
        assert_eq!(Source::disk(directory.path()).list(), Source::example(Some(example)).list());
    }
}
