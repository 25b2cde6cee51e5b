//! The exercise that is open in the window, and what has been measured of it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::shaders::difference::{Line, difference};
use crate::learn::{Exercise, Finding, Progress};
use crate::recovery::SessionState;
use crate::shader::{ShaderSet, TreePath};

/// Commands that the exercise panel sends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) enum LearnCommand {
    /// Open the exercise with this number.
    Open(usize),
    /// Show the list of exercises.
    List,
    /// Show one hint more.
    Hint,
    /// Show what the solution changes, or hide it.
    Solution,
    /// Write the solution over the files.
    Solve,
    /// Write the files of the start over the files.
    StartOver,
    /// Open the file of the exercise in the editor.
    Edit,
}

/// The state of the measurement of the goals.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum Measured {
    /// Nothing has been measured yet.
    #[default]
    Nothing,
    /// A finding for each goal.
    Findings(Vec<Finding>),
    /// Why the tree was not measured.
    Failed(String),
}

/// The exercise that is open.
#[derive(Default)]
pub(in crate::app) struct Learning {
    /// `None`: the tree does not belong to an exercise, and the panel shows the list.
    pub(in crate::app) exercise: Option<Arc<Exercise>>,
    /// Folder of its tree.
    pub(in crate::app) folder: PathBuf,
    pub(in crate::app) progress: Progress,
    /// The session before the first exercise, which goes on once another tree is opened.
    pub(in crate::app) before: Option<SessionState>,
    pub(in crate::app) measured: Measured,
    /// Number of the request whose result is awaited.
    pub(in crate::app) checking: Option<u64>,
    /// The generation of the shaders that were measured last, or are being measured.
    generation: u64,
    /// Whether the list is shown although an exercise is open.
    pub(in crate::app) shows_list: bool,
    /// Difference between the current files and the solution, while the solution is shown.
    pub(in crate::app) solution: Option<Vec<Line>>,
    /// Whether the confirmation for writing the start files is open.
    pub(in crate::app) asks: bool,
}

impl Learning {
    pub(in crate::app) fn restored() -> Self {
        Self { progress: Progress::load(), ..Self::default() }
    }

    /// The folder that holds the folders of the exercises.
    pub(in crate::app) fn parent(&self) -> PathBuf {
        let standard = || std::path::absolute("specula-learn").unwrap_or_else(|_| "specula-learn".into());
        self.progress.folder.clone().unwrap_or_else(standard)
    }

    /// Whether a tree lies where the exercises do.
    pub(in crate::app) fn holds(&self, tree: Option<&Path>) -> bool {
        tree.is_some_and(|tree| tree.parent() == Some(&self.parent()))
    }

    /// Sets the exercise of a tree that has been opened.
    pub(in crate::app) fn open(&mut self, folder: &Path, exercise: Option<Arc<Exercise>>) {
        let (progress, before) = (std::mem::take(&mut self.progress), self.before.take());
        *self = Self { exercise, folder: folder.to_owned(), progress, before, ..Self::default() };
    }

    /// Notes that shaders of this generation are being measured, by the request with this number.
    pub(in crate::app) fn check(&mut self, number: u64, generation: u64) {
        (self.checking, self.generation) = (Some(number), generation);
    }

    /// Whether the findings are of an older edit than that of `generation`, which is being measured or will be.
    pub(in crate::app) fn is_outdated(&self, generation: u64) -> bool {
        self.checking.is_some() || self.generation != generation
    }

    /// Whether all goals are reached.
    pub(in crate::app) fn is_solved(&self) -> bool {
        matches!(&self.measured, Measured::Findings(all) if all.iter().all(|finding| finding.passed))
    }

    /// Compares the solution with the current shaders.
    pub(in crate::app) fn update_solution(&mut self, shaders: Option<&ShaderSet>) {
        let Some((exercise, shaders)) = self.exercise.as_ref().zip(shaders) else { return };
        if self.solution.is_none() {
            return;
        }
        let after: BTreeMap<TreePath, Arc<str>> =
            exercise.solution().map(|(path, text)| (path.clone(), Arc::from(text))).collect();
        let before = after.keys().filter_map(|path| Some((path.clone(), shaders.texts.get(path)?.clone()))).collect();
        self.solution = Some(difference(&before, &after));
    }
}
