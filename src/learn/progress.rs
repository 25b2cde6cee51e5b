//! Progress of a student, kept between runs in `learn.json`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Exercise, exercises};
use crate::state_folder;

const FILE: &str = "learn.json";

/// Progress of a student in one exercise.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Record {
    /// Whether all goals were reached once.
    pub solved: bool,
    /// How many hints were read.
    pub hints: usize,
    /// Whether the solution was shown.
    pub saw_solution: bool,
}

/// Progress of a student in all exercises.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    /// By the names of the exercises.
    records: BTreeMap<String, Record>,
    /// Where the folders of the exercises are, absolute.
    pub folder: Option<PathBuf>,
}

impl Progress {
    /// The stored progress. A file that cannot be read counts as no progress.
    pub fn load() -> Self {
        state_folder::load(FILE).and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
    }

    /// Forgets what was solved, but not where the folders are.
    pub fn reset(&mut self) {
        self.records.clear();
        state_folder::change(FILE, |stored: &mut Self| stored.records.clear());
    }

    /// Remembers where the folders of the exercises are.
    pub fn set_folder(&mut self, folder: PathBuf) {
        self.folder = Some(folder.clone());
        state_folder::change(FILE, |stored: &mut Self| stored.folder = Some(folder));
    }

    /// The record of an exercise.
    pub fn of(&self, exercise: &Exercise) -> Record {
        self.records.get(&exercise.name).cloned().unwrap_or_default()
    }

    /// Changes the record of an exercise, and stores the progress if that changes anything.
    pub fn update(&mut self, exercise: &Exercise, change: impl FnOnce(&mut Record)) {
        let before = self.of(exercise);
        let record = self.records.entry(exercise.name.clone()).or_default();
        change(record);
        if *record != before {
            let record = record.clone();
            state_folder::change(FILE, |stored: &mut Self| _ = stored.records.insert(exercise.name.clone(), record));
        }
    }

    /// How many exercises are solved.
    pub fn solved(&self) -> usize {
        exercises().iter().filter(|exercise| self.of(exercise).solved).count()
    }

    /// The first exercise that is not solved, or the last one.
    pub fn next(&self) -> Option<Arc<Exercise>> {
        let all = exercises();
        all.iter().find(|exercise| !self.of(exercise).solved).or(all.last()).cloned()
    }
}
