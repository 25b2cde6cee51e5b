//! Shader trees: a directory, the tree inside the binary, a single file of another playground, or memory (for tests).

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::directory;
use super::embedded::{self, Example};
use super::error::{MAX_IMAGE_BYTES, SourceError};
use super::read::{check_text, names_in, read_bytes, read_file};
use super::toy::{OPENED, Toy};
use super::tree_path::TreePath;
use crate::shader::diagnostic::Diagnostic;

/// Where the texts of a shader tree are.
#[derive(Clone, Debug)]
pub enum Tree {
    /// A directory, read again at every update.
    Disk(PathBuf),
    /// The tree inside the binary, or that of an example.
    Embedded(Option<Example>),
    /// A single file of another playground.
    Toy(Toy),
    /// Text in memory.
    Memory(BTreeMap<TreePath, String>),
}

impl Tree {
    /// The text of a file, without a UTF-8 byte order mark, which glslang would refuse.
    pub fn read(&self, path: &TreePath) -> Result<String, SourceError> {
        match self {
            Self::Disk(root) => read_file(root, path.as_str()),
            Self::Toy(toy) => toy.read(path),
            Self::Embedded(example) => check_text(embedded::read(*example, path).ok_or(SourceError::Missing)?.to_vec()),
            Self::Memory(files) => check_text(files.get(path).ok_or(SourceError::Missing)?.clone().into_bytes()),
        }
    }

    /// The bytes of a file, of an image for example.
    pub fn read_bytes(&self, path: &TreePath) -> Result<Vec<u8>, SourceError> {
        match self {
            Self::Disk(root) => read_bytes(root, path.as_str(), MAX_IMAGE_BYTES),
            Self::Toy(toy) => toy.read_bytes(path),
            Self::Memory(files) => Ok(files.get(path).ok_or(SourceError::Missing)?.clone().into_bytes()),
            Self::Embedded(example) => Ok(embedded::read(*example, path).ok_or(SourceError::Missing)?.to_vec()),
        }
    }

    /// The path for messages. For a directory, an editor can open it from the working directory.
    pub fn display_path(&self, path: &TreePath) -> String {
        match self {
            Self::Toy(toy) => toy.display_path(path),
            Self::Disk(root) if root != Path::new(".") => root.join(path.as_str()).display().to_string(),
            Self::Disk(_) | Self::Memory(_) => path.to_string(),
            Self::Embedded(_) => format!("embedded:{path}"),
        }
    }

    /// A path for messages, relative to the tree: without the folder in which all its files are.
    pub fn in_tree<'a>(&self, displayed: &'a str) -> &'a str {
        let folder = self.folder_of_files().map(|folder| folder.display().to_string()).filter(|folder| folder != ".");
        let below = |folder: &String| displayed.strip_prefix(folder)?.strip_prefix('/');
        folder.as_ref().and_then(below).unwrap_or(displayed)
    }

    /// All files, sorted, without hidden files and directories (of editors and git).
    pub fn list(&self) -> Vec<TreePath> {
        match self {
            Self::Toy(toy) => toy.list(),
            Self::Disk(root) => {
                let tree_path = |path: &PathBuf| {
                    let names: Option<Vec<&str>> = path.strip_prefix(root).ok()?.iter().map(OsStr::to_str).collect();
                    TreePath::parse(&names?.join("/"))
                };
                let found = directory::files(root, is_listed);
                let mut out: Vec<TreePath> = found.iter().filter_map(tree_path).collect();
                out.sort();
                out
            }
            Self::Memory(files) => files.keys().cloned().collect(),
            Self::Embedded(example) => embedded::list(*example),
        }
    }

    /// Whether the tree has no more files than [`Tree::list`] finds.
    pub(super) fn is_bounded(&self) -> bool {
        self.root().is_none_or(|root| directory::walk(root, is_listed, &mut |_| ()))
    }

    /// The names of the files in a folder, sorted, without hidden files. An empty path is the root.
    pub fn folder(&self, folder: &str) -> Vec<String> {
        let mut names = match self {
            Self::Disk(root) => names_in(&root.join(folder)),
            Self::Toy(toy) => toy.names_in(folder),
            Self::Embedded(_) | Self::Memory(_) => {
                let in_folder = |path: &TreePath| {
                    let (parent, name) = path.as_str().rsplit_once('/').unwrap_or(("", path.as_str()));
                    (parent == folder).then(|| name.to_owned())
                };
                self.list().iter().filter_map(in_folder).collect()
            }
        };
        names.sort();
        names
    }

    /// The directory of a tree that is one on disk. All of it is watched.
    pub fn root(&self) -> Option<&Path> {
        match self {
            Self::Disk(root) => Some(root),
            Self::Embedded(_) | Self::Memory(_) | Self::Toy(_) => None,
        }
    }

    /// The directory or file that [`super::Source::open`] opens; `None` for a tree that is not on disk.
    pub fn location(&self) -> Option<&Path> {
        match self {
            Self::Toy(toy) => Some(toy.file()),
            _ => self.root(),
        }
    }

    /// The folder that holds the files of the tree that can be written.
    pub fn folder_of_files(&self) -> Option<&Path> {
        match self {
            Self::Toy(toy) => Some(toy.folder()),
            _ => self.root(),
        }
    }

    /// The folder of the tree that is [`Self::folder_of_files`]; empty for the root.
    pub fn path_of_folder(&self) -> &'static str {
        match self {
            Self::Toy(_) => OPENED,
            _ => "",
        }
    }

    /// The path of a file below [`Self::folder_of_files`]; `None` if it is not on disk.
    pub fn path_of_file(&self, path: &TreePath) -> Option<TreePath> {
        match self {
            Self::Toy(toy) => toy.path_of_file(path),
            _ => self.root().map(|_| path.clone()),
        }
    }

    /// The text of a file as its author wrote it, where [`Self::read`] returns another one. Both have the same lines.
    pub fn author_text(&self, path: &TreePath) -> Option<String> {
        match self {
            Self::Toy(toy) => toy.author_text(path),
            _ => None,
        }
    }

    /// The files to watch of a tree that has no directory of its own. They change with the texts.
    pub fn files(&self) -> Vec<PathBuf> {
        match self {
            Self::Toy(toy) => toy.watched(),
            _ => Vec::new(),
        }
    }

    /// The paths of the tree whose text a change of this file on disk may change.
    pub fn changed(&self, file: &Path) -> Vec<TreePath> {
        match self {
            Self::Toy(toy) => toy.changed(file),
            _ => {
                let relative = self.root().and_then(|root| file.strip_prefix(root).ok());
                relative.and_then(|path| TreePath::parse(&path.to_string_lossy())).into_iter().collect()
            }
        }
    }

    /// The errors of a single opened file that are known before anything is compiled.
    pub fn problems(&self) -> Vec<Diagnostic> {
        match self {
            Self::Toy(toy) => toy.problems(),
            _ => Vec::new(),
        }
    }

    /// The warnings about a single opened file that are known before anything is compiled.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        match self {
            Self::Toy(toy) => toy.warnings(),
            _ => Vec::new(),
        }
    }

    /// A diagnostic as the author of the tree should see it: with the author's line, also where another text is compiled.
    #[must_use]
    pub fn explained(&self, diagnostic: Diagnostic) -> Diagnostic {
        match self {
            Self::Toy(toy) => toy.explained(diagnostic),
            _ => diagnostic,
        }
    }

    /// The name of the tree in messages: its folder, or that it is built in.
    pub fn name(&self) -> String {
        match self {
            Self::Embedded(Some(example)) => format!("examples:{}", example.name()),
            _ => self.location().map_or_else(|| "built-in shaders".to_owned(), |root| root.display().to_string()),
        }
    }
}

/// Editors and git keep hidden files in a tree.
fn is_listed(name: &str) -> bool {
    !name.starts_with('.')
}
