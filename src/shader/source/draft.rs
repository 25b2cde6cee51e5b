//! A shader tree, some of whose files have other texts in memory: a number that is being dragged, or an older version.
//!
//! A draft replaces a file only as long as the file on disk is the one that the draft was made from, so an edit in the
//! editor wins. Dragged values become defaults in `rewrite/defaults.rs`, as edits of byte ranges in lines;
//! `write_back::write` applies them to the file on disk if each line is as the edit expects it.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Source, SourceError, TreePath};

/// A text in memory, and the file's text from which it was made.
#[derive(Clone, Debug)]
pub struct DraftText {
    /// The text of the file.
    pub base: Arc<str>,
    /// The text in memory.
    pub text: Arc<str>,
}

/// A tree, some of whose files are replaced by texts in memory.
#[derive(Debug)]
pub struct Draft {
    tree: Source,
    texts: BTreeMap<TreePath, DraftText>,
}

impl Source {
    /// The tree with other texts of these files. Each applies only while the file's own text equals `base`, so an edit of the
    /// file wins. Replaces an earlier draft.
    #[must_use]
    pub fn with_draft(&self, texts: BTreeMap<TreePath, DraftText>) -> Self {
        Self::Draft(Arc::new(Draft { tree: self.without_draft().clone(), texts }))
    }

    /// The tree without a draft.
    pub fn without_draft(&self) -> &Self {
        match self {
            Self::Draft(draft) => &draft.tree,
            tree => tree,
        }
    }
}

impl Draft {
    pub(super) fn tree(&self) -> &Source {
        &self.tree
    }

    pub(super) fn read(&self, path: &TreePath) -> Result<String, SourceError> {
        let own = self.tree.read(path)?;
        Ok(match self.texts.get(path).filter(|draft| *own == *draft.base) {
            Some(draft) => draft.text.to_string(),
            None => own,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draft_hides_a_file_until_that_is_edited() {
        let directory = tempfile::tempdir().unwrap();
        let write = |text: &str| std::fs::write(directory.path().join("a.glsl"), text).unwrap();
        write("old");
        std::fs::write(directory.path().join("b.glsl"), "old").unwrap();
        let source = Source::Disk(directory.path().to_owned());
        let (a, b) = (TreePath::from("a.glsl"), TreePath::from("b.glsl"));
        let of_a = |text: &str| BTreeMap::from([(a.clone(), DraftText { base: "old".into(), text: text.into() })]);
        let draft = source.with_draft(of_a("first")).with_draft(of_a("draft"));
        assert_eq!((draft.read(&a), draft.read(&b)), (Ok("draft".to_owned()), Ok("old".to_owned())));
        assert_eq!((draft.root(), draft.list()), (source.root(), source.list()));
        write("edited");
        assert_eq!(draft.read(&a), Ok("edited".to_owned()));
        assert_eq!(draft.without_draft().read(&a), Ok("edited".to_owned()));
    }
}
