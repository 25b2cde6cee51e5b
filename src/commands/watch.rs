//! Waiting for saves, for `render --watch`.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use crossbeam_channel::{Receiver, unbounded};
use specula::headless::Headless;
use specula::shader::{Batch, Source, Watcher};

use super::Failure;

/// Watches a shader tree and a model's files.
pub struct Watch {
    watcher: Watcher,
    batches: Receiver<Batch>,
    model_files: BTreeSet<PathBuf>,
    environment_files: BTreeSet<PathBuf>,
    measured_files: BTreeSet<PathBuf>,
}

/// What changed together.
pub struct Changes {
    /// Changed files, absolute.
    pub paths: BTreeSet<PathBuf>,
    /// Whether one of them is the model's.
    pub model: bool,
    /// Whether one of them is the environment's.
    pub environment: bool,
    /// Whether one of them is the measured BRDF's.
    pub measured: bool,
    /// When the first event came.
    pub first_event: Instant,
}

impl Watch {
    /// Starts watching.
    pub fn new(source: &Source) -> Result<Self, Failure> {
        let (sender, batches) = unbounded();
        let on_batch = move |batch| {
            let _ = sender.send(batch);
        };
        let watcher = Watcher::new(source.root(), &[], on_batch).map_err(|e| Failure::Input(e.to_string()))?;
        let (model_files, environment_files, measured_files) = Default::default();
        Ok(Self { watcher, batches, model_files, environment_files, measured_files })
    }

    /// Watches the files of the model, the environment and the measured BRDF too, in place of those before.
    pub fn follow(&mut self, headless: &Headless) {
        let model = headless.model();
        let (environment, measured) = (headless.environment_files(), headless.measured_files());
        let files: Vec<PathBuf> = model.files.iter().chain(&environment).chain(&measured).cloned().collect();
        self.watcher.set_files(&files);
        self.model_files = both_names(&model.files);
        self.environment_files = both_names(&environment);
        self.measured_files = both_names(&measured);
    }

    /// Waits for the next changes; `None` when watching has ended.
    pub fn next(&mut self) -> Option<Changes> {
        let batch = self.batches.recv().ok()?;
        let model = batch.paths.iter().any(|path| self.model_files.contains(path));
        let environment = batch.paths.iter().any(|path| self.environment_files.contains(path));
        let measured = batch.paths.iter().any(|path| self.measured_files.contains(path));
        Some(Changes { paths: batch.paths, model, environment, measured, first_event: batch.first_event })
    }
}

/// Each file as it was named and without symbolic links.
fn both_names(files: &[PathBuf]) -> BTreeSet<PathBuf> {
    let resolved = files.iter().map(|file| file.canonicalize().unwrap_or_else(|_| file.clone()));
    files.iter().cloned().chain(resolved).collect()
}
