//! A shader tree, one of whose files has another text in memory: a number that is being dragged.

use std::sync::Arc;

use super::{Source, SourceError, TreePath};

/// A tree and the text that is read instead of one of its files.
#[derive(Debug)]
pub struct Draft {
    tree: Source,
    path: TreePath,
    /// The text that the draft was made from.
    base: Arc<str>,
    text: Arc<str>,
}

impl Source {
    /// The tree, in which the file `path` has another text as long as its own text is `base`: an edit of the file wins. Replaces an
    /// earlier draft.
    #[must_use]
    pub fn with_draft(&self, path: &TreePath, base: &Arc<str>, text: &Arc<str>) -> Self {
        let (tree, path) = (self.without_draft().clone(), path.clone());
        Self::Draft(Arc::new(Draft { tree, path, base: base.clone(), text: text.clone() }))
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
        let text = self.tree.read(path)?;
        Ok(if *path == self.path && *text == *self.base { self.text.to_string() } else { text })
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
        let draft = source.with_draft(&a, &"old".into(), &"first".into());
        let draft = draft.with_draft(&a, &"old".into(), &"draft".into());
        assert_eq!((draft.read(&a), draft.read(&b)), (Ok("draft".to_owned()), Ok("old".to_owned())));
        assert_eq!((draft.root(), draft.list()), (source.root(), source.list()));
        write("edited");
        assert_eq!(draft.read(&a), Ok("edited".to_owned()));
        assert_eq!(draft.without_draft().read(&a), Ok("edited".to_owned()));
    }
}
