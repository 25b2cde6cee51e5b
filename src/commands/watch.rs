//! Waits for saves, for `render --watch`.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use crossbeam_channel::{Receiver, unbounded};
use specula::scene::Model;
use specula::shader::{Batch, Source, Watcher};

use super::Failure;

/// Watches a shader tree, and the files of a model and an environment.
pub struct Watch {
    watcher: Watcher,
    batches: Receiver<Batch>,
    model_files: BTreeSet<PathBuf>,
    environment_files: BTreeSet<PathBuf>,
}

/// What changed together.
pub struct Changes {
    /// Changed files, as the tree, the model and the environment name them.
    pub paths: BTreeSet<PathBuf>,
    /// Whether the model has one of the files.
    pub model: bool,
    /// Whether the environment has one of the files.
    pub environment: bool,
    /// When the first event arrived.
    pub first_event: Instant,
}

impl Watch {
    /// Starts to watch a tree.
    pub fn new(source: &Source) -> Result<Self, Failure> {
        let (sender, batches) = unbounded();
        let on_batch = move |batch| {
            let _ = sender.send(batch);
        };
        let watcher = Watcher::new(source.root(), &[], on_batch).map_err(|e| Failure::Input(e.to_string()))?;
        Ok(Self { watcher, batches, model_files: BTreeSet::new(), environment_files: BTreeSet::new() })
    }

    /// Watches these files of a model and of an environment, too, in place of those before.
    pub fn follow(&mut self, model: &Model, environment: &[PathBuf]) {
        self.model_files = model.files.iter().cloned().collect();
        self.environment_files = environment.iter().cloned().collect();
        let files: Vec<PathBuf> = self.model_files.union(&self.environment_files).cloned().collect();
        self.watcher.set_files(&files);
    }

    /// Waits for the next changes; `None` when watching has ended.
    pub fn next(&mut self) -> Option<Changes> {
        let batch = self.batches.recv().ok()?;
        let model = !batch.paths.is_disjoint(&self.model_files);
        let environment = !batch.paths.is_disjoint(&self.environment_files);
        Some(Changes { paths: batch.paths, model, environment, first_event: batch.first_event })
    }
}
