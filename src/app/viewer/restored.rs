//! An older version of the shaders in place of the newest one, in the whole window and without a change of the files. A save ends it.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Viewer;
use crate::app::state::shaders::edits::{Restored, Texts};
use crate::shader::source::draft::DraftText;
use crate::shader::{ShaderSet, TreePath};

impl Viewer {
    /// Shows a version in place of the newest, until a file is saved.
    pub(super) fn show_version(&mut self, number: u64) {
        let Some((files, version)) = self.texts_of_files().zip(self.versions.get(number)) else { return };
        let texts = &version.shaders.texts;
        let differs = |(path, text): &(&TreePath, &Arc<str>)| files.get(*path).is_some_and(|file| file != *text);
        let changed: BTreeSet<TreePath> = texts.iter().filter(differs).map(|(path, _)| path.clone()).collect();
        if changed.is_empty() {
            return self.show_newest();
        }
        let draft = changed.iter().filter_map(|path| {
            let (base, text) = (files.get(path)?.clone(), texts.get(path)?.clone());
            Some((path.clone(), DraftText { base, text }))
        });
        let source = self.source.with_draft(draft.collect());
        let mut shown = files.clone();
        shown.extend(texts.iter().map(|(path, text)| (path.clone(), text.clone())));
        let (before, shown_before) = self.edits.restored.take().map(|old| (old.changed, old.shown)).unzip();
        let before: BTreeSet<TreePath> = before.unwrap_or_default();
        let before = before.into_iter().chain(self.edits.draft.take().map(|draft| draft.path));
        let paths = changed.iter().cloned().chain(before).collect();
        self.edits.restored = Some(Restored { number, files, shown, shown_before, changed });
        self.shader.compiling = true;
        self.threads.worker.read_from(source, paths);
    }

    /// Goes back to the texts of the files.
    pub(super) fn show_newest(&mut self) {
        if let Some(restored) = self.edits.restored.take() {
            let source = self.source.without_draft();
            self.shader.compiling = true;
            self.threads.worker.read_from(source, restored.changed);
        }
    }

    /// Goes back to the files if one of them was saved.
    pub(super) fn follow_restored(&mut self, shaders: &ShaderSet) {
        if let Some(restored) = self.edits.restored.as_ref().filter(|restored| restored.is_edited(shaders)) {
            self.say(format!("A file was saved, so version {} is no longer shown", restored.number));
            self.show_newest();
        }
    }

    /// The texts of the files, as they were last compiled; `None` without shaders.
    pub(super) fn texts_of_files(&self) -> Option<Texts> {
        if let Some(restored) = &self.edits.restored {
            return Some(restored.files.clone());
        }
        let mut texts = self.session.shaders.as_ref()?.texts.clone();
        texts.extend(self.edits.draft.as_ref().map(|draft| (draft.path.clone(), draft.base.clone())));
        Some(texts)
    }
}
