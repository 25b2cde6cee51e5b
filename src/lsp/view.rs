//! The view of one file: the files of its tree, and the declarations that a name in it can mean.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

use super::source_file::SourceFile;
use crate::shader::TreePath;
use crate::shader::symbols::{Symbol, SymbolKind};

/// The files of a tree, and the one that is asked about.
#[derive(Clone, Debug)]
pub struct View {
    /// The folder of the tree.
    pub root: PathBuf,
    /// All files with GLSL.
    pub files: BTreeMap<TreePath, Arc<SourceFile>>,
    /// The file that is asked about.
    pub current: TreePath,
    /// The files that each file includes itself, and which files include it.
    includes: BTreeMap<TreePath, Vec<TreePath>>,
    included_by: BTreeMap<TreePath, Vec<TreePath>>,
}

/// A declaration in a file.
#[derive(Clone, Copy, Debug)]
pub struct Found<'a> {
    /// The file's path.
    pub path: &'a TreePath,
    /// The file.
    pub file: &'a SourceFile,
    /// The declaration.
    pub symbol: &'a Symbol,
}

impl Found<'_> {
    /// Whether both are the same declaration.
    pub fn is(&self, other: &Found<'_>) -> bool {
        self.path == other.path && self.symbol.bytes == other.symbol.bytes
    }
}

impl View {
    /// A view of these files.
    pub fn new(root: PathBuf, files: BTreeMap<TreePath, Arc<SourceFile>>, current: TreePath) -> Self {
        let mut view = Self { root, files, current, includes: BTreeMap::new(), included_by: BTreeMap::new() };
        let of = |(path, file): (&TreePath, &Arc<SourceFile>)| {
            let found = file.symbols.includes.iter().filter_map(|(name, _)| view.included(path, name).cloned());
            (path.clone(), found.collect::<Vec<_>>())
        };
        let includes: BTreeMap<TreePath, Vec<TreePath>> = view.files.iter().map(of).collect();
        for (path, included) in &includes {
            for other in included {
                view.included_by.entry(other.clone()).or_default().push(path.clone());
            }
        }
        view.includes = includes;
        view
    }

    /// The file that is asked about.
    pub fn file(&self) -> &SourceFile {
        &self.files[&self.current]
    }

    /// The file that an include means: beside the file, or from the root.
    pub fn included(&self, from: &TreePath, name: &str) -> Option<&TreePath> {
        let mut places = from.sibling(name).into_iter().chain(TreePath::parse(name));
        places.find_map(|place| self.files.get_key_value(&place)).map(|(path, _)| path)
    }

    /// A file and all that it includes.
    pub fn closure<'a>(&'a self, path: &'a TreePath) -> Vec<&'a TreePath> {
        reached(path, &self.includes)
    }

    /// The files that include a file, directly or not, and the file.
    pub fn includers<'a>(&'a self, path: &'a TreePath) -> Vec<&'a TreePath> {
        reached(path, &self.included_by)
    }

    /// The files whose declarations a file may use, in the order in which they count: itself, what it includes, and what the files
    /// include that include it.
    pub fn visible<'a>(&'a self, path: &'a TreePath) -> Vec<&'a TreePath> {
        let mut out = self.closure(path);
        let mut seen: BTreeSet<&TreePath> = out.iter().copied().collect();
        for includer in self.includers(path) {
            out.extend(self.closure(includer).into_iter().filter(|path| seen.insert(path)));
        }
        out
    }

    /// A declaration of a file.
    pub fn found<'a>(&'a self, path: &'a TreePath, symbol: &'a Symbol) -> Option<Found<'a>> {
        Some(Found { path, file: self.files.get(path)?, symbol })
    }

    /// The declarations with a name that all of these files have for others.
    pub fn globals<'a>(&'a self, files: &[&'a TreePath], name: &str) -> Vec<Found<'a>> {
        let mut out = Vec::new();
        for path in files {
            let Some(file) = self.files.get(*path) else { continue };
            let named = file.symbols.globals().filter(|symbol| symbol.name == name);
            out.extend(named.map(|symbol| Found { path, file, symbol }));
        }
        out
    }

    /// The members of a type, in these files.
    pub fn members<'a>(&'a self, files: &[&'a TreePath], owner: &str) -> Vec<Found<'a>> {
        let mut out: Vec<Found<'a>> = Vec::new();
        for path in files {
            let Some(file) = self.files.get(*path) else { continue };
            let all =
                file.symbols.all.iter().filter(|symbol| symbol.kind == SymbolKind::Member && symbol.owner == owner);
            out.extend(all.map(|symbol| Found { path, file, symbol }));
            if !out.is_empty() {
                break;
            }
        }
        out
    }

    /// The declarations that a name at a place means if it stands behind no dot: several of an overloaded function.
    pub fn plain<'a>(&'a self, path: &'a TreePath, name: &str, bytes: &std::ops::Range<usize>) -> Vec<Found<'a>> {
        let Some(file) = self.files.get(path) else { return Vec::new() };
        let own = file.symbols.all.iter().find(|symbol| symbol.bytes == *bytes);
        let local = || file.symbols.locals(bytes.start).find(|symbol| symbol.name == name);
        match own.filter(|symbol| !symbol.is_global()).or_else(|| local().filter(|_| own.is_none())) {
            Some(symbol) => vec![Found { path, file, symbol }],
            None => self.globals(&self.visible(path), name),
        }
    }
}

/// A file, and the files that lead on from it, the nearest first.
fn reached<'a>(path: &'a TreePath, next: &'a BTreeMap<TreePath, Vec<TreePath>>) -> Vec<&'a TreePath> {
    let (mut out, mut seen) = (vec![path], BTreeSet::from([path]));
    let mut at = 0;
    while let Some(path) = out.get(at).copied() {
        at += 1;
        out.extend(next.get(path).into_iter().flatten().filter(|path| seen.insert(path)));
    }
    out
}
