//! Exercises: opens their trees, has the checker measure them, and keeps what the student has done.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use super::Viewer;
use super::compare::write_files;
use crate::app::command::Command;
use crate::app::editor::Place;
use crate::app::state::arrangement::Preset;
use crate::app::state::exercise::{LearnCommand, Measured};
use crate::app::state::selection::Selected;
use crate::app::state::workspace::PanelRequest;
use crate::events::{Event, emit};
use crate::learn::{Exercise, exercise_of, exercises, prepare};
use crate::settings::Settings;
use crate::shader::{ShaderSet, TreePath};
use crate::threads::Checked;
use crate::threads::Message;

impl Viewer {
    pub(super) fn learn(&mut self, command: LearnCommand) {
        let learning = &mut self.learning;
        learning.asks &= command == LearnCommand::StartOver;
        match (command, learning.exercise) {
            (LearnCommand::Open(number), _) => self.prepare_exercise(number),
            (LearnCommand::List, _) if self.workspace.sight.learn => learning.shows_list ^= true,
            (LearnCommand::List, _) => {
                learning.shows_list = true;
                self.workspace.request(PanelRequest::Arrange(Preset::Learn));
            }
            (LearnCommand::Hint, Some(exercise)) => {
                let most = exercise.hints.len();
                learning.progress.update(exercise, |record| record.hints = (record.hints + 1).min(most));
            }
            (LearnCommand::Solution, Some(exercise)) => {
                learning.solution = if learning.solution.is_none() { Some(Vec::new()) } else { None };
                learning.progress.update(exercise, |record| record.saw_solution = true);
                learning.update_solution(self.session.shaders.as_deref());
            }
            (LearnCommand::Solve, Some(exercise)) => {
                let files = exercise.solution().map(|(path, text)| (path.clone(), text.to_owned())).collect();
                self.write_exercise(files, "Wrote the solution");
            }
            (LearnCommand::StartOver, Some(_)) if !learning.asks => learning.asks = true,
            (LearnCommand::StartOver, Some(exercise)) => {
                learning.asks = false;
                let shaders = self.session.shaders.as_deref();
                let files = files_to_restore(exercise, shaders);
                self.write_exercise(files, "Restored the original files");
            }
            (LearnCommand::Edit, Some(exercise)) => self.edit_exercise(exercise),
            (_, None) => {}
        }
    }

    /// Writes the tree of an exercise, unless it is there, on a thread of its own.
    fn prepare_exercise(&mut self, number: usize) {
        let Some(exercise) = exercises().iter().find(|exercise| exercise.number == number) else { return };
        let parent = self.learning.parent();
        self.threads.wait(move || Some(Message::Prepared(exercise, prepare(&parent, exercise))));
    }

    pub(super) fn on_prepared(&mut self, exercise: &'static Exercise, prepared: Result<PathBuf, String>) {
        let folder = match prepared {
            Ok(folder) => folder,
            Err(message) => return self.say(message),
        };
        let mut settings = Settings::of_window();
        if let Err(message) = exercise.apply_settings(&mut settings) {
            return self.say(message);
        }
        self.session.settings = settings;
        self.select(Selected::Nothing);
        self.execute(Command::OpenTree(folder));
        let model = PathBuf::from(&exercise.model);
        let is_default = exercise.model == crate::scene::BUILT_IN[0] && self.model.requested.is_none();
        if self.model.requested.as_ref() != Some(&model) && !is_default {
            self.execute(Command::OpenModel(model));
        }
    }

    /// Looks for the exercise of the tree that has been opened, on a thread of its own.
    pub(super) fn find_exercise(&self) {
        if let Some(folder) = self.source.root().map(std::path::Path::to_owned) {
            self.threads.wait(move || {
                let exercise = exercise_of(&folder);
                Some(Message::Exercise(folder, exercise))
            });
        }
    }

    pub(super) fn on_exercise(&mut self, folder: PathBuf, exercise: Option<&'static Exercise>) {
        if self.source.root() != Some(&folder) || (self.learning.exercise.is_none() && exercise.is_none()) {
            return;
        }
        self.threads.checker.supersede();
        self.learning.open(&folder, exercise);
        if exercise.is_some() {
            self.hint.hide();
            self.workspace.request(PanelRequest::ShowExercise);
        }
        if self.settled.is_some() && self.settled == self.session.shaders.as_ref().map(|shaders| shaders.generation) {
            self.check_exercise();
        }
    }

    /// Has the checker measure the exercise. Called when the picture shows all of an edit, so that the measurement delays none.
    pub(super) fn check_exercise(&mut self) {
        let Some(exercise) = self.learning.exercise else { return };
        self.learning.update_solution(self.session.shaders.as_deref());
        self.learning.checking = Some(self.threads.checker.check(exercise, self.source.clone()));
    }

    /// Measures again what a save without an effect has superseded.
    pub(super) fn check_again(&mut self) {
        if self.learning.checking.is_some() {
            self.check_exercise();
        }
    }

    pub(super) fn on_checked(&mut self, Checked { number, result }: Checked) {
        if self.learning.checking.take_if(|awaited| *awaited == number).is_none() {
            return;
        }
        let Some(exercise) = self.learning.exercise else { return };
        self.learning.measured = match result {
            Ok(findings) => Measured::Findings(findings),
            Err(message) => Measured::Failed(message),
        };
        let passed = self.learning.is_solved();
        if passed {
            self.learning.progress.update(exercise, |record| record.solved = true);
        }
        if let Measured::Findings(goals) = &self.learning.measured {
            emit(&self.events, &Event::Exercise { name: &exercise.name, passed, goals });
        }
    }

    /// Opens the file of the exercise at the line that matters.
    fn edit_exercise(&mut self, exercise: &Exercise) {
        let path = TreePath::from(exercise.open.file.as_str());
        let text = self.session.shaders.as_ref().and_then(|shaders| shaders.texts.get(&path));
        let line = text.and_then(|text| exercise.line_to_open(text));
        let file = self.learning.folder.join(path.as_str());
        self.execute(Command::Edit(Place { file, line, column: None }));
    }

    /// Writes files of the exercise, on a thread of its own.
    fn write_exercise(&mut self, files: Vec<(TreePath, String)>, done: &'static str) {
        let (folder, shaders) = (self.learning.folder.clone(), self.session.shaders.clone());
        self.threads.wait(move || {
            let shown = |path: &TreePath| shaders.as_ref()?.texts.get(path).cloned();
            let write = |(path, text): (TreePath, String)| (shown(&path), folder.join(path.as_str()), Arc::from(text));
            let writes: Vec<_> = files.into_iter().map(write).collect();
            Some(Message::Say(write_files(&writes).map_or_else(|message| message, |()| done.to_owned())))
        });
    }
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
