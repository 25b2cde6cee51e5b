//! Watches files for `render --watch`.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use crossbeam_channel::{Receiver, unbounded};
use specula::headless::Headless;
use specula::shader::{Batch, Source, Watcher};

use crate::commands::Failure;

/// Watches a shader tree, and the files of the model, the environment and the measured BRDF.
pub struct Watch {
    watcher: Watcher,
    batches: Receiver<Batch>,
    model_files: BTreeSet<PathBuf>,
    environment_files: BTreeSet<PathBuf>,
    measured_files: BTreeSet<PathBuf>,
}

/// A batch of changes.
pub struct Changes {
    /// Changed files, under the names that were given to the watcher.
    pub paths: BTreeSet<PathBuf>,
    /// Whether a file of the model has changed.
    pub model: bool,
    /// Whether the environment's file has changed.
    pub environment: bool,
    /// Whether the measured BRDF's file has changed.
    pub measured: bool,
    /// Time of the first file event.
    pub first_event: Instant,
}

impl Watch {
    /// Starts to watch a tree.
    pub fn new(source: &Source) -> Result<Self, Failure> {
        let (sender, batches) = unbounded();
        let on_batch = move |batch| {
            let _ = sender.send(batch);
        };
        let watcher =
            Watcher::new(source.root(), &source.files(), on_batch).map_err(|e| Failure::Input(e.to_string()))?;
        let (model_files, environment_files, measured_files) = Default::default();
        Ok(Self { watcher, batches, model_files, environment_files, measured_files })
    }

    /// Also watches the current files of the model, the environment, the measured BRDF and a tree that is a single file, instead
    /// of the previous ones.
    pub fn follow(&mut self, headless: &Headless) {
        let model = headless.model();
        let (environment, measured) = (headless.session().environment_files(), headless.session().measured_files());
        let tree = headless.reloader().library().source().files();
        let files: Vec<PathBuf> =
            model.files.iter().chain(&environment).chain(&measured).chain(&tree).cloned().collect();
        self.watcher.set_files(&files);
        self.model_files = model.files.iter().cloned().collect();
        self.environment_files = environment.into_iter().collect();
        self.measured_files = measured.into_iter().collect();
    }

    /// Waits for the next changes. `None` if watching has ended.
    pub fn next(&mut self) -> Option<Changes> {
        let batch = self.batches.recv().ok()?;
        let changed = |files: &BTreeSet<PathBuf>| !batch.paths.is_disjoint(files);
        let (model, environment) = (changed(&self.model_files), changed(&self.environment_files));
        let measured = changed(&self.measured_files);
        Some(Changes { paths: batch.paths, model, environment, measured, first_event: batch.first_event })
    }
}
