//! Sources of shader text: a tree, and texts in memory that are read instead of some of its files.

pub(super) mod directory;
pub mod draft;
pub mod embedded;
mod error;
pub mod pattern;
pub mod quarantine;
mod read;
pub mod snapshot;
mod toy;
mod tree;
mod tree_path;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::shader::diagnostic::Diagnostic;
use draft::DraftText;
use embedded::Example;
use quarantine::Quarantine;
use toy::Toy;

/// The name of the tree in the program; `./built-in` is a folder.
pub const BUILT_IN: &str = "built-in";

pub use error::SourceError;
pub use read::{is_specula_tree, leads_out};
pub use tree::Tree;
pub use tree_path::TreePath;

/// The path of a file beside a single shader file, or of that file, of its path in the tree that is made of it.
pub(in crate::shader) fn opened_file(path: &str) -> Option<&str> {
    path.strip_prefix(toy::OPENED)?.strip_prefix('/')
}

fn too_many_files(path: &Path) -> String {
    format!(
        "{} has more than {} files and folders, too many for a shader tree",
        path.display(),
        directory::MOST_ENTRIES
    )
}

/// A shader tree, some of whose files may have other texts. It has the methods of its [`Tree`].
#[derive(Clone, Debug)]
pub struct Source {
    pub(in crate::shader) tree: Tree,
    /// Files whose last good texts are read: see [`Source::quarantined`].
    quarantine: Option<Arc<Quarantine>>,
    /// Texts that are not saved: see [`Source::with_draft`].
    draft: Option<Arc<BTreeMap<TreePath, DraftText>>>,
    /// Texts of an editor: see [`Source::with_editor`].
    editor: Option<Arc<BTreeMap<TreePath, Arc<str>>>>,
}

impl From<Tree> for Source {
    fn from(tree: Tree) -> Self {
        Self { tree, quarantine: None, draft: None, editor: None }
    }
}

impl Deref for Source {
    type Target = Tree;

    fn deref(&self) -> &Tree {
        &self.tree
    }
}

impl Source {
    /// The tree in a directory, which is read again at every update.
    pub fn disk(directory: impl Into<PathBuf>) -> Self {
        Tree::Disk(directory.into()).into()
    }

    /// The tree in a directory, or the tree that a single shader file makes: [`Source::is_file`].
    pub fn open(path: PathBuf) -> Self {
        if Self::is_file(&path) { Tree::Toy(Toy::new(path)).into() } else { Self::disk(path) }
    }

    /// As [`Source::open`] for a tree that is there, or for [`BUILT_IN`]. Its path does not change with the working directory. A file that
    /// belongs to a toy stands for the toy.
    ///
    /// # Errors
    /// A message: the path is neither a folder with a Specula shader tree nor a single shader file, or the folder has too many files.
    pub fn find(path: &Path) -> Result<Self, String> {
        if path == Path::new(BUILT_IN) {
            return Ok(Self::embedded());
        }
        let whole = Toy::whole(path);
        let path = whole.as_deref().unwrap_or(path);
        if is_specula_tree(path) || (Self::is_file(path) && path.exists()) {
            let source = Self::open(std::path::absolute(path).unwrap_or_else(|_| path.to_owned()));
            return if source.is_bounded() { Ok(source) } else { Err(too_many_files(path)) };
        }
        if !path.exists() {
            return Err(format!("{}: there is no such file or folder", path.display()));
        }
        Err(format!(
            "{} is no Specula shader tree: expected a folder with interface.glsl. `specula new DIR` writes one",
            path.display()
        ))
    }

    /// Whether a single shader file can be opened as a tree. Files that lie in a tree cannot.
    pub fn is_file(path: &Path) -> bool {
        !path.is_dir() && Toy::is_toy(path)
    }

    /// Whether the tree is made of a single file.
    pub fn is_toy(&self) -> bool {
        matches!(self.tree, Tree::Toy(_))
    }

    /// The path of the single file of which the tree is made.
    pub fn opened(&self) -> Option<TreePath> {
        match &self.tree {
            Tree::Toy(toy) => Some(toy.opened()),
            _ => None,
        }
    }

    /// The files of a tree that is made of a single file: this one first, and those beside it that belong to it.
    pub fn own_files(&self) -> Vec<TreePath> {
        match &self.tree {
            Tree::Toy(toy) => toy.own_files(),
            _ => Vec::new(),
        }
    }

    /// The tree that was compiled into the binary.
    pub fn embedded() -> Self {
        Self::example(None)
    }

    /// The tree that was compiled into the binary, with the files of an example.
    pub fn example(example: Option<Example>) -> Self {
        Tree::Embedded(example).into()
    }

    /// A tree in memory.
    pub fn of_texts(texts: BTreeMap<TreePath, String>) -> Self {
        Tree::Memory(texts).into()
    }

    /// A tree in memory, from `(path, text)` pairs.
    pub fn memory<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        Self::of_texts(files.into_iter().map(|(path, text)| (path.into(), text.to_owned())).collect())
    }

    /// The text of a file, without a UTF-8 byte order mark, which glslang would refuse.
    pub fn read(&self, path: &TreePath) -> Result<String, SourceError> {
        if let Some(text) = self.editor.as_ref().and_then(|texts| texts.get(path)) {
            let (bytes, most) = (text.len() as u64, error::MAX_FILE_BYTES);
            return if bytes > most {
                Err(SourceError::TooBig { bytes, most })
            } else {
                read::check_text(text.as_bytes().to_vec())
            };
        }
        let good = self.quarantine.as_ref().and_then(|quarantine| quarantine.texts.get(path));
        let own = good.map_or_else(|| self.tree.read(path), |text| Ok(text.clone()))?;
        let draft = self.draft.as_ref().and_then(|texts| texts.get(path)).filter(|draft| *own == *draft.base);
        Ok(draft.map_or(own, |draft| draft.text.to_string()))
    }

    /// The text of a file to be shown and typed: as its author wrote it. A dragged number is in place of the file's.
    pub fn author_text(&self, path: &TreePath) -> Result<String, SourceError> {
        let is_dragged = self.draft.as_ref().is_some_and(|texts| texts.contains_key(path));
        let own = if is_dragged { None } else { self.tree.author_text(path) };
        own.map_or_else(|| self.read(path), Ok)
    }

    /// The errors of a single opened file that are known before anything is compiled.
    pub fn problems(&self) -> Vec<Diagnostic> {
        // Texts that are quarantined are not those on disk.
        let is_on_disk = self.quarantine.as_ref().is_none_or(|quarantine| quarantine.texts.is_empty());
        if is_on_disk { self.tree.problems() } else { Vec::new() }
    }

    /// The warnings about a single opened file that are known before anything is compiled.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.tree.warnings()
    }

    /// The tree with other texts of these files. Each applies only while the file's own text equals `base`, so an edit of the
    /// file wins. Replaces an earlier draft.
    #[must_use]
    pub fn with_draft(&self, texts: BTreeMap<TreePath, DraftText>) -> Self {
        Self { draft: Some(Arc::new(texts)), ..self.clone() }
    }

    /// The tree without a draft.
    #[must_use]
    pub fn without_draft(&self) -> Self {
        Self { draft: None, ..self.clone() }
    }

    /// The tree with the texts that an editor has open, saved or not. They are read in place of the files, whether these exist or not.
    #[must_use]
    pub fn with_editor(&self, texts: BTreeMap<TreePath, Arc<str>>) -> Self {
        Self { editor: Some(Arc::new(texts)), ..self.clone() }
    }

    /// All files, sorted, with those that only an editor has. See [`Tree::list`].
    pub fn list(&self) -> Vec<TreePath> {
        let mut files = self.tree.list();
        files.extend(self.editor.iter().flat_map(|texts| texts.keys()).cloned());
        files.sort();
        files.dedup();
        files
    }

    /// The names of the files in a folder, sorted, with those that only an editor has. See [`Tree::folder`].
    pub fn folder(&self, folder: &str) -> Vec<String> {
        let in_folder = |path: &TreePath| {
            let (parent, name) = path.as_str().rsplit_once('/').unwrap_or(("", path.as_str()));
            (parent == folder).then(|| name.to_owned())
        };
        let mut names = self.tree.folder(folder);
        names.extend(self.editor.iter().flat_map(|texts| texts.keys()).filter_map(in_folder));
        names.sort();
        names.dedup();
        names
    }

    /// Whether some files may be quarantined, and none has a draft.
    pub fn is_quarantined(&self) -> bool {
        self.quarantine.is_some() && self.draft.is_none()
    }

    /// The `tree`, in which each file that differs from its text in `good` has that text. [`Source::released`] then returns to the
    /// files on disk, except those in `quarantined`, by path and hash of the text. `cause` is the reason that diagnostics give.
    pub fn quarantined(
        tree: &Self,
        good: &BTreeMap<TreePath, String>,
        quarantined: BTreeMap<TreePath, u64>,
        cause: &str,
    ) -> Self {
        let differs = |(path, text): &(&TreePath, &String)| tree.read(path).as_ref() != Ok(*text);
        let texts = good.iter().filter(differs).map(|(path, text)| (path.clone(), text.clone())).collect();
        let quarantine = Quarantine { texts, files: quarantined, cause: cause.to_owned() };
        Self { tree: tree.tree.clone(), quarantine: Some(Arc::new(quarantine)), draft: None, editor: None }
    }

    /// The tree with fewer files replaced, and the paths whose texts this changes. `None` if nothing can be released. All quarantined
    /// texts are released together as soon as one of them changes, since only together they are known to be good or bad.
    pub fn released(&self) -> Option<(Self, BTreeSet<TreePath>)> {
        // With an unsaved draft, the quarantine stays as it is.
        let quarantine = self.quarantine.as_ref().filter(|_| self.draft.is_none())?;
        let still = quarantine.files.iter().all(|(path, hash)| quarantine::text_hash(&self.tree.read(path)) == *hash);
        let quarantined = if still { quarantine.files.clone() } else { BTreeMap::new() };
        let (kept, released): (BTreeMap<_, _>, BTreeMap<_, _>) =
            quarantine.texts.clone().into_iter().partition(|(path, _)| quarantined.contains_key(path));
        if quarantined.is_empty() {
            return Some((
                self.tree.clone().into(),
                released.into_keys().chain(quarantine.files.keys().cloned()).collect(),
            ));
        }
        let next = Quarantine { texts: kept, files: quarantined, cause: quarantine.cause.clone() };
        let next = Self { quarantine: Some(Arc::new(next)), ..self.clone() };
        (!released.is_empty()).then(|| (next, released.into_keys().collect()))
    }

    /// The quarantined files, with the hashes of their texts.
    pub fn quarantined_files(&self) -> BTreeMap<TreePath, u64> {
        self.quarantine.as_ref().map(|quarantine| quarantine.files.clone()).unwrap_or_default()
    }

    /// An error for each quarantined file.
    pub fn refusals(&self) -> Vec<Diagnostic> {
        let Some(quarantine) = &self.quarantine else { return Vec::new() };
        let message = format!("{}, so it is refused until it changes; the last good text is used", quarantine.cause);
        quarantine.files.keys().map(|path| Diagnostic::error(self.display_path(path), message.clone())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::error::MAX_FILE_BYTES;
    use super::*;

    #[test]
    fn every_reason_has_its_own_message() {
        let directory = tempfile::tempdir().unwrap();
        let source = Source::disk(directory.path());
        let write = |name: &str, bytes: &[u8]| std::fs::write(directory.path().join(name), bytes).unwrap();
        write("nul.glsl", b"a\nb\0");
        write("latin.glsl", b"a\n\n// \xe4\n");
        write("bom.glsl", b"\xef\xbb\xbfvoid");
        write("big.glsl", &vec![b' '; MAX_FILE_BYTES as usize + 1]);
        std::fs::create_dir(directory.path().join("dir")).unwrap();
        let read = |name: &str| source.read(&name.into());
        assert_eq!(read("nul.glsl"), Err(SourceError::Nul { line: 2 }));
        assert_eq!(read("latin.glsl"), Err(SourceError::NotUtf8 { line: 3 }));
        assert_eq!(read("bom.glsl"), Ok("void".to_owned()));
        assert!(matches!(read("big.glsl"), Err(SourceError::TooBig { .. })));
        assert_eq!(read("dir"), Err(SourceError::Directory));
        assert_eq!(read("none"), Err(SourceError::Missing));
        assert_eq!(read("bom.glsl/x"), Err(SourceError::Missing));
    }

    #[test]
    fn a_draft_hides_a_file_until_that_is_edited() {
        let directory = tempfile::tempdir().unwrap();
        let write = |text: &str| std::fs::write(directory.path().join("a.glsl"), text).unwrap();
        write("old");
        std::fs::write(directory.path().join("b.glsl"), "old").unwrap();
        let source = Source::disk(directory.path());
        let (a, b) = (TreePath::from("a.glsl"), TreePath::from("b.glsl"));
        let of_a = |text: &str| BTreeMap::from([(a.clone(), DraftText { base: "old".into(), text: text.into() })]);
        let draft = source.with_draft(of_a("first")).with_draft(of_a("draft"));
        assert_eq!((draft.read(&a), draft.read(&b)), (Ok("draft".to_owned()), Ok("old".to_owned())));
        assert_eq!((draft.root(), draft.list()), (source.root(), source.list()));
        write("edited");
        assert_eq!(draft.read(&a), Ok("edited".to_owned()));
        assert_eq!(draft.without_draft().read(&a), Ok("edited".to_owned()));
    }

    #[test]
    fn the_texts_of_an_editor_win_also_without_a_file() {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("a.glsl"), "old").unwrap();
        let texts = [("a.glsl", "new"), ("lib/b.glsl", "\u{feff}only here")];
        let texts = texts.map(|(path, text)| (TreePath::from(path), Arc::from(text)));
        let source = Source::disk(directory.path()).with_editor(BTreeMap::from(texts));
        let read = |path: &str| source.read(&path.into());
        assert_eq!((read("a.glsl"), read("lib/b.glsl")), (Ok("new".to_owned()), Ok("only here".to_owned())));
        assert_eq!(source.list(), ["a.glsl", "lib/b.glsl"].map(TreePath::from));
        assert_eq!((source.folder(""), source.folder("lib")), (vec!["a.glsl".to_owned()], vec!["b.glsl".to_owned()]));
    }

    #[test]
    fn a_refused_text_is_read_once_one_of_them_changes() {
        let directory = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).unwrap();
        let paths = ["a.glsl", "b.glsl", "c.glsl", "same.glsl"].map(TreePath::from);
        let [a, b, c, same] = &paths;
        paths.iter().for_each(|path| write(path.as_str(), "new"));
        let good = [(a, "old a"), (b, "old b"), (same, "new")].map(|(path, text)| (path.clone(), text.to_owned()));
        let hash = quarantine::text_hash(&Ok("new".to_owned()));
        // `c` is a new file, which has no last good text.
        let quarantined = BTreeMap::from([(a.clone(), hash), (c.clone(), hash)]);
        let quarantine =
            Source::quarantined(&Source::disk(directory.path()), &BTreeMap::from(good), quarantined, "lost");
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
