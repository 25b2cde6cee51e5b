//! The text of a file as it was saved, while the shaders in use have an older one: it does not compile, or differs in comments alone.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use chrono::{DateTime, Local};

use crate::shader::{Diagnostic, TreePath};
use crate::write_back::TreeFile;

/// A text that was typed into a file and written.
pub(in crate::app) struct WrittenText {
    pub(in crate::app) file: TreeFile,
    pub(in crate::app) typed: Arc<str>,
    /// The text of the file, with the changes of other programs; `None` if it could not be written.
    pub(in crate::app) text: Option<Arc<str>>,
    /// The text of the file, if another program has changed the same lines.
    pub(in crate::app) theirs: Option<Arc<str>>,
}

/// The text of one file.
#[derive(Default)]
pub(in crate::app) struct SavedText {
    /// The file that was asked for, and a hash of the last edit and its errors.
    asked: Option<(TreePath, u64)>,
    text: Option<(TreePath, Arc<str>)>,
    /// Number of edits that have compiled nothing since the shaders in use: of comments alone.
    silent: u64,
}

impl SavedText {
    /// Whether the text of a file is missing after the last edit, made at a time, that has these errors. The next call with the same
    /// counts it as asked for.
    pub(in crate::app) fn lacks<'a>(
        &mut self,
        path: &TreePath,
        errors: impl Iterator<Item = &'a Diagnostic>,
        last_edit: Option<DateTime<Local>>,
    ) -> bool {
        let mut hasher = DefaultHasher::new();
        (last_edit, self.silent).hash(&mut hasher);
        errors.for_each(|error| error.hash(&mut hasher));
        let asked = (path.clone(), hasher.finish());
        if self.asked.as_ref() == Some(&asked) {
            return false;
        }
        self.asked = Some(asked);
        true
    }

    /// Takes the text of a file, if it is still the one that was asked for.
    pub(in crate::app) fn take(&mut self, path: TreePath, text: Arc<str>) {
        if self.asked.as_ref().is_some_and(|(asked, _)| *asked == path) {
            self.text = Some((path, text));
        }
    }

    /// The text of a file.
    pub(in crate::app) fn of(&self, path: &TreePath) -> Option<&Arc<str>> {
        self.text.as_ref().filter(|(of, _)| of == path).map(|(_, text)| text)
    }

    /// Notes an edit after which the shaders are those from before: its texts differ from theirs.
    pub(in crate::app) fn edited_silently(&mut self) {
        self.silent += 1;
    }

    /// Whether the shaders in use lack such an edit.
    pub(in crate::app) fn is_behind(&self) -> bool {
        self.silent > 0
    }

    /// Forgets the text: the shaders in use have it.
    pub(in crate::app) fn forget(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_asked_for_once_for_each_state_of_its_errors() {
        let mut saved = SavedText::default();
        let path = TreePath::from("a.glsl");
        let errors = [Diagnostic::error("a.glsl", "one"), Diagnostic::error("a.glsl", "two")];
        let at = Some(Local::now());
        assert!(saved.lacks(&path, errors[..1].iter(), None) && !saved.lacks(&path, errors[..1].iter(), None));
        assert!(saved.lacks(&path, errors.iter(), None));
        assert!(saved.lacks(&path, errors.iter(), at) && !saved.lacks(&path, errors.iter(), at), "another save");
        saved.take("b.glsl".into(), "b".into());
        assert_eq!(saved.of(&"b.glsl".into()), None, "nobody has asked for it");
        saved.take(path.clone(), "text".into());
        assert_eq!(saved.of(&path).map(|text| &**text), Some("text"));
        assert!(!saved.is_behind() && !saved.lacks(&path, errors.iter(), at));
        saved.edited_silently();
        assert!(saved.is_behind() && saved.lacks(&path, errors.iter(), at), "an edit of a comment");
        saved.forget();
        assert!(saved.of(&path).is_none() && !saved.is_behind());
    }
}
