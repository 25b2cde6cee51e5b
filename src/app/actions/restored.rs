//! An older version of the shaders in place of the newest one, in the whole window and without a change of the files. A save ends it.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::shaders::edits::Restored;
use crate::shader::source::draft::DraftText;
use crate::shader::{ShaderSet, TreePath};

/// Shows a version in place of the newest, until a file is saved.
pub(in crate::app) fn show_version(state: &mut State, engine: &mut Engine, number: u64) {
    let Some((files, version)) = state.texts_of_files().zip(state.versions.get(number)) else { return };
    let texts = &version.shaders.texts;
    let differs = |(path, text): &(&TreePath, &Arc<str>)| files.get(*path).is_some_and(|file| file != *text);
    let changed: BTreeSet<TreePath> = texts.iter().filter(differs).map(|(path, _)| path.clone()).collect();
    if changed.is_empty() {
        return show_newest(state, engine);
    }
    let draft = changed.iter().filter_map(|path| {
        let (base, text) = (files.get(path)?.clone(), texts.get(path)?.clone());
        Some((path.clone(), DraftText { base, text }))
    });
    let source = state.source.with_draft(draft.collect());
    let mut shown = files.clone();
    shown.extend(texts.iter().map(|(path, text)| (path.clone(), text.clone())));
    let (before, shown_before) = state.edits.restored.take().map(|old| (old.changed, old.shown)).unzip();
    let before: BTreeSet<TreePath> = before.unwrap_or_default();
    let before = before.into_iter().chain(state.edits.draft.take().map(|draft| draft.path));
    let paths = changed.iter().cloned().chain(before).collect();
    state.edits.restored = Some(Restored { number, files, shown, shown_before, changed });
    state.shader.compiling = true;
    engine.threads.worker.read_from(source, paths);
}

/// Goes back to the texts of the files.
pub(in crate::app) fn show_newest(state: &mut State, engine: &mut Engine) {
    if let Some(restored) = state.edits.restored.take() {
        let source = state.source.without_draft();
        state.shader.compiling = true;
        engine.threads.worker.read_from(source, restored.changed);
    }
}

/// Goes back to the files if one of them was saved.
pub(in crate::app) fn follow_restored(state: &mut State, engine: &mut Engine, shaders: &ShaderSet) {
    if let Some(restored) = state.edits.restored.as_ref().filter(|restored| restored.is_edited(shaders)) {
        state.say(format!("A file was saved, so version {} is no longer shown", restored.number));
        show_newest(state, engine);
    }
}
