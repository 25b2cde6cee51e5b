//! Follows a path, link by link, and records every directory entry on the way: a change of any of them may change the file
//! to which the path leads.

use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};

/// Linux gives up after this many links, too.
const MAX_LINKS: usize = 40;

/// The resolution of a path.
#[derive(Debug, PartialEq, Eq)]
pub struct Trail {
    /// Each directory, without symbolic links, and the name that was looked up in it. The last step is the entry where the
    /// path ends, or the first entry that is missing.
    pub steps: Vec<(PathBuf, OsString)>,
    /// Whether no name was left to look up after the last step.
    pub complete: bool,
    /// The file or directory to which the path leads, without symbolic links; `None` when an entry is missing.
    pub end: Option<PathBuf>,
}

/// Follows `path`, which may be relative to the working directory. `enter` is called with each directory before a name is
/// looked up in it, and with whether that name is the last one of a path.
pub fn follow(path: &Path, mut enter: impl FnMut(&Path, bool)) -> Trail {
    let mut trail = Trail { steps: Vec::new(), complete: false, end: None };
    let Ok(path) = std::path::absolute(path) else { return trail };
    let mut here = PathBuf::new();
    // Names that are left to look up, the next one last.
    let mut left = Vec::new();
    push(&mut left, &mut here, &path);
    let mut links = 0;
    while let Some(name) = left.pop() {
        if name == ".." {
            here.pop();
            continue;
        }
        enter(&here, left.is_empty());
        let next = here.join(&name);
        trail.steps.push((here.clone(), name));
        trail.complete = left.is_empty();
        match next.symlink_metadata() {
            Ok(metadata) if metadata.is_symlink() => {
                links += 1;
                let Ok(target) = next.read_link() else { return trail };
                if links > MAX_LINKS {
                    return trail;
                }
                push(&mut left, &mut here, &target);
            }
            Ok(_) => here = next,
            Err(_) => return trail,
        }
    }
    trail.end = Some(here);
    trail
}

/// Puts the names of `path` before those that are left. An absolute path starts again at its root.
fn push(left: &mut Vec<OsString>, here: &mut PathBuf, path: &Path) {
    if path.is_absolute() {
        let is_root = |part: &Component<'_>| matches!(part, Component::Prefix(_) | Component::RootDir);
        *here = path.components().take_while(is_root).collect();
    }
    left.extend(path.components().rev().filter_map(|part| match part {
        Component::Normal(name) => Some(name.to_owned()),
        Component::ParentDir => Some("..".into()),
        _ => None,
    }));
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn links_are_followed_one_by_one() {
        let directory = tempfile::tempdir().unwrap();
        let top = directory.path().canonicalize().unwrap();
        std::fs::create_dir_all(top.join("real/deep")).unwrap();
        std::fs::write(top.join("real/f"), "").unwrap();
        symlink("real/deep", top.join("folder")).unwrap();
        symlink("../f", top.join("real/deep/link")).unwrap();
        let trail = follow(&top.join("folder/link"), |_, _| {});
        assert_eq!(trail.end, Some(top.join("real/f")));
        let above = top.components().count() - 1;
        let own = |(folder, name): &(PathBuf, OsString)| {
            (folder.strip_prefix(&top).unwrap().display().to_string(), name.to_str().unwrap().to_owned())
        };
        let steps: Vec<_> = trail.steps[above..].iter().map(own).collect();
        let step = |folder: &str, name: &str| (folder.to_owned(), name.to_owned());
        // The names that `..` leaves again were looked up, too.
        let expected = [step("", "folder"), step("", "real"), step("real", "deep"), step("real/deep", "link")];
        assert_eq!(steps[..4], expected);
        assert_eq!(steps[4..], [step("real", "f")]);
    }

    #[test]
    fn missing_entries_and_circles_end_the_trail() {
        let directory = tempfile::tempdir().unwrap();
        let top = directory.path().canonicalize().unwrap();
        let missing = follow(&top.join("a/b"), |_, _| {});
        assert_eq!((missing.end, missing.complete), (None, false));
        assert_eq!(missing.steps.last(), Some(&(top.clone(), "a".into())));
        let last = follow(&top.join("a"), |_, _| {});
        assert_eq!((last.end, last.complete), (None, true));
        symlink("circle", top.join("circle")).unwrap();
        assert_eq!(follow(&top.join("circle"), |_, _| {}).end, None);
    }
}
