//! A shader tree on disk, some of whose files are quarantined: the compiler reads their last good texts instead. A window starts
//! with such a tree after the device was lost, so that the text that may have caused the loss does not cause the next.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use xxhash_rust::xxh3::xxh3_64;

use super::{Source, SourceError, TreePath};
use crate::shader::diagnostic::Diagnostic;

/// A tree on disk and the texts that are read instead of some of its files.
#[derive(Debug)]
pub struct Quarantine {
    tree: Source,
    /// The last good texts of files that differ from them.
    texts: BTreeMap<TreePath, String>,
    /// Hashes of the quarantined texts on disk, see [`text_hash`]. A file without a last good text may be among them.
    files: BTreeMap<TreePath, u64>,
    /// Why, for the diagnostics.
    cause: String,
}

impl Source {
    /// The `tree`, in which each file that differs from its text in `good` has that text. [`Source::released`] then returns to the
    /// files on disk, except those in `quarantined`, by path and [`text_hash`]. `cause` is the reason that diagnostics give.
    pub fn quarantined(
        tree: Self,
        good: &BTreeMap<TreePath, String>,
        quarantined: BTreeMap<TreePath, u64>,
        cause: &str,
    ) -> Self {
        let differs = |(path, text): &(&TreePath, &String)| tree.read(path).as_ref() != Ok(*text);
        let texts = good.iter().filter(differs).map(|(path, text)| (path.clone(), text.clone())).collect();
        Self::Quarantined(Arc::new(Quarantine { tree, texts, files: quarantined, cause: cause.to_owned() }))
    }

    /// The tree with fewer files replaced, and the paths whose texts this changes. `None` if nothing can be released. All quarantined
    /// texts are released together as soon as one of them changes, since only together they are known to be good or bad.
    pub fn released(&self) -> Option<(Self, BTreeSet<TreePath>)> {
        // With an unsaved draft on top, the quarantine stays as it is.
        let Self::Quarantined(quarantine) = self else { return None };
        let disk = &quarantine.tree;
        let still = quarantine.files.iter().all(|(path, hash)| text_hash(&disk.read(path)) == *hash);
        let quarantined = if still { quarantine.files.clone() } else { BTreeMap::new() };
        let (kept, released): (BTreeMap<_, _>, BTreeMap<_, _>) =
            quarantine.texts.clone().into_iter().partition(|(path, _)| quarantined.contains_key(path));
        if quarantined.is_empty() {
            return Some((disk.clone(), released.into_keys().chain(quarantine.files.keys().cloned()).collect()));
        }
        let next = Quarantine { tree: disk.clone(), texts: kept, files: quarantined, cause: quarantine.cause.clone() };
        (!released.is_empty()).then(|| (Self::Quarantined(Arc::new(next)), released.into_keys().collect()))
    }

    /// The quarantined files, with the hashes of their texts.
    pub fn quarantined_files(&self) -> BTreeMap<TreePath, u64> {
        if let Self::Quarantined(quarantine) = self.without_draft() {
            quarantine.files.clone()
        } else {
            BTreeMap::new()
        }
    }

    /// An error for each quarantined file.
    pub fn refusals(&self) -> Vec<Diagnostic> {
        let Self::Quarantined(quarantine) = self.without_draft() else { return Vec::new() };
        let message = format!("{}, so it is refused until it changes; the last good text is used", quarantine.cause);
        quarantine.files.keys().map(|path| Diagnostic::error(self.display_path(path), message.clone())).collect()
    }
}

impl Quarantine {
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

/// A hash of a file's text, or of the reason why it cannot be read. It is the same in every process.
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
        let quarantined = BTreeMap::from([(a.clone(), hash), (c.clone(), hash)]);
        let quarantine =
            Source::quarantined(Source::Disk(directory.path().to_owned()), &BTreeMap::from(good), quarantined, "lost");
        let read = |source: &Source| paths.each_ref().map(|path| source.read(path).unwrap());
        assert_eq!(read(&quarantine), ["old a", "old b", "new", "new"]);

        let (quarantine, changed) = quarantine.released().unwrap();
        assert_eq!(changed, BTreeSet::from([b.clone()]));
        assert_eq!(read(&quarantine), ["old a", "new", "new", "new"]);
        assert!(quarantine.released().is_none(), "nothing has changed");
        assert_eq!(quarantine.refusals().len(), 2);

        write("c.glsl", "repaired");
        let (disk, changed) = quarantine.released().unwrap();
        assert_eq!(changed, BTreeSet::from([a.clone(), c.clone()]));
        assert_eq!(read(&disk), ["new", "new", "repaired", "new"]);
        assert!(disk.released().is_none() && disk.refusals().is_empty());
    }
}
