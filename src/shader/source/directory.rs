//! Walks the files below a directory. The walk follows symbolic links, but no cycles, and no links to directories outside.

use std::path::{Path, PathBuf};

/// Maximum depth of the walk.
const MAX_DEPTH: usize = 16;
/// Maximum number of files and directories. A tree may be anything that the user, or a look from elsewhere, names.
pub const MOST_ENTRIES: usize = 20_000;
/// Maximum number of links on a path. Directories that link to each other have exponentially many paths even without cycles.
const MAX_NESTED_LINKS: usize = 2;

/// An entry that [`walk`] visits. `path` is the walk's directory joined with the names on the way.
#[derive(Clone, Copy, Debug)]
pub enum FolderEntry<'a> {
    /// A directory, before its entries are read. The walk's own directory comes first.
    Directory {
        /// The name under which the walk reached it.
        path: &'a Path,
        /// The same directory without symbolic links.
        real: &'a Path,
    },
    /// A symbolic link, dangling or not. If the walk follows it, its directory or file comes next.
    Link {
        /// The name under which the walk reached it.
        path: &'a Path,
        /// The directory that holds the link, without symbolic links.
        folder: &'a Path,
    },
    /// A regular file, or a link to a regular file.
    File {
        /// The name under which the walk reached it.
        path: &'a Path,
    },
}

/// Visits everything below `directory`, in no particular order. `keep` decides by name whether the walk visits an entry. The
/// walk follows a link to a directory of the tree unless that directory contains the link. Returns whether it has visited all: it ends
/// after [`MOST_ENTRIES`].
pub fn walk(directory: &Path, keep: impl Fn(&str) -> bool, visit: &mut dyn FnMut(FolderEntry<'_>)) -> bool {
    let Ok(real) = directory.canonicalize() else { return true };
    visit(FolderEntry::Directory { path: directory, real: &real });
    let mut walk = Walk { keep, above: vec![real], links: 0, left: MOST_ENTRIES };
    walk.descend(directory, visit);
    walk.left > 0
}

/// The files that [`walk`] visits.
pub fn files(directory: &Path, keep: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let mut out = Vec::new();
    walk(directory, keep, &mut |entry| {
        if let FolderEntry::File { path } = entry {
            out.push(path.to_owned());
        }
    });
    out
}

struct Walk<F> {
    keep: F,
    /// The current directory and its ancestors in the walk, without symbolic links.
    above: Vec<PathBuf>,
    /// Number of links on the way to the current directory.
    links: usize,
    /// Number of entries that may still be visited.
    left: usize,
}

impl<F: Fn(&str) -> bool> Walk<F> {
    fn descend(&mut self, directory: &Path, visit: &mut dyn FnMut(FolderEntry<'_>)) {
        let Ok(entries) = std::fs::read_dir(directory) else { return };
        for entry in entries.flatten() {
            let path = entry.path();
            if !(self.keep)(&entry.file_name().to_string_lossy()) {
                continue;
            }
            self.left = self.left.saturating_sub(1);
            if self.left == 0 {
                return;
            }
            let is_link = entry.file_type().is_ok_and(|kind| kind.is_symlink());
            if is_link && let Some(folder) = self.above.last() {
                visit(FolderEntry::Link { path: &path, folder });
            }
            if path.is_file() {
                visit(FolderEntry::File { path: &path });
            } else if path.is_dir() && self.above.len() < MAX_DEPTH {
                self.enter(&path, is_link, visit);
            }
        }
    }

    fn enter(&mut self, directory: &Path, is_link: bool, visit: &mut dyn FnMut(FolderEntry<'_>)) {
        let Ok(real) = directory.canonicalize() else { return };
        // A link may lead to a parent of the walk's first directory, so comparing for equality is not enough.
        let is_circle = self.above.iter().any(|above| above.starts_with(&real));
        let is_inside = self.above.first().is_some_and(|root| real.starts_with(root));
        if is_link && (is_circle || !is_inside || self.links >= MAX_NESTED_LINKS) {
            return;
        }
        visit(FolderEntry::Directory { path: directory, real: &real });
        self.links += usize::from(is_link);
        self.above.push(real);
        self.descend(directory, visit);
        self.above.pop();
        self.links -= usize::from(is_link);
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    fn names(root: &Path) -> Vec<String> {
        let found = files(root, |name| name != ".git");
        let relative = found.iter().map(|path| path.strip_prefix(root).unwrap().display().to_string());
        let mut names: Vec<String> = relative.collect();
        names.sort();
        names
    }

    #[test]
    fn links_are_followed_but_never_in_circles() {
        let (root, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let root = root.path();
        for directory in ["a", "b/c", ".git"] {
            std::fs::create_dir_all(root.join(directory)).unwrap();
            std::fs::write(root.join(directory).join("f"), "").unwrap();
        }
        std::fs::write(outside.path().join("g"), "").unwrap();
        std::fs::create_dir(root.join("d")).unwrap();
        std::fs::write(root.join("d/g"), "").unwrap();
        symlink("d", root.join("linked")).unwrap();
        symlink(outside.path(), root.join("outside")).unwrap();
        symlink("/proc", root.join("kernel")).unwrap();
        for circle in ["a/self", "a/up", "b/c/top", "b/c/again"] {
            symlink(root, root.join(circle)).unwrap();
        }
        symlink(outside.path().parent().unwrap(), root.join("above")).unwrap();
        symlink("nowhere", root.join("dangling")).unwrap();
        assert_eq!(names(root), ["a/f", "b/c/f", "d/g", "linked/g"]);
    }

    #[test]
    fn a_walk_of_too_many_files_ends() {
        let root = tempfile::tempdir().unwrap();
        for folder in 0..MOST_ENTRIES / 100 {
            std::fs::create_dir(root.path().join(folder.to_string())).unwrap();
            for file in 0..100 {
                std::fs::write(root.path().join(format!("{folder}/{file}")), "").unwrap();
            }
        }
        let mut visited = 0;
        assert!(!walk(root.path(), |_| true, &mut |_| visited += 1));
        assert_eq!(visited, MOST_ENTRIES);
        assert!(walk(&root.path().join("0"), |_| true, &mut |_| ()));
    }

    #[test]
    fn directories_that_link_to_each_other_come_to_an_end() {
        let root = tempfile::tempdir().unwrap();
        let names: Vec<String> = (0..12).map(|index| format!("d{index}")).collect();
        for name in &names {
            std::fs::create_dir(root.path().join(name)).unwrap();
            std::fs::write(root.path().join(name).join("f"), "").unwrap();
            for other in &names {
                symlink(root.path().join(other), root.path().join(name).join(format!("to_{other}"))).unwrap();
            }
        }
        assert_eq!(files(root.path(), |_| true).len(), 12 + 12 * 11 + 12 * 11 * 10);
    }
}
