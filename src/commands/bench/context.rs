//! The renderer, the tree and the samples of a measurement.

use std::sync::Arc;

use crossbeam_channel::{Receiver, unbounded};
use specula::gpu::Gpu;
use specula::headless::Headless;
use specula::scene::Model;
use specula::settings::Settings;
use specula::shader::{Batch, Compiler, Source, Watcher};

use super::args::Args;
use super::folder::{TempFolder, copy_tree};
use crate::commands::Failure;
use crate::commands::progress::Progress;

/// State that all measurements share.
pub(super) struct Bench<'a> {
    pub(super) args: &'a Args,
    pub(super) gpu: &'a Arc<Gpu>,
    pub(super) compiler: &'a Arc<Compiler>,
    pub(super) progress: &'a Progress,
}

impl Bench<'_> {
    pub(super) fn model(&self) -> Result<Model, Failure> {
        self.args.common.model_silently(self.args.models.model.as_deref())
    }

    pub(super) fn renderer(&self, source: Source, settings: Settings, model: Model) -> Result<Headless, Failure> {
        let (headless, _) = Headless::new(self.gpu, self.compiler, source, model, settings, self.args.common.size())?;
        Ok(headless)
    }

    /// The numbers of the samples, from 0.
    pub(super) fn samples(&self) -> impl Iterator<Item = u32> {
        let count = self.args.samples;
        (0..count).inspect(move |sample| self.progress.begin("sample", (*sample as usize, count as usize), ""))
    }

    /// A copy of the tree, what watches it, and the batches of its changes.
    pub(super) fn watched_copy(&self) -> Result<(TempFolder, Watcher, Receiver<Batch>), Failure> {
        let folder = TempFolder::new()?;
        copy_tree(&self.args.common.source()?, &folder.0)?;
        let (sender, batches) = unbounded::<Batch>();
        let on_batch = move |batch| {
            let _ = sender.send(batch);
        };
        let watcher = Watcher::new(Some(&folder.0), &[], on_batch).map_err(|e| Failure::Input(e.to_string()))?;
        Ok((folder, watcher, batches))
    }
}
