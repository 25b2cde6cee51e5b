//! Shader edits that the window makes: the watched expression, dragged numbers, and values that become defaults in the files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use crate::app::actions::restored::follow_restored;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::shaders::edits::{Draft, NO_FOLDER};
use crate::app::state::trace::saved::WrittenText;
use crate::shader::rewrite::{Edit, applied};
use crate::shader::source::draft::DraftText;
use crate::shader::values::is_default;
use crate::shader::{Change, Expression, ShaderSet};
use crate::threads::Message;
use crate::write_back::{self, NotWritten, TreeFile, Written};

/// Tells the worker of another watched expression. It reads the settings.
pub(in crate::app) fn watch_expression(state: &mut State, engine: &mut Engine) {
    let expression = &state.session.settings.expression;
    if state.edits.watched != *expression {
        state.edits.watched = expression.clone();
        engine.threads.worker.change(Change::Paths(BTreeSet::new()), Instant::now());
    }
}

/// Shows the picture with these numbers in place of those in the file; no edits go back to the file.
pub(in crate::app) fn draft(state: &mut State, engine: &mut Engine, edits: Vec<Edit>) {
    let Some(shaders) = &state.session.shaders else { return };
    let Some(path) = edits.first().map(|edit| edit.path.clone()) else { return end_draft(state, engine) };
    if let Some(restored) = &state.edits.restored {
        return state.say(format!("Version {} is shown; go back to the newest one to drag numbers", restored.number));
    }
    let line = edits.first().map_or(0, |edit| edit.line);
    let base = match &state.edits.draft {
        Some(draft) if draft.is_at(&path, line) => Some(draft.base.clone()),
        Some(_) => {
            end_draft(state, engine);
            None
        }
        None => shaders.texts.get(&path).cloned(),
    };
    let Some(base) = base else { return };
    let text = applied(base.as_bytes(), &edits).ok().and_then(|bytes| String::from_utf8(bytes).ok());
    let Some(text) = text else {
        return state.say(format!("{path} has changed; choose the number again"));
    };
    let texts = BTreeMap::from([(path.clone(), DraftText { base: base.clone(), text: text.into() })]);
    let source = state.source.with_draft(texts);
    state.edits.draft = Some(Draft { edits, path: path.clone(), line, base });
    engine.threads.worker.read_from(source, BTreeSet::from([path]));
}

/// Goes back to the numbers in the file.
pub(in crate::app) fn end_draft(state: &mut State, engine: &mut Engine) {
    if let Some(draft) = state.edits.draft.take() {
        let source = state.source.without_draft();
        engine.threads.worker.read_from(source, BTreeSet::from([draft.path]));
    }
}

/// Ends the dragging if the file has changed otherwise. Keeps the line of the watched expression. Drops settings whose values have become defaults.
pub(in crate::app) fn follow_edits(state: &mut State, engine: &mut Engine, shaders: &ShaderSet) {
    let is_other = |draft: &Draft| shaders.texts.get(&draft.path).is_none_or(|text| !draft.is_of(text));
    if let Some(draft) = state.edits.draft.as_ref().filter(|draft| is_other(draft)) {
        let lost = draft.edits.iter().map(|edit| edit.new.as_str()).collect::<Vec<_>>().join(", ");
        let told = format!("{} was saved with other changes; the dragged {lost} was not in it", draft.path);
        end_draft(state, engine);
        state.say(told);
    }
    follow_restored(state, engine, shaders);
    let expression = &mut state.session.settings.expression;
    let watched = Expression::parse(&expression.at, expression.evaluation).ok();
    if let Some(of_set) = shaders.watched.as_ref().filter(|of_set| Some(&of_set.expression) == watched.as_ref()) {
        expression.at = Expression { line: of_set.line, ..of_set.expression.clone() }.to_string();
        state.edits.watched.clone_from(expression);
    }
    let settings = &mut state.session.settings.shader;
    let mut is_removed = false;
    state.edits.written.retain(|name, value| {
        let is_written = is_default(shaders, name, value);
        if is_written && settings.get(name) == Some(value) {
            is_removed |= settings.remove(name).is_some();
        }
        !is_written
    });
    if is_removed {
        // It is part of the step that wrote the files.
        state.history.extend(&state.session.shared_settings());
    }
}

/// Writes edits into the files of the tree, on a thread of its own.
pub(in crate::app) fn write_edits(state: &mut State, engine: &mut Engine, edits: Vec<Edit>) {
    let Some(root) = state.source.folder_of_files().map(Path::to_owned) else { return state.say(NO_FOLDER) };
    let values = &state.session.settings.shader;
    let names = edits.iter().filter_map(|edit| Some((edit.name.clone(), values.get(&edit.name)?.clone())));
    state.edits.written.extend(names);
    let of_file = |edit: &Edit| Some(Edit { path: state.source.path_of_file(&edit.path)?, ..edit.clone() });
    let on_disk: Vec<Edit> = edits.iter().filter_map(of_file).collect();
    engine.threads.wait(move || {
        let written = write_back::write(&root, &on_disk);
        Some(Message::Written(written.map(|written| (told(&edits), written))))
    });
}

/// Writes a text that the user has typed into a file of the tree, on a thread of its own. `base`: the text with which the typing began.
pub(in crate::app) fn save_typed(
    state: &mut State,
    engine: &mut Engine,
    file: TreeFile,
    base: Arc<str>,
    text: Arc<str>,
) {
    // The result of a save before, perhaps of the same text, is not that of this one.
    state.traces.written = None;
    if let Err(message) = check_open(state, &file) {
        return on_typed_written(state, file, text, Err(message.into()));
    }
    engine.threads.wait(move || {
        let written = write_back::write_text(&file, &base, &text);
        Some(Message::TypedWritten(file, text, written))
    });
}

/// Refuses a file of another tree than the one that is open: a text must never be written into the file of the same name there.
fn check_open(state: &State, file: &TreeFile) -> Result<(), String> {
    match state.source.folder_of_files() {
        Some(root) if root == file.root => Ok(()),
        Some(_) => {
            let TreeFile { root, path } = file;
            Err(format!("{path} was typed in {}, which is not open any more, so it is not saved", root.display()))
        }
        None => Err(NO_FOLDER.to_owned()),
    }
}

/// Takes the result of writing a typed text.
pub(in crate::app) fn on_typed_written(
    state: &mut State,
    file: TreeFile,
    typed: Arc<str>,
    written: Result<(String, Written), NotWritten>,
) {
    let path = &file.path;
    let (text, theirs) = match written {
        Ok((text, written)) => {
            state.history.record_files(&state.session.shared_settings(), written);
            state.say(if *typed == *text {
                format!("Saved {path}")
            } else {
                format!("Saved {path} with the changes of another program")
            });
            (Some(text.into()), None)
        }
        Err(NotWritten { message, theirs }) => {
            state.say(message);
            (None, theirs.map(Into::into))
        }
    };
    state.traces.written = Some(WrittenText { file, typed, text, theirs });
}

/// Takes the result of writing.
pub(in crate::app) fn on_written(state: &mut State, engine: &mut Engine, written: Result<(String, Written), String>) {
    state.waiting.answer_edits(written.as_ref().map(|_| ()).map_err(String::as_str));
    match written {
        Ok((text, written)) => {
            state.history.record_files(&state.session.shared_settings(), written);
            // The file has the dragged numbers now, so nothing is compiled.
            if state.edits.draft.is_some() {
                state.versions.keep_draft();
                state.traces.drafted.clear();
            }
            end_draft(state, engine);
            state.say(text);
        }
        Err(message) => {
            state.edits.written.clear();
            state.say(message);
        }
    }
}

/// Summarizes the written edits in one line.
fn told(edits: &[Edit]) -> String {
    let change = |edit: &Edit| {
        let new = edit.new.trim_start_matches([' ', '=']);
        // A number has no name.
        match edit.name == edit.old() {
            true => format!("{new} for {} in line {}", edit.old(), edit.line),
            false => format!("{} = {new}", edit.name),
        }
    };
    let changes: Vec<String> = edits.iter().map(change).collect();
    let files: BTreeSet<&str> = edits.iter().map(|edit| edit.path.as_str()).collect();
    format!("Wrote {} to {}", changes.join(", "), files.into_iter().collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::shader::Source;

    #[test]
    fn a_text_is_saved_only_into_the_tree_in_which_it_was_typed() {
        let mut state = State::new(Settings::of_window(), Source::disk("trees/a"));
        let file = TreeFile { root: "trees/a".into(), path: "brdf/ndf.glsl".into() };
        assert_eq!(check_open(&state, &file), Ok(()));
        state.source = Source::disk("trees/b");
        let refused = check_open(&state, &file).unwrap_err();
        assert!(refused.contains("brdf/ndf.glsl was typed in trees/a, which is not open"), "{refused}");
        state.source = Source::embedded();
        assert_eq!(check_open(&state, &file), Err(NO_FOLDER.to_owned()));
        // The panel learns of the failure, so that it can save again.
        on_typed_written(&mut state, file.clone(), "typed".into(), Err(refused.into()));
        assert!(state.traces.written.is_some_and(|written| written.file == file && written.text.is_none()));
    }
}
