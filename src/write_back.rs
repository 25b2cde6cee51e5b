//! Writes changes of single values into the files of a shader tree. All other bytes of the files stay as they are.

use std::collections::BTreeMap;
use std::path::Path;

use crate::picture::replace_file;
use crate::shader::TreePath;
use crate::shader::rewrite::{Edit, applied};

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
        let bytes = std::fs::read(&file).map_err(|error| format!("cannot read {}: {error}", file.display()))?;
        let new = applied(&bytes, edits).map_err(|error| format!("{} {error}", file.display()))?;
        writes.push((file, new));
    }
    writes.iter().try_for_each(|(file, bytes)| {
        replace_file(file, bytes).map_err(|error| format!("cannot write {}: {error}", file.display()))
    })
}
