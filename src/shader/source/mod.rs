//! Sources of shader text: a directory, the tree inside the binary, or memory (for tests).

pub(super) mod directory;
pub mod draft;
pub mod embedded;
pub mod pattern;
pub mod quarantine;
mod read;
pub mod snapshot;
mod toy;

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;

use crate::shader::diagnostic::Diagnostic;

use draft::Draft;
use embedded::Example;
use quarantine::Quarantine;
use read::{check_text, names_in, read_bytes, read_file};
use toy::Toy;

/// Maximum size of a file in bytes. No shader is longer, and shaderc would hold several copies.
pub const MAX_FILE_BYTES: u64 = 4 << 20;
/// Largest size of an image file.
pub const MAX_IMAGE_BYTES: u64 = 256 << 20;

/// The path of a file in a shader tree: relative to the root, normalized, with forward slashes.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct TreePath(String);

impl TreePath {
    /// Normalizes `.` and `..`. `None` if the path is absolute, leaves the root, or is the root itself.
    pub fn parse(path: &str) -> Option<Self> {
        if path.starts_with('/') {
            return None;
        }
        let mut parts: Vec<&str> = Vec::new();
        for part in path.split('/') {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop()?;
                }
                part => parts.push(part),
            }
        }
        if parts.is_empty() { None } else { Some(Self(parts.join("/"))) }
    }

    /// Resolves `relative` from the directory of this file. `None` if the result leaves the root.
    pub fn sibling(&self, relative: &str) -> Option<Self> {
        match self.0.rsplit_once('/') {
            Some((directory, _)) if !relative.starts_with('/') => Self::parse(&format!("{directory}/{relative}")),
            _ => Self::parse(relative),
        }
    }

    /// The path as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The text after the last dot of the file name.
    pub fn extension(&self) -> Option<&str> {
        let name = self.0.rsplit('/').next()?;
        name.rsplit_once('.').map(|(_, extension)| extension)
    }

    /// The path without its extension: `ibl/dfg` of `ibl/dfg.comp`.
    pub fn stem(&self) -> &str {
        match self.extension() {
            Some(extension) => &self.0[..self.0.len() - extension.len() - 1],
            None => &self.0,
        }
    }
}

impl From<&str> for TreePath {
    /// Converts paths in source code. A `..` that would leave the root stays at the root. Use [`TreePath::parse`], which refuses
    /// such a path, for input.
    fn from(path: &str) -> Self {
        let mut parts: Vec<&str> = Vec::new();
        for part in path.split('/') {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop();
                }
                part => parts.push(part),
            }
        }
        Self(parts.join("/"))
    }
}

impl fmt::Display for TreePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Why a file of a tree cannot be used. The message continues "FILE ...".
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SourceError {
    /// No such file.
    #[error("does not exist")]
    Missing,
    /// A directory instead of a file.
    #[error("is a directory, expected a GLSL file")]
    Directory,
    /// The file is not UTF-8.
    #[error("is not UTF-8 text (line {line}); save it as UTF-8")]
    NotUtf8 {
        /// First bad line, from 1.
        line: u32,
    },
    /// A NUL byte, which the compiler would treat as the end of the text.
    #[error("holds a NUL byte (line {line}); is it a binary file, or still being written?")]
    Nul {
        /// 1-based.
        line: u32,
    },
    /// Larger than [`MAX_FILE_BYTES`], or [`MAX_IMAGE_BYTES`] for an image.
    #[error("has {bytes} bytes, more than the {most} that such a file may have")]
    TooBig {
        /// Size found.
        bytes: u64,
        /// Largest size.
        most: u64,
    },
    /// Any other error of the system.
    #[error("cannot be read: {0}")]
    Io(String),
}

/// A shader tree.
#[derive(Clone, Debug)]
pub enum Source {
    /// A directory, read again at every update.
    Disk(PathBuf),
    /// A directory, some of whose files are quarantined: see [`Source::quarantined`].
    Quarantined(Arc<Quarantine>),
    /// A tree with other texts of some files in memory: see [`Source::with_draft`].
    Draft(Arc<Draft>),
    /// The tree inside the binary, or that of an example.
    Embedded(Option<Example>),
    /// A single file of another playground.
    Toy(Arc<Toy>),
    /// Text in memory.
    Memory(BTreeMap<TreePath, String>),
}

impl Source {
    /// The tree in a directory, or the tree that a single shader file makes: [`Source::is_file`].
    pub fn open(path: PathBuf) -> Self {
        if Self::is_file(&path) { Self::Toy(Arc::new(Toy::new(path))) } else { Self::Disk(path) }
    }

    /// As [`Source::open`] for a tree that is there. Its path does not change with the working directory.
    ///
    /// # Errors
    /// A message: the path is neither a folder with a Specula shader tree nor a single shader file.
    pub fn find(path: &Path) -> Result<Self, String> {
        if is_specula_tree(path) || (Self::is_file(path) && path.exists()) {
            return Ok(Self::open(std::path::absolute(path).unwrap_or_else(|_| path.to_owned())));
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

    /// The tree that was compiled into the binary.
    pub fn embedded() -> Self {
        Self::Embedded(None)
    }

    /// A tree in memory, from `(path, text)` pairs.
    pub fn memory<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        Self::Memory(files.into_iter().map(|(path, text)| (path.into(), text.to_owned())).collect())
    }

    /// The text of a file, without a UTF-8 byte order mark, which glslang would refuse.
    pub fn read(&self, path: &TreePath) -> Result<String, SourceError> {
        match self {
            Self::Disk(root) => read_file(&root.join(path.as_str())),
            Self::Quarantined(quarantine) => match quarantine.text(path) {
                Some(text) => Ok(text.clone()),
                None => quarantine.tree().read(path),
            },
            Self::Draft(draft) => draft.read(path),
            Self::Toy(toy) => toy.read(path),
            Self::Embedded(example) => check_text(embedded::read(*example, path).ok_or(SourceError::Missing)?.to_vec()),
            Self::Memory(files) => check_text(files.get(path).ok_or(SourceError::Missing)?.clone().into_bytes()),
        }
    }

    /// The bytes of a file, of an image for example.
    pub fn read_bytes(&self, path: &TreePath) -> Result<Vec<u8>, SourceError> {
        match self {
            Self::Disk(root) => read_bytes(&root.join(path.as_str()), MAX_IMAGE_BYTES),
            Self::Quarantined(quarantine) => quarantine.tree().read_bytes(path),
            Self::Draft(draft) => draft.tree().read_bytes(path),
            Self::Toy(toy) => toy.read_bytes(path),
            Self::Memory(files) => Ok(files.get(path).ok_or(SourceError::Missing)?.clone().into_bytes()),
            Self::Embedded(example) => Ok(embedded::read(*example, path).ok_or(SourceError::Missing)?.to_vec()),
        }
    }

    /// The path for messages. For a directory, an editor can open it from the working directory.
    pub fn display_path(&self, path: &TreePath) -> String {
        match (self, self.root()) {
            (Self::Quarantined(quarantine), _) => quarantine.tree().display_path(path),
            (Self::Draft(draft), _) => draft.tree().display_path(path),
            (Self::Toy(toy), _) => toy.display_path(path),
            (_, Some(root)) if root == Path::new(".") => path.to_string(),
            (_, Some(root)) => root.join(path.as_str()).display().to_string(),
            (Self::Embedded(_), None) => format!("embedded:{path}"),
            (_, None) => path.to_string(),
        }
    }

    /// All files, sorted, without hidden files and directories (of editors and git).
    pub fn list(&self) -> Vec<TreePath> {
        match (self, self.root()) {
            (Self::Quarantined(quarantine), _) => quarantine.tree().list(),
            (Self::Draft(draft), _) => draft.tree().list(),
            (Self::Toy(toy), _) => toy.list(),
            (_, Some(root)) => {
                let tree_path = |path: &PathBuf| {
                    let names: Option<Vec<&str>> = path.strip_prefix(root).ok()?.iter().map(OsStr::to_str).collect();
                    TreePath::parse(&names?.join("/"))
                };
                let found = directory::files(root, |name| !name.starts_with('.'));
                let mut out: Vec<TreePath> = found.iter().filter_map(tree_path).collect();
                out.sort();
                out
            }
            (Self::Memory(files), None) => files.keys().cloned().collect(),
            (Self::Embedded(example), None) => embedded::list(*example),
            (Self::Disk(_), None) => Vec::new(),
        }
    }

    /// The names of the files in a folder, sorted, without hidden files. An empty path is the root.
    pub fn folder(&self, folder: &str) -> Vec<String> {
        let mut names = match self {
            Self::Disk(root) => names_in(&root.join(folder)),
            Self::Quarantined(quarantine) => quarantine.tree().folder(folder),
            Self::Draft(draft) => draft.tree().folder(folder),
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
            Self::Quarantined(quarantine) => quarantine.tree().root(),
            Self::Draft(draft) => draft.tree().root(),
            Self::Embedded(_) | Self::Memory(_) | Self::Toy(_) => None,
        }
    }

    /// The directory or file that [`Source::open`] opens; `None` for a tree that is not on disk.
    pub fn location(&self) -> Option<&Path> {
        match self {
            Self::Quarantined(quarantine) => quarantine.tree().location(),
            Self::Draft(draft) => draft.tree().location(),
            Self::Toy(toy) => Some(toy.file()),
            _ => self.root(),
        }
    }

    /// The files to watch of a tree that has no directory of its own. They change with the texts.
    pub fn files(&self) -> Vec<PathBuf> {
        match self {
            Self::Quarantined(quarantine) => quarantine.tree().files(),
            Self::Draft(draft) => draft.tree().files(),
            Self::Toy(toy) => toy.watched(),
            _ => Vec::new(),
        }
    }

    /// The paths of the tree whose text a change of this file on disk may change.
    pub fn changed(&self, file: &Path) -> Vec<TreePath> {
        match self {
            Self::Quarantined(quarantine) => quarantine.tree().changed(file),
            Self::Draft(draft) => draft.tree().changed(file),
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
            // Its texts are not those on disk while some are held back.
            Self::Quarantined(quarantine) if quarantine.is_released() => quarantine.tree().problems(),
            Self::Draft(draft) => draft.tree().problems(),
            _ => Vec::new(),
        }
    }

    /// A diagnostic as the author of the tree should see it: with the author's line, also where another text is compiled.
    #[must_use]
    pub fn explained(&self, diagnostic: Diagnostic) -> Diagnostic {
        match self {
            Self::Toy(toy) => toy.explained(diagnostic),
            Self::Quarantined(quarantine) => quarantine.tree().explained(diagnostic),
            Self::Draft(draft) => draft.tree().explained(diagnostic),
            _ => diagnostic,
        }
    }

    /// The name of the tree in messages: its folder, or that it is built in.
    pub fn name(&self) -> String {
        match self {
            Self::Embedded(Some(example)) => format!("examples:{}", example.name()),
            Self::Draft(draft) => draft.tree().name(),
            _ => self.location().map_or_else(|| "built-in shaders".to_owned(), |root| root.display().to_string()),
        }
    }
}

/// Whether a directory looks like a Specula shader tree: it holds an `interface.glsl`.
pub fn is_specula_tree(directory: &Path) -> bool {
    directory.join("interface.glsl").is_file()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_normalized_and_stay_inside() {
        assert_eq!(TreePath::parse("a/./b//../c.glsl").map(|p| p.to_string()), Some("a/c.glsl".to_owned()));
        assert_eq!(TreePath::parse("../c.glsl"), None);
        assert_eq!(TreePath::parse("/etc/passwd"), None);
        assert_eq!(TreePath::parse("a/.."), None);
        let path = TreePath::from("brdf/ggx.glsl");
        assert_eq!(path.sibling("../common/math.glsl"), TreePath::parse("common/math.glsl"));
        assert_eq!(path.sibling("../../x.glsl"), None);
        assert_eq!(path.sibling("/x.glsl"), None);
        assert_eq!((path.stem(), path.extension()), ("brdf/ggx", Some("glsl")));
    }

    #[test]
    fn every_reason_has_its_own_message() {
        let directory = tempfile::tempdir().unwrap();
        let source = Source::Disk(directory.path().to_owned());
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
}
