//! Exercises: opens their trees, has the checker measure them, and keeps what the student has done.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use super::compare::write_files;
use crate::app::actions::files::{edit, find_tree, load_models};
use crate::app::editor::Place;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Preset;
use crate::app::state::exercise::{LearnCommand, Measured};
use crate::app::state::selection::Selected;
use crate::app::state::workspace::PanelRequest;
use crate::events::{Event, emit};
use crate::learn::{Exercise, exercises, prepare};
use crate::settings::Settings;
use crate::shader::{ShaderSet, TreePath};
use crate::threads::Checked;
use crate::threads::Message;

pub(in crate::app) fn learn(state: &mut State, engine: &mut Engine, command: LearnCommand) {
    let learning = &mut state.learning;
    learning.asks &= command == LearnCommand::StartOver;
    match (command, learning.exercise.clone()) {
        (LearnCommand::Open(number), _) => prepare_exercise(state, engine, number),
        (LearnCommand::List, _) if state.workspace.sight.learn => learning.shows_list ^= true,
        (LearnCommand::List, _) => {
            learning.shows_list = true;
            state.workspace.request(PanelRequest::Arrange(Preset::Learn));
        }
        (LearnCommand::Hint, Some(exercise)) => {
            let most = exercise.hints.len();
            learning.progress.update(&exercise, |record| record.hints = (record.hints + 1).min(most));
        }
        (LearnCommand::Solution, Some(exercise)) => {
            learning.solution = if learning.solution.is_none() { Some(Vec::new()) } else { None };
            learning.progress.update(&exercise, |record| record.saw_solution = true);
            learning.update_solution(state.session.shaders.as_deref());
        }
        (LearnCommand::Solve, Some(exercise)) => {
            let files = exercise.solution().map(|(path, text)| (path.clone(), text.to_owned())).collect();
            write_exercise(state, engine, files, "Wrote the solution");
        }
        (LearnCommand::StartOver, Some(_)) if !learning.asks => learning.asks = true,
        (LearnCommand::StartOver, Some(exercise)) => {
            learning.asks = false;
            let shaders = state.session.shaders.as_deref();
            let files = files_to_restore(&exercise, shaders);
            write_exercise(state, engine, files, "Restored the original files");
        }
        (LearnCommand::Edit, Some(exercise)) => edit_exercise(state, engine, &exercise),
        (_, None) => {}
    }
}

/// Writes the tree of an exercise, unless it is there, on a thread of its own.
fn prepare_exercise(state: &mut State, engine: &mut Engine, number: usize) {
    let Some(exercise) = exercises().iter().find(|exercise| exercise.number == number) else { return };
    let (parent, exercise) = (state.learning.parent(), exercise.clone());
    engine.threads.wait(move || {
        let prepared = prepare(&parent, &exercise);
        Some(Message::Prepared(exercise, prepared))
    });
}

pub(in crate::app) fn on_prepared(
    state: &mut State,
    engine: &mut Engine,
    exercise: &Exercise,
    prepared: Result<PathBuf, String>,
) {
    let folder = match prepared {
        Ok(folder) => folder,
        Err(message) => return state.say(message),
    };
    let mut settings = Settings::of_window();
    if let Err(message) = exercise.apply_settings(&mut settings) {
        return state.say(message);
    }
    let own = state.session_state();
    if state.learning.exercise.is_none() {
        state.edits.leave(own.tree.as_deref(), &own.settings.expression);
        state.learning.before.get_or_insert(own);
    }
    find_tree(state, engine, &folder);
    state.session.settings = settings;
    state.select(Selected::Nothing);
    let model = PathBuf::from(&exercise.model);
    let is_default = exercise.model == crate::scene::BUILT_IN[0] && state.model.requested.is_none();
    let is_alone = state.load_options.added.is_empty();
    if !is_alone || (state.model.requested.as_ref() != Some(&model) && !is_default) {
        load_models(state, engine, (Some(model), None), Vec::new());
    }
}

pub(in crate::app) fn on_exercise(
    state: &mut State,
    engine: &mut Engine,
    folder: PathBuf,
    exercise: Option<Arc<Exercise>>,
) {
    if state.source.root() != Some(&folder) || (state.learning.exercise.is_none() && exercise.is_none()) {
        return;
    }
    engine.threads.checker.supersede();
    let is_one = exercise.is_some();
    state.learning.open(&folder, exercise);
    if is_one {
        state.hint.hide();
        state.workspace.request(PanelRequest::ShowExercise);
    }
    if state.picture.settled.is_some()
        && state.picture.settled == state.session.shaders.as_ref().map(|shaders| shaders.generation)
    {
        check_exercise(state, engine);
    }
}

/// Has the checker measure the exercise. Called when the picture shows all of an edit, so that the measurement delays none.
pub(in crate::app) fn check_exercise(state: &mut State, engine: &mut Engine) {
    let Some(exercise) = state.learning.exercise.clone() else { return };
    state.learning.update_solution(state.session.shaders.as_deref());
    let generation = state.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    state.learning.check(engine.threads.checker.check(exercise, state.source.clone()), generation);
}

/// Measures again what a save without an effect has superseded.
pub(in crate::app) fn check_again(state: &mut State, engine: &mut Engine) {
    if state.learning.checking.is_some() {
        check_exercise(state, engine);
    }
}

pub(in crate::app) fn on_checked(state: &mut State, Checked { number, result }: Checked) {
    if state.learning.checking.take_if(|awaited| *awaited == number).is_none() {
        return;
    }
    let Some(exercise) = state.learning.exercise.clone() else { return };
    state.learning.measured = match result {
        Ok(findings) => Measured::Findings(findings),
        Err(message) => Measured::Failed(message),
    };
    let passed = state.learning.is_solved();
    if passed {
        state.learning.progress.update(&exercise, |record| record.solved = true);
    }
    if let Measured::Findings(goals) = &state.learning.measured {
        emit(&state.events, &Event::Exercise { name: &exercise.name, passed, goals });
    }
}

/// Opens the file of the exercise at the line that matters.
fn edit_exercise(state: &mut State, engine: &mut Engine, exercise: &Exercise) {
    let path = TreePath::from(exercise.open.file.as_str());
    let text = state.session.shaders.as_ref().and_then(|shaders| shaders.texts.get(&path));
    let line = text.and_then(|text| exercise.line_to_open(text));
    let file = state.learning.folder.join(path.as_str());
    edit(state, engine, &Place { file, line, column: None }).unwrap_or_else(|message| state.say(message));
}

/// Writes files of the exercise, on a thread of its own.
fn write_exercise(state: &mut State, engine: &mut Engine, files: Vec<(TreePath, String)>, done: &'static str) {
    let (folder, shaders) = (state.learning.folder.clone(), state.session.shaders.clone());
    engine.threads.wait(move || {
        let shown = |path: &TreePath| shaders.as_ref()?.texts.get(path).cloned();
        let write = |(path, text): (TreePath, String)| (shown(&path), folder.join(path.as_str()), Arc::from(text));
        let writes: Vec<_> = files.into_iter().map(write).collect();
        Some(Message::FilesWritten(write_files(&folder, &writes).map(|written| (done.to_owned(), written))))
    });
}

/// The files at the start of an exercise: those that the solution changes, and those that the shaders on screen have otherwise.
fn files_to_restore(exercise: &Exercise, shaders: Option<&ShaderSet>) -> Vec<(TreePath, String)> {
    let read = shaders.into_iter().flat_map(|shaders| shaders.texts.keys());
    let paths: BTreeSet<&TreePath> = exercise.solution().map(|(path, _)| path).chain(read).collect();
    let at_start = |path: &TreePath| Some((path.clone(), exercise.text_at_start(path)?));
    let differs = |(path, text): &(TreePath, String)| {
        shaders.and_then(|shaders| shaders.texts.get(path)).is_none_or(|now| **now != **text)
    };
    paths.into_iter().filter_map(at_start).filter(differs).collect()
}
