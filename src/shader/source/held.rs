//! A shader tree on disk, some of whose files are held back: their last good texts are read instead. A window starts with such
//! a tree after the device was lost, so that the text that may have caused the loss does not cause the next.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use xxhash_rust::xxh3::xxh3_64;

use super::{Source, SourceError, TreePath};
use crate::shader::diagnostic::Diagnostic;

/// A tree on disk and the texts that are read instead of some of its files.
#[derive(Debug)]
pub struct Held {
    tree: Source,
    /// The last good texts of files that differ from them.
    texts: BTreeMap<TreePath, String>,
    /// Hashes of the texts on disk that are refused, see [`text_hash`]. A file without a last good text may be among them.
    refused: BTreeMap<TreePath, u64>,
    /// Why, for the diagnostics.
    cause: String,
}

impl Source {
    /// The `tree`, in which each file that differs from its text in `good` has that text. [`Source::released`] goes on to
    /// the files on disk, but for the refused ones, by path and [`text_hash`]. `cause` says why, after "FILE: error: ".
    pub fn held(tree: Self, good: &BTreeMap<TreePath, String>, refused: BTreeMap<TreePath, u64>, cause: &str) -> Self {
        let differs = |(path, text): &(&TreePath, &String)| tree.read(path).as_ref() != Ok(*text);
        let texts = good.iter().filter(differs).map(|(path, text)| (path.clone(), text.clone())).collect();
        Self::Held(Arc::new(Held { tree, texts, refused, cause: cause.to_owned() }))
    }

    /// The tree with fewer files held back, and the paths whose texts this changes. `None` if nothing is to be released. All
    /// refused texts are released together as soon as one of them changes, since only together they are known to be good or bad.
    pub fn released(&self) -> Option<(Self, BTreeSet<TreePath>)> {
        // A number is being dragged: what is held back stays so.
        let Self::Held(held) = self else { return None };
        let disk = &held.tree;
        let still = held.refused.iter().all(|(path, hash)| text_hash(&disk.read(path)) == *hash);
        let refused = if still { held.refused.clone() } else { BTreeMap::new() };
        let (kept, released): (BTreeMap<_, _>, BTreeMap<_, _>) =
            held.texts.clone().into_iter().partition(|(path, _)| refused.contains_key(path));
        if refused.is_empty() {
            return Some((disk.clone(), released.into_keys().chain(held.refused.keys().cloned()).collect()));
        }
        let next = Held { tree: disk.clone(), texts: kept, refused, cause: held.cause.clone() };
        (!released.is_empty()).then(|| (Self::Held(Arc::new(next)), released.into_keys().collect()))
    }

    /// The files whose texts are refused, with the hashes of these texts.
    pub fn refused(&self) -> BTreeMap<TreePath, u64> {
        if let Self::Held(held) = self.without_draft() { held.refused.clone() } else { BTreeMap::new() }
    }

    /// An error for each refused file.
    pub fn refusals(&self) -> Vec<Diagnostic> {
        let Self::Held(held) = self.without_draft() else { return Vec::new() };
        let message = format!("{}, so it is refused until it changes; the last good text is used", held.cause);
        held.refused.keys().map(|path| Diagnostic::error(self.display_path(path), message.clone())).collect()
    }
}

impl Held {
    pub(super) fn tree(&self) -> &Source {
        &self.tree
    }

    /// Whether all texts are those on disk.
    pub(super) fn is_released(&self) -> bool {
        self.texts.is_empty()
    }

    pub(super) fn text(&self, path: &TreePath) -> Option<&String> {
        self.texts.get(path)
    }
}

/// A hash of a file's text, or of the reason why it cannot be read, that is the same in every process.
pub fn text_hash(read: &Result<String, SourceError>) -> u64 {
    match read {
        Ok(text) => xxh3_64(text.as_bytes()),
        Err(error) => xxh3_64(error.to_string().as_bytes()).wrapping_add(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_text_is_read_once_one_of_them_changes() {
        let directory = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).unwrap();
        let paths = ["a.glsl", "b.glsl", "c.glsl", "same.glsl"].map(TreePath::from);
        let [a, b, c, same] = &paths;
        paths.iter().for_each(|path| write(path.as_str(), "new"));
        let good = [(a, "old a"), (b, "old b"), (same, "new")].map(|(path, text)| (path.clone(), text.to_owned()));
        let hash = text_hash(&Ok("new".to_owned()));
        // `c` is a new file, which has no last good text.
        let refused = BTreeMap::from([(a.clone(), hash), (c.clone(), hash)]);
        let held = Source::held(Source::Disk(directory.path().to_owned()), &BTreeMap::from(good), refused, "lost");
        let read = |source: &Source| paths.each_ref().map(|path| source.read(path).unwrap());
        assert_eq!(read(&held), ["old a", "old b", "new", "new"]);

        let (held, changed) = held.released().unwrap();
        assert_eq!(changed, BTreeSet::from([b.clone()]));
        assert_eq!(read(&held), ["old a", "new", "new", "new"]);
        assert!(held.released().is_none(), "nothing has changed");
        assert_eq!(held.refusals().len(), 2);

        write("c.glsl", "repaired");
        let (disk, changed) = held.released().unwrap();
        assert_eq!(changed, BTreeSet::from([a.clone(), c.clone()]));
        assert_eq!(read(&disk), ["new", "new", "repaired", "new"]);
        assert!(disk.released().is_none() && disk.refusals().is_empty());
    }
}
