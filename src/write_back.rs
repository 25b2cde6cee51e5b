//! Writes changes of single values into the files of a shader tree. All other bytes of the files stay as they are.

use std::collections::BTreeMap;
use std::path::Path;

use crate::picture::replace_file;
use crate::regular_file;
use crate::shader::rewrite::{Edit, applied};
use crate::shader::{SourceError, TreePath, leads_out};

/// Writes edits into the files below `root`. Each file is replaced whole. Nothing is written if a line is not as its edit expects it.
///
/// # Errors
/// A message, if a file has changed or cannot be read or written.
pub fn write(root: &Path, edits: &[Edit]) -> Result<(), String> {
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
        writes.push((file, new));
    }
    writes.iter().try_for_each(|(file, bytes)| {
        replace_file(file, bytes).map_err(|error| format!("cannot write {}: {error}", file.display()))
    })
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

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
        assert_eq!(std::fs::read(outside.path()).unwrap(), b"");
    }
}
