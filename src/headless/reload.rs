//! Compiles the shaders again, and keeps the last good ones.

use std::sync::Arc;

use super::{Headless, HeadlessError};
use crate::frame::{PipelineRequest, TargetFormat};
use crate::gpu::GpuError;
use crate::pipeline::{Outcome, Reload, Reloader, endless_loop};
use crate::render::BakeError;
use crate::shader::{Change, ShaderSet};

impl Headless {
    /// Reloads changed shaders. On failure the last good shaders stay.
    pub fn update(&mut self, change: Change) -> Reload {
        self.reload(|reloader, request| reloader.update(change, request))
    }

    /// Reloads the changed shaders that the next frame needs. [`Headless::finish`] compiles the others.
    pub fn update_first(&mut self, change: Change) -> Reload {
        self.reload(|reloader, request| reloader.update_first(change, true, request, || false))
    }

    /// Reloads the changed shaders that a window needs for its next picture: not those that only bake light.
    pub fn update_on_screen(&mut self, change: Change) -> Reload {
        self.reload(|reloader, request| reloader.update_first(change, false, request, || false))
    }

    /// Selects whether edits compile whole stages instead of edited functions.
    pub fn compile_whole(&mut self, is_whole: bool) {
        self.reloader.compile_whole(is_whole);
    }

    /// Compiles the stages that [`Headless::update_first`] has left; `None` if there are none.
    pub fn finish(&mut self) -> Option<Reload> {
        let is_pending = self.session.shaders.as_ref().is_some_and(|shaders| !shaders.pending.is_empty());
        is_pending.then(|| self.reload(|reloader, request| reloader.finish(request, || false)))
    }

    pub(super) fn reload(
        &mut self,
        reload: impl FnOnce(&mut Reloader, &dyn Fn(&Arc<ShaderSet>) -> PipelineRequest) -> Reload,
    ) -> Reload {
        // `open` has checked that the target exists, so the fallback is never used unless the settings change.
        let target = self.target().unwrap_or(TargetFormat::full(1));
        let session = &self.session;
        let reload = reload(&mut self.reloader, &|shaders| session.pipelines(shaders, target));
        match &reload.outcome {
            Outcome::Ready(set) => {
                self.resources.set_pipelines(set);
                self.session.shaders = Some(set.shaders.clone());
                self.session.diagnostics.clone_from(&set.shaders.warnings);
            }
            Outcome::Failed(diagnostics) => self.session.diagnostics.clone_from(diagnostics),
            Outcome::Unchanged { .. } => {}
        }
        reload
    }

    pub(super) fn finish_or_fail(&mut self) -> Result<(), HeadlessError> {
        match self.finish().map(|reload| reload.outcome) {
            Some(Outcome::Failed(diagnostics)) => Err(HeadlessError::Shaders(diagnostics)),
            _ => Ok(()),
        }
    }

    /// Watches the expression of the settings.
    pub(super) fn watch(&mut self) -> Result<Option<Change>, HeadlessError> {
        self.reloader.watch(&self.session.settings.expression).map_err(HeadlessError::Settings)
    }

    pub(super) fn compile_all(&mut self) -> Result<Reload, HeadlessError> {
        let reload = self.update(Change::All);
        match &reload.outcome {
            Outcome::Ready(_) => Ok(reload),
            Outcome::Failed(diagnostics) => Err(HeadlessError::Shaders(diagnostics.clone())),
            Outcome::Unchanged { .. } => Err(HeadlessError::Shaders(Vec::new())),
        }
    }

    /// Replaces the error of a loop that did not end by a diagnostic with the loop's line.
    pub(super) fn explained(&self, error: HeadlessError) -> HeadlessError {
        let words = match &error {
            HeadlessError::Gpu(GpuError::EndlessLoop(words))
            | HeadlessError::Bake(BakeError::Gpu(GpuError::EndlessLoop(words))) => *words,
            _ => return error,
        };
        let library = self.reloader.library();
        let diagnostic = endless_loop(&self.gpu, words, &self.shaders(), library.compiler(), library.source());
        diagnostic.map_or(error, |diagnostic| HeadlessError::Shaders(vec![diagnostic]))
    }
}
