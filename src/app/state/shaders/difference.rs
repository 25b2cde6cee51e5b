//! The difference of two states of a shader tree, line by line.

use std::collections::BTreeMap;
use std::sync::Arc;

use similar::{ChangeTag, TextDiff};

use crate::shader::TreePath;

/// Unchanged lines around each change.
const CONTEXT: usize = 2;

/// Kind of a line in a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Kind {
    /// The name of the file that the next lines are of, or a gap between them.
    Place,
    Removed,
    Added,
    Same,
}

/// A line of a difference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct Line {
    pub(in crate::app) kind: Kind,
    /// Its text with a sign in front, as in a unified difference.
    pub(in crate::app) text: String,
}

/// The lines in which the files differ, file by file.
pub(in crate::app) fn difference(
    before: &BTreeMap<TreePath, Arc<str>>,
    after: &BTreeMap<TreePath, Arc<str>>,
) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut add = |kind, text: String| lines.push(Line { kind, text });
    let paths = before.keys().chain(after.keys().filter(|path| !before.contains_key(*path)));
    for path in paths {
        let text = |texts: &BTreeMap<TreePath, Arc<str>>| texts.get(path).cloned().unwrap_or_default();
        let (old, new) = (text(before), text(after));
        if old == new {
            continue;
        }
        add(Kind::Place, path.as_str().to_owned());
        let changes = TextDiff::from_lines(&*old, &*new);
        for group in changes.grouped_ops(CONTEXT) {
            if let Some(first) = group.first() {
                add(Kind::Place, format!("@@ line {}", first.new_range().start + 1));
            }
            for change in group.iter().flat_map(|op| changes.iter_changes(op)) {
                let (kind, sign) = match change.tag() {
                    ChangeTag::Delete => (Kind::Removed, '-'),
                    ChangeTag::Insert => (Kind::Added, '+'),
                    ChangeTag::Equal => (Kind::Same, ' '),
                };
                add(kind, format!("{sign}{}", change.value().trim_end_matches(['\n', '\r'])));
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(files: &[(&str, &str)]) -> BTreeMap<TreePath, Arc<str>> {
        files.iter().map(|(path, text)| (TreePath::from(*path), Arc::from(*text))).collect()
    }

    #[test]
    fn only_changed_lines_and_their_neighbors_are_told() {
        let lines = |middle: &str| format!("1\n2\n3\n4\n{middle}\n6\n7\n8\n9\n");
        let before = tree(&[("a.glsl", &lines("5")), ("b.glsl", "same\n"), ("old.glsl", "gone\n")]);
        let after = tree(&[("a.glsl", &lines("five")), ("b.glsl", "same\n"), ("new.glsl", "here")]);
        let told: Vec<String> = difference(&before, &after).into_iter().map(|line| line.text).collect();
        let of_a = ["a.glsl", "@@ line 3", " 3", " 4", "-5", "+five", " 6", " 7"];
        let others = ["old.glsl", "@@ line 1", "-gone", "new.glsl", "@@ line 1", "+here"];
        assert_eq!(told, [&of_a[..], &others[..]].concat());
        assert!(difference(&before, &before).is_empty());
    }
}
