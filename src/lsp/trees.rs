//! The shader trees of the open files, and the texts of their files.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use lsp_types::Uri;

use super::documents::Documents;
use super::source_file::SourceFile;
use super::source_text::SourceText;
use super::uri::{path_of, uri_of};
use super::view::View;
use crate::shader::{Source, StageKind, TreePath, is_specula_tree};

/// The state of a file on disk when it was read.
type Stamp = (Option<SystemTime>, u64);

/// Texts of files that were read.
#[derive(Debug, Default)]
pub struct Trees {
    read: HashMap<PathBuf, (Stamp, Arc<SourceFile>)>,
}

/// The folder of the shader tree that a file lies in.
pub fn root_of(path: &Path) -> Option<PathBuf> {
    path.ancestors().skip(1).find(|folder| is_specula_tree(folder)).map(Path::to_owned)
}

/// The path in a tree of a file on disk.
pub fn tree_path(root: &Path, path: &Path) -> Option<TreePath> {
    let parts: Option<Vec<&str>> = path.strip_prefix(root).ok()?.iter().map(|part| part.to_str()).collect();
    TreePath::parse(&parts?.join("/"))
}

/// Whether a file of a tree holds GLSL.
pub fn is_glsl(path: &TreePath) -> bool {
    path.extension() == Some("glsl") || StageKind::of(path).is_some()
}

impl Trees {
    /// The files that a file sees: its tree, or, outside of trees, itself and what it includes.
    pub fn view(&mut self, documents: &Documents, uri: &Uri) -> Option<View> {
        let Some(path) = path_of(uri) else { return self.alone(documents, uri) };
        match root_of(&path) {
            Some(root) => {
                let current = tree_path(&root, &path)?;
                self.of_tree(documents, &root, Some(current))
            }
            None => self.beside(documents, &path),
        }
    }

    /// All files of a tree.
    pub fn of_tree(&mut self, documents: &Documents, root: &Path, current: Option<TreePath>) -> Option<View> {
        let mut files: BTreeMap<TreePath, Arc<SourceFile>> = open_in(documents, root).collect();
        for path in Source::disk(root).list().into_iter().filter(is_glsl) {
            if !files.contains_key(&path) {
                let read = self.file(&root.join(path.as_str()));
                files.extend(read.map(|file| (path, file)));
            }
        }
        let current = current.filter(|path| files.contains_key(path)).or_else(|| files.keys().next().cloned())?;
        Some(View::new(root.to_owned(), files, current))
    }

    /// A file that is in no tree, with what it includes.
    fn beside(&mut self, documents: &Documents, path: &Path) -> Option<View> {
        let root = path.parent()?;
        let current = tree_path(root, path)?;
        let mut files: BTreeMap<TreePath, Arc<SourceFile>> =
            open_in(documents, root).filter(|(path, _)| *path == current).collect();
        let mut wanted = vec![current.clone()];
        while let Some(next) = wanted.pop() {
            if !files.contains_key(&next) {
                let Some(file) = self.file(&root.join(next.as_str())) else { continue };
                files.insert(next.clone(), file);
            }
            let names = files[&next].symbols.includes.iter().map(|(name, _)| name);
            let found: Vec<TreePath> = names.filter_map(|name| next.sibling(name)).collect();
            wanted.extend(found.into_iter().filter(|path| !files.contains_key(path)));
        }
        files.contains_key(&current).then(|| View::new(root.to_owned(), files, current))
    }

    /// A text that is no file.
    fn alone(&self, documents: &Documents, uri: &Uri) -> Option<View> {
        let file = documents.get(uri)?.file.clone();
        let current = TreePath::from("untitled.glsl");
        Some(View::new(PathBuf::new(), BTreeMap::from([(current.clone(), file)]), current))
    }

    /// A file on disk.
    fn file(&mut self, path: &Path) -> Option<Arc<SourceFile>> {
        let metadata = std::fs::metadata(path).ok()?;
        let stamp = (metadata.modified().ok(), metadata.len());
        if let Some((_, known)) = self.read.get(path).filter(|(of, _)| *of == stamp) {
            return Some(known.clone());
        }
        let folder = path.parent()?;
        let name = TreePath::parse(path.file_name()?.to_str()?)?;
        // It refuses what is no regular file, too long or no text.
        let text = Source::disk(folder).read(&name).ok()?;
        let file = Arc::new(SourceFile::new(uri_of(path)?, SourceText::new(&text)));
        self.read.insert(path.to_owned(), (stamp, file.clone()));
        Some(file)
    }
}

/// The open files of a tree.
pub fn open_in(documents: &Documents, root: &Path) -> impl Iterator<Item = (TreePath, Arc<SourceFile>)> {
    let root = root.to_owned();
    documents.with_paths().filter_map(move |(path, file)| Some((tree_path(&root, path)?, file.clone())))
}
