//! Changes of the shaders that are not in the files: the watched expression, dragged numbers, an older version in place of the newest.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::settings::{ExpressionSettings, ShaderValue};
use crate::shader::rewrite::Edit;
use crate::shader::{ShaderSet, TreePath};

/// Message for a shader tree that has no folder on disk.
pub(in crate::app) const NO_FOLDER: &str = "These shaders are not in a folder on disk. `specula new DIR` writes them to a folder that you \
    can open and edit";

/// Changes of the shaders that are under way.
#[derive(Default)]
pub(in crate::app) struct Edits {
    /// The expression that the worker knows.
    pub(in crate::app) watched: ExpressionSettings,
    /// Whether nothing is watched any more once the tree that the user opens is found.
    pub(in crate::app) stops_watching: bool,
    /// The expressions that were watched in trees that were left since, by their places; `None` is the tree in the program.
    left: HashMap<Option<PathBuf>, ExpressionSettings>,
    /// Numbers of a line that are dragged.
    pub(in crate::app) draft: Option<Draft>,
    /// The older version that is shown in place of the newest.
    pub(in crate::app) restored: Option<Restored>,
    /// Values that were written to the files. Each setting is dropped once a reload has made its value the default.
    pub(in crate::app) written: BTreeMap<String, ShaderValue>,
}

/// Numbers that are dragged, and not in the file yet.
pub(in crate::app) struct Draft {
    pub(in crate::app) edits: Vec<Edit>,
    pub(in crate::app) path: TreePath,
    pub(in crate::app) line: u32,
    /// The text of the file without the edits.
    pub(in crate::app) base: Arc<str>,
}

impl Draft {
    /// Whether the dragged numbers are those of this line.
    pub(in crate::app) fn is_at(&self, path: &TreePath, line: u32) -> bool {
        (&self.path, self.line) == (path, line)
    }

    /// Whether a text of the file differs from that on disk in the dragged line at most.
    pub(in crate::app) fn is_of(&self, text: &str) -> bool {
        let other = |number: usize| number + 1 != self.line as usize;
        let rest = |text: &str| -> Vec<String> {
            text.split('\n').enumerate().filter(|(number, _)| other(*number)).map(|(_, line)| line.to_owned()).collect()
        };
        rest(text) == rest(&self.base)
    }
}

impl Edits {
    /// The edits at the start, when the worker begins with this expression.
    pub(in crate::app) fn new(watched: &ExpressionSettings) -> Self {
        Self { watched: watched.clone(), ..Self::default() }
    }

    /// Keeps the expression that is watched in a tree, which is left.
    pub(in crate::app) fn leave(&mut self, tree: Option<&Path>, watched: &ExpressionSettings) {
        self.left.insert(tree.map(Path::to_owned), watched.clone());
    }

    /// Takes the expression that was watched in a tree when it was left.
    pub(in crate::app) fn come_back(&mut self, tree: Option<&Path>) -> Option<ExpressionSettings> {
        self.left.remove(&tree.map(Path::to_owned))
    }

    /// Drops dragged numbers and the shown version, because another tree is opened.
    pub(in crate::app) fn forget_draft(&mut self) {
        (self.draft, self.restored) = (None, None);
    }
}

/// Texts of the files of a tree.
pub(in crate::app) type Texts = BTreeMap<TreePath, Arc<str>>;

/// The version that is shown.
pub(in crate::app) struct Restored {
    /// Its number when it was the newest.
    pub(in crate::app) number: u64,
    /// The texts of the files.
    pub(in crate::app) files: Texts,
    /// The texts that are shown.
    pub(in crate::app) shown: Texts,
    /// The texts that were shown in place of the newest before, if any.
    pub(in crate::app) shown_before: Option<Texts>,
    /// The files that differ.
    pub(in crate::app) changed: BTreeSet<TreePath>,
}

impl Restored {
    /// Whether these shaders have a text that neither the version nor its restoring explains: a file was saved. Shaders that were
    /// being compiled when the version was chosen have the previous texts.
    pub(in crate::app) fn is_edited(&self, shaders: &ShaderSet) -> bool {
        let known = || [Some(&self.shown), Some(&self.files), self.shown_before.as_ref()].into_iter().flatten();
        let is_known = |path, text| known().any(|texts| texts.get(path) == Some(text));
        shaders.texts.iter().any(|(path, text)| self.shown.contains_key(path) && !is_known(path, text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shaders_that_were_under_way_are_no_save() {
        let texts = |text: &str| BTreeMap::from([(TreePath::from("a.glsl"), Arc::<str>::from(text))]);
        let restored = Restored {
            number: 1,
            files: texts("file"),
            shown: texts("version 1"),
            shown_before: Some(texts("version 2")),
            changed: BTreeSet::new(),
        };
        let is_edited = |text: &str| restored.is_edited(&ShaderSet { texts: texts(text), ..ShaderSet::default() });
        assert!(["version 1", "version 2", "file"].iter().all(|text| !is_edited(text)));
        assert!(is_edited("saved"));
    }

    #[test]
    fn a_draft_is_told_from_another_edit_of_the_file() {
        let base: Arc<str> = "a = 1;\nb = 2;\n".into();
        let draft = Draft { edits: Vec::new(), path: TreePath::from("a.glsl"), line: 2, base };
        assert!(draft.is_at(&TreePath::from("a.glsl"), 2) && !draft.is_at(&TreePath::from("a.glsl"), 1));
        assert!(draft.is_of("a = 1;\nb = 3;\n"), "the dragged line");
        assert!(!draft.is_of("a = 2;\nb = 2;\n"), "another line");
    }
}
