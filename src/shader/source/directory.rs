//! The files below a directory, symbolic links followed, without walking in circles.

use std::path::{Path, PathBuf};

/// Deep enough for any tree.
const MAX_DEPTH: usize = 16;
/// A link within a linked directory is followed, one within that is not: directories that link to each other crosswise
/// have exponentially many paths, though none of them is a circle.
const MAX_NESTED_LINKS: usize = 2;

/// All files below a directory whose names, and those of the directories above them, `keep` takes; unsorted. A link to
/// a directory is followed unless it leads back to one that it lies in.
pub fn files(directory: &Path, keep: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let mut out = Vec::new();
    let above = directory.canonicalize().into_iter().collect();
    Walk { keep, above, links: 0 }.descend(directory, &mut out);
    out
}

struct Walk<F> {
    keep: F,
    /// Where the directory at hand and those it was reached through really are.
    above: Vec<PathBuf>,
    /// Links on the way.
    links: usize,
}

impl<F: Fn(&str) -> bool> Walk<F> {
    fn descend(&mut self, directory: &Path, out: &mut Vec<PathBuf>) {
        let Ok(entries) = std::fs::read_dir(directory) else { return };
        for entry in entries.flatten() {
            let path = entry.path();
            if !(self.keep)(&entry.file_name().to_string_lossy()) {
                continue;
            }
            if path.is_file() {
                out.push(path);
            } else if path.is_dir() && self.above.len() < MAX_DEPTH {
                let is_link = entry.file_type().is_ok_and(|kind| kind.is_symlink());
                self.enter(&path, is_link, out);
            }
        }
    }

    fn enter(&mut self, directory: &Path, is_link: bool, out: &mut Vec<PathBuf>) {
        let Ok(real) = directory.canonicalize() else { return };
        // A linked directory may lie above one that was reached, without having been passed through.
        let is_circle = self.above.iter().any(|above| above.starts_with(&real));
        if is_link && (is_circle || self.links >= MAX_NESTED_LINKS) {
            return;
        }
        self.links += usize::from(is_link);
        self.above.push(real);
        self.descend(directory, out);
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
        symlink(outside.path(), root.join("linked")).unwrap();
        for circle in ["a/self", "a/up", "b/c/top", "b/c/again"] {
            symlink(root, root.join(circle)).unwrap();
        }
        symlink(outside.path().parent().unwrap(), root.join("above")).unwrap();
        symlink("nowhere", root.join("dangling")).unwrap();
        assert_eq!(names(root), ["a/f", "b/c/f", "linked/g"]);
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
