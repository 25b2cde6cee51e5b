//! Chooses the directories to watch for a tree and for single files, and interprets their events.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::trail::{Trail, follow};
use crate::shader::source::directory::{self, FolderEntry};

/// Directories and files at one moment. Directories are named without symbolic links, as events name them; files by the
/// names that the watcher was given.
#[derive(Debug, Default)]
pub struct Plan {
    /// Every directory whose entries matter.
    pub places: BTreeMap<PathBuf, DirectoryRole>,
    /// Every file that exists: its name, and where it is without symbolic links.
    pub files: BTreeMap<PathBuf, PathBuf>,
}

/// Why a directory matters.
#[derive(Debug, Default)]
pub struct DirectoryRole {
    /// The names under which the tree contains the directory: all its entries matter.
    pub tree_names: BTreeSet<PathBuf>,
    /// Entries that paths lead through: for each, the given path, and whether the path ends at this entry.
    pub entries: BTreeMap<OsString, BTreeMap<PathBuf, bool>>,
}

impl Plan {
    /// Walks the tree and follows the paths of `files`. `watch` is called with each directory before it is read, so that no
    /// change is missed, and with whether the directory has content: a link or a file, and not only a further directory.
    pub fn new(root: Option<&Path>, files: &BTreeSet<PathBuf>, watch: &mut dyn FnMut(&Path, bool)) -> Self {
        let mut plan = Self::default();
        for path in files {
            let trail = follow(path, &mut *watch);
            plan.add(path, trail);
        }
        let Some(root) = root else { return plan };
        let trail = follow(root, &mut *watch);
        let end = trail.end.clone();
        plan.add(root, trail);
        plan.files.remove(root);
        if end.is_some() {
            directory::walk(root, is_watched, &mut |entry| match entry {
                FolderEntry::Directory { path, real } => {
                    watch(real, true);
                    plan.places.entry(real.to_owned()).or_default().tree_names.insert(path.to_owned());
                }
                FolderEntry::Link { path, folder } => {
                    let Some(name) = path.file_name() else { return };
                    let trail = follow(&folder.join(name), &mut *watch);
                    plan.add(path, trail);
                }
                FolderEntry::File { path } => {
                    // A link was added with the file to which it leads.
                    if !plan.files.contains_key(path)
                        && let Ok(real) = path.canonicalize()
                    {
                        plan.files.insert(path.to_owned(), real);
                    }
                }
            });
        }
        plan
    }

    fn add(&mut self, path: &Path, trail: Trail) {
        let last = trail.steps.len().saturating_sub(1);
        for (index, (folder, name)) in trail.steps.into_iter().enumerate() {
            let ends = index == last && trail.complete && !folder.join(&name).is_symlink();
            let paths = self.places.entry(folder).or_default().entries.entry(name).or_default();
            *paths.entry(path.to_owned()).or_insert(ends) &= ends;
        }
        if let Some(end) = trail.end.filter(|end| end.is_file()) {
            self.files.insert(path.to_owned(), end);
        }
    }

    /// Whether the tree contains the directory of `real` under the name of the directory of `path`.
    pub fn has_directory_of(&self, path: &Path, real: &Path) -> bool {
        let place = real.parent().and_then(|folder| self.places.get(folder));
        place.zip(path.parent()).is_some_and(|(place, folder)| place.tree_names.contains(folder))
    }
}

/// `.git` changes with every command and contains no shaders.
pub fn is_watched(name: &str) -> bool {
    name != ".git"
}
