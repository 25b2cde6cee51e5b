//! The folder in which a student works on an exercise: the whole tree, so that it opens as any other, and the text.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{Exercise, exercises};
use crate::picture::replace_file;
use crate::regular_file;
use crate::shader::is_specula_tree;

/// The text of the exercise, for the student's editor. Its last line says which exercise the tree is of.
const TEXT: &str = "EXERCISE.md";
/// Begins the last line of the text.
const MARK: &str = "<!-- specula learn ";

/// Writes the tree of an exercise below `parent`, unless it is there already, and returns its folder.
///
/// # Errors
/// A message: the folder cannot be written, or holds something else.
pub fn prepare(parent: &Path, exercise: &Exercise) -> Result<PathBuf, String> {
    let folder = parent.join(&exercise.name);
    let error = |error: &dyn std::fmt::Display| {
        format!("cannot write exercise {} to {}: {error}", exercise.label(), folder.display())
    };
    let is_own = exercise_of(&folder).map_or(!folder.join(TEXT).exists(), |found| found.name == exercise.name);
    if is_own && is_specula_tree(&folder) {
        if !folder.join(TEXT).exists() {
            replace_file(&folder.join(TEXT), page(exercise).as_bytes()).map_err(|e| error(&e))?;
        }
        return Ok(folder);
    }
    let is_used = std::fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some());
    if is_used {
        return Err(error(&"the folder holds other files. Choose another with --dir"));
    }
    let source = exercise.start_tree();
    for path in source.list() {
        let target = folder.join(path.as_str());
        let bytes = source.read_bytes(&path).map_err(|e| error(&e))?;
        let written =
            std::fs::create_dir_all(target.parent().unwrap_or(&folder)).and_then(|()| std::fs::write(&target, bytes));
        written.map_err(|e| error(&e))?;
    }
    // The text comes last: a folder with it is whole.
    replace_file(&folder.join(TEXT), page(exercise).as_bytes()).map_err(|e| error(&e))?;
    Ok(folder)
}

/// The exercise whose tree this folder holds.
pub fn exercise_of(folder: &Path) -> Option<Arc<Exercise>> {
    let text = regular_file::read_text(&folder.join(TEXT)).ok()?;
    let mark = text.lines().rev().find_map(|line| line.strip_prefix(MARK)?.trim_end().strip_suffix("-->"))?.trim();
    match mark.split_once(' ') {
        Some((_, own)) => Exercise::open(Path::new(own)).ok().map(Arc::new),
        None => exercises().iter().find(|exercise| exercise.name == mark).cloned(),
    }
}

/// The exercise as a page of Markdown.
fn page(exercise: &Exercise) -> String {
    let Exercise { title, text, source, open, goals, name, folder, .. } = exercise;
    let goals: String = goals.iter().map(|goal| format!("- {}\n", goal.says)).collect();
    // One of the user's own is found by its folder.
    let own = folder.as_ref().map(|folder| format!(" {}", folder.display())).unwrap_or_default();
    format!(
        "# Exercise {}: {title}\n\n{}\n\nEdit `{}` and save.\n\n## Goal\n\n{goals}\nSource: {source}\n\n{MARK}{name}{own} -->\n",
        exercise.label(),
        text.trim(),
        open.file
    )
}
