//! `specula learn`: exercises in which a student repairs or extends the shaders, and the program checks the result.
//!
//! An exercise is data in `assets/learn/NN-name/`: a text, what is wrong with the shipped tree at its start, and a list of goals
//! that are measured. Nothing of it is compiled into a special case: [`Exercise::open`] takes any folder of that form.
//!
//! The start of an exercise is the shipped tree with `[[fault]]` edits and the files of `start/`; its solution has
//! `[[solution]]` edits and the files of `solution/`. Edits instead of whole files keep an exercise true when the
//! shipped file changes: a text that is no longer found exactly once fails a test. A `[[goal]]` has a sentence and a
//! check (`Check` in `goal.rs`). Most checks compare with the tree of the solution on the same device, so no reference
//! pictures are stored. The folder of a student holds the whole tree and `EXERCISE.md`, whose last line names the
//! exercise, so any way to open the folder opens it. The checker compiles the student's tree a second time: on two
//! cores, an edit that is saved just then waits for its share of them.

mod exercise;
mod folder;
mod goal;
mod goal_meter;
mod measured;
mod progress;
mod shown;

use std::path::Path;
use std::sync::{Arc, LazyLock};

use include_dir::{Dir, include_dir};

pub use exercise::{Exercise, FileToOpen, Level};
pub use folder::{exercise_of, prepare};
pub use goal::{Finding, Goal};
pub use goal_meter::{GoalMeter, LearnError};
pub use progress::{Progress, Record};

/// The exercises that the program embeds, with their texts.
static EXERCISES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/learn");

/// All exercises, in order.
pub fn exercises() -> &'static [Arc<Exercise>] {
    static ALL: LazyLock<Vec<Arc<Exercise>>> = LazyLock::new(|| {
        let mut folders: Vec<&Dir<'_>> = EXERCISES.dirs().collect();
        folders.sort_by_key(|folder| folder.path());
        // A test reads every exercise, so none is left out.
        folders.into_iter().filter_map(|folder| Exercise::embedded(folder).ok()).map(Arc::new).collect()
    });
    &ALL
}

/// The exercise with this number, slug (`fresnel`) or folder name (`03-fresnel`), or that of a folder of the user's own.
///
/// # Errors
/// A message with the nearest name, or with what is wrong in the folder.
pub fn find(name: &str) -> Result<Arc<Exercise>, String> {
    if Path::new(name).join(exercise::DESCRIPTION).exists() {
        return Exercise::open(Path::new(name)).map(Arc::new);
    }
    let all = exercises();
    let is_named = |exercise: &&Arc<Exercise>| {
        name.parse() == Ok(exercise.number) || name == exercise.slug() || name == exercise.name
    };
    all.iter().find(is_named).cloned().ok_or_else(|| {
        let hint = crate::message::did_you_mean(name, all.iter().map(|exercise| exercise.slug()));
        format!(
            "there is no exercise '{name}'.{hint} It can be 1 to {}, a name, or a folder with an exercise.toml; `specula learn list` lists them",
            all.len()
        )
    })
}
