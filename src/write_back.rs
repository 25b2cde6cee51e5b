//! Writes changes of single values into the files of a shader tree. All other bytes of the files stay as they are.

mod merge;
mod text_form;

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::picture::replace_file;
use crate::regular_file;
use crate::shader::rewrite::{Edit, applied};
use crate::shader::{SourceError, TreePath, leads_out};
use text_form::TextForm;

/// Files that were written: the bytes before and after; `None` if there was no file.
#[derive(Debug)]
pub struct Written(Vec<(PathBuf, [Option<Vec<u8>>; 2])>);

impl Written {
    /// Files with their bytes before and after they were written.
    pub fn new(files: Vec<(PathBuf, [Option<Vec<u8>>; 2])>) -> Self {
        Self(files)
    }

    /// Writes the bytes before, or with `again` those after. Files that have changed since stay.
    ///
    /// # Errors
    /// A message: a file has changed, or cannot be read or written.
    pub fn take_back(&self, again: bool) -> Result<(), String> {
        let (from, to) = if again { (0, 1) } else { (1, 0) };
        for (file, texts) in &self.0 {
            if bytes_of(file)? != texts[from] {
                return Err(format!("{} has changed since it was written, so it stays as it is", file.display()));
            }
        }
        self.0.iter().try_for_each(|(file, texts)| match &texts[to] {
            Some(bytes) => replace(file, bytes),
            None => std::fs::remove_file(file).map_err(|error| format!("cannot remove {}: {error}", file.display())),
        })
    }

    /// The files.
    pub fn files(&self) -> Vec<PathBuf> {
        self.0.iter().map(|(file, _)| file.clone()).collect()
    }

    /// The names of the files.
    pub fn names(&self) -> String {
        let name = |(file, _): &(PathBuf, _)| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.0.iter().map(name).collect::<Vec<_>>().join(", ")
    }
}

/// The bytes of a file; `None` if there is none.
fn bytes_of(file: &Path) -> Result<Option<Vec<u8>>, String> {
    match regular_file::read(file, regular_file::LONGEST_TEXT) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(format!("cannot read {}: {error}", file.display())),
    }
}

fn replace(file: &Path, bytes: &[u8]) -> Result<(), String> {
    replace_file(file, bytes).map_err(|error| format!("cannot write {}: {error}", file.display()))
}

/// Writes edits into the files below `root`. Each file is replaced whole. Nothing is written if a line is not as its edit expects it.
///
/// # Errors
/// A message, if a file has changed or cannot be read or written.
pub fn write(root: &Path, edits: &[Edit]) -> Result<Written, String> {
    let mut of_files: BTreeMap<&TreePath, Vec<&Edit>> = BTreeMap::new();
    for edit in edits {
        of_files.entry(&edit.path).or_default().push(edit);
    }
    let mut writes = Vec::new();
    for (path, edits) in of_files {
        let file = root.join(path.as_str());
        if leads_out(root, path.as_str()) {
            return Err(format!("cannot write {}: {}", file.display(), SourceError::Outside));
        }
        let bytes = regular_file::read(&file, regular_file::LONGEST_TEXT);
        let bytes = bytes.map_err(|error| format!("cannot read {}: {error}", file.display()))?;
        let new = applied(&bytes, edits).map_err(|error| format!("{} {error}", file.display()))?;
        writes.push((file, [bytes, new]));
    }
    writes.iter().try_for_each(|(file, [_, new])| replace(file, new))?;
    Ok(Written(writes.into_iter().map(|(file, bytes)| (file, bytes.map(Some))).collect()))
}

/// A file of a tree on disk.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TreeFile {
    /// The folder of the tree.
    pub root: PathBuf,
    /// The file below it.
    pub path: TreePath,
}

/// Why a typed text was not written.
#[derive(Debug)]
pub struct NotWritten {
    /// A message for the user.
    pub message: String,
    /// The text of the file, if another program has changed the same lines.
    pub theirs: Option<String>,
}

impl From<String> for NotWritten {
    fn from(message: String) -> Self {
        Self { message, theirs: None }
    }
}

/// Writes a text that was typed into a file. `base` is the text with which the typing began. If another program has changed the
/// file since, its changes are merged, unless both have changed the same lines. Returns the text that the file then has.
///
/// # Errors
/// A message, if the same lines were changed, or the file cannot be read or written. The file then stays as it is.
pub fn write_text(file: &TreeFile, base: &str, text: &str) -> Result<(String, Written), NotWritten> {
    let TreeFile { root, path } = file;
    let file = root.join(path.as_str());
    if leads_out(root, path.as_str()) {
        return Err(format!("cannot write {}: {}", file.display(), SourceError::Outside).into());
    }
    let bytes = regular_file::read(&file, regular_file::LONGEST_TEXT);
    let bytes = bytes.map_err(|error| format!("cannot read {}: {error}", file.display()))?;
    let on_disk = std::str::from_utf8(&bytes).map_err(|_| format!("{} is no UTF-8", file.display()))?;
    let form = TextForm::of(on_disk);
    let new = merge::merge(&form.write(base), on_disk, &form.write(text)).map_err(|line| NotWritten {
        message: format!(
            "{} was changed by another program in the same place, at line {line}, so it stays as it is",
            file.display()
        ),
        theirs: Some(form.read(on_disk)),
    })?;
    let text = form.read(&new);
    let new = new.into_bytes();
    if new != bytes {
        replace(&file, &new)?;
    }
    Ok((text, Written(vec![(file, [bytes, new].map(Some))])))
}

/// Writes the whole text of a file, which need not exist, nor its folder in the tree.
///
/// # Errors
/// A message: a link leads out of the tree, the text is too long, or the file cannot be read or written. It then stays as it is.
pub fn write_whole(file: &TreeFile, text: &str) -> Result<Written, String> {
    let TreeFile { root, path } = file;
    let file = root.join(path.as_str());
    let cannot = |why: String| format!("cannot write {}: {why}", file.display());
    // The part of the path that exists must lie in the tree, as what does not exist yet would then.
    let there = file.ancestors().find(|part| part.symlink_metadata().is_ok()).unwrap_or(root);
    let is_inside = there.canonicalize().and_then(|there| Ok(there.starts_with(root.canonicalize()?)));
    if !is_inside.unwrap_or(false) {
        return Err(cannot(SourceError::Outside.to_string()));
    }
    if text.len() as u64 > regular_file::LONGEST_TEXT {
        return Err(cannot(format!("{} bytes; at most {} are read", text.len(), regular_file::LONGEST_TEXT)));
    }
    let before = bytes_of(&file)?;
    if before.is_none() {
        let folder = file.parent().unwrap_or(root);
        std::fs::create_dir_all(folder).map_err(|error| cannot(error.to_string()))?;
    }
    let new = Some(text.as_bytes().to_vec());
    if new != before {
        replace(&file, text.as_bytes())?;
    }
    Ok(Written(vec![(file, [before, new])]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_text_is_written_with_the_changes_of_others_or_not_at_all() {
        let tree = tempfile::tempdir().unwrap();
        let file = tree.path().join("a.glsl");
        let read = || std::fs::read_to_string(&file).unwrap();
        let base = "one\ntwo\nthree\nfour\n";
        std::fs::write(&file, base).unwrap();
        let of_tree = TreeFile { root: tree.path().to_owned(), path: "a.glsl".into() };
        let missing = TreeFile { path: "b.glsl".into(), ..of_tree.clone() };
        let (text, written) = write_text(&of_tree, base, "one\ntwo!\nthree\nfour\n").unwrap();
        assert_eq!((text.as_str(), read().as_str()), ("one\ntwo!\nthree\nfour\n", "one\ntwo!\nthree\nfour\n"));
        written.take_back(false).unwrap();
        assert_eq!(read(), base);
        // Another program has changed the end.
        std::fs::write(&file, "one\ntwo\nthree\nfour\nfive\n").unwrap();
        write_text(&of_tree, base, "zero\none\ntwo\nthree\nfour\n").unwrap();
        assert_eq!(read(), "zero\none\ntwo\nthree\nfour\nfive\n");
        // Both have changed a line.
        std::fs::write(&file, "one\n2\nthree\nfour\n").unwrap();
        let error = write_text(&of_tree, base, "one\nTWO\nthree\nfour\n").unwrap_err();
        assert!(error.message.contains("changed by another program in the same place, at line 2"), "{error:?}");
        assert_eq!(error.theirs.as_deref(), Some("one\n2\nthree\nfour\n"));
        assert_eq!(read(), "one\n2\nthree\nfour\n");
        assert!(write_text(&missing, "", "").unwrap_err().message.contains("cannot read"));
        // A tree reads this file without its mark.
        std::fs::write(&file, "\u{feff}one\r\ntwo\r\n").unwrap();
        let (text, _) = write_text(&of_tree, "one\r\ntwo\r\n", "one\r\nmore\ntwo\r\n").unwrap();
        assert_eq!((text.as_str(), read().as_str()), ("one\r\nmore\r\ntwo\r\n", "\u{feff}one\r\nmore\r\ntwo\r\n"));
    }

    #[test]
    fn a_whole_text_replaces_a_file_or_makes_one() {
        let tree = tempfile::tempdir().unwrap();
        let file = |path: &str| TreeFile { root: tree.path().to_owned(), path: path.into() };
        let read = |path: &str| std::fs::read_to_string(tree.path().join(path)).unwrap();
        let made = write_whole(&file("lib/new.glsl"), "one").unwrap();
        assert_eq!(read("lib/new.glsl"), "one");
        made.take_back(false).unwrap();
        assert!(!tree.path().join("lib/new.glsl").exists(), "an undo leaves an empty file");
        made.take_back(true).unwrap();
        let written = write_whole(&file("lib/new.glsl"), "two").unwrap();
        assert_eq!(read("lib/new.glsl"), "two");
        written.take_back(false).unwrap();
        assert_eq!(read("lib/new.glsl"), "one");
        write_whole(&file("empty.glsl"), "").unwrap();
        assert_eq!(read("empty.glsl"), "");
    }

    #[test]
    fn what_was_written_is_taken_back_unless_the_file_has_changed() {
        let tree = tempfile::tempdir().unwrap();
        let file = tree.path().join("a.glsl");
        let read = || std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, "x = 1;").unwrap();
        let (path, name) = ("a.glsl".into(), "1".into());
        let edit = Edit { path, name, line: 1, bytes: 4..5, before: "x = 1;".into(), new: "2".into() };
        let written = write(tree.path(), &[edit]).unwrap();
        assert_eq!((read().as_str(), written.names().as_str()), ("x = 2;", "a.glsl"));
        written.take_back(false).unwrap();
        assert_eq!(read(), "x = 1;");
        written.take_back(true).unwrap();
        assert_eq!(read(), "x = 2;");
        std::fs::write(&file, "x = 3;").unwrap();
        assert!(written.take_back(false).unwrap_err().contains("has changed since"));
        assert_eq!(read(), "x = 3;");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_out_of_the_tree_is_not_written() {
        let (tree, outside) = (tempfile::tempdir().unwrap(), tempfile::NamedTempFile::new().unwrap());
        std::os::unix::fs::symlink(outside.path(), tree.path().join("a.glsl")).unwrap();
        let edit = Edit {
            path: "a.glsl".into(),
            name: "x".into(),
            line: 1,
            bytes: 0..0,
            before: String::new(),
            new: "x".into(),
        };
        let error = write(tree.path(), &[edit]).unwrap_err();
        assert!(error.contains("a link that leads out of the shader tree"), "{error}");
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(folder.path(), tree.path().join("out")).unwrap();
        std::os::unix::fs::symlink(folder.path().join("nothing"), tree.path().join("dangling.glsl")).unwrap();
        for path in ["a.glsl", "out/new.glsl", "out/deep/new.glsl", "dangling.glsl"] {
            let file = TreeFile { root: tree.path().to_owned(), path: path.into() };
            let error = write_whole(&file, "x").unwrap_err();
            assert!(error.contains("a link that leads out of the shader tree"), "{path}: {error}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert_eq!(std::fs::read(outside.path()).unwrap(), b"");
    }
}
