//! A reload turns changed files into a new pipeline set or diagnostics. It never modifies the set in use.
//!
//! A new set gets every pipeline that the window needs now, built in parallel. It inherits a pipeline if its stages did
//! not change, or if their specialized modules behave as before (`spirv::behavior_hash`, which ignores the numbering of
//! ids and functions that are never called, and treats equal types and constants as one). So an edit of the clear coat
//! builds pipelines only for materials that have one, and an edit of an NDF that is not selected builds none. A set
//! keeps the pipelines of its 64 newest requests, so dragging sliders all day costs no memory.
//!
//! On a GPU, most of a reload is the driver compiling an optimized module: on an H200, 41 to 64 ms of 55 to 82 ms are
//! the fragment stage (`SPECULA_LOG=debug` prints the time of each pipeline). The driver finds the vertex stage, which
//! an edit leaves alone, in its cache (0.002 ms), so graphics pipeline libraries would save nothing. On lavapipe the
//! driver compiles at the first draw, in the queue: the picture stays, but that frame takes some 200 ms longer.

use std::sync::Arc;
use std::time::Instant;

use crate::gpu::{Gpu, SetLayouts};
use crate::settings::ExpressionSettings;
use crate::shader::{
    Change, Compiler, Diagnostic, Expression, Library, Report, ShaderSet, Source, StageKind, TreePath, Update,
};

use super::limits::beyond_limits;
use super::set::PipelineSet;
use super::textures::PassTextures;
use crate::frame::PipelineRequest;
use crate::frame::stages::{all_stages, stages};

/// Compiles a shader tree and builds its pipelines. In the window the worker thread owns it; headless calls it directly.
pub struct Reloader {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    library: Library,
    current: Option<Arc<PipelineSet>>,
    unbuilt: Option<Report>,
}

/// The result of a reload.
pub enum Outcome {
    /// No stage changed.
    Unchanged {
        /// Whether the tree compiles again after a failed reload, so that earlier diagnostics no longer apply.
        cleared: bool,
    },
    /// New pipelines.
    Ready(Arc<PipelineSet>),
    /// The diagnostics of a failed reload. The last good set stays in use.
    Failed(Vec<Diagnostic>),
}

/// A finished reload.
pub struct Reload {
    /// The compiled stages, and how long they took.
    pub report: Report,
    /// Number of pipelines that were created.
    pub pipelines: usize,
    /// Time to create them, milliseconds.
    pub pipeline_ms: f64,
    /// Its result.
    pub outcome: Outcome,
}

impl Reload {
    /// Whether the device has used or will use anything that the reload compiled: false if nothing has changed, or if the shaders
    /// do not compile.
    pub fn reaches_device(&self) -> bool {
        match &self.outcome {
            Outcome::Ready(_) => true,
            // A superseded reload leaves its pipelines to the newer edit.
            Outcome::Unchanged { .. } => !self.report.stages.is_empty(),
            // The driver has refused a pipeline.
            Outcome::Failed(_) => self.pipeline_ms > 0.0,
        }
    }
}

impl Reloader {
    /// A reloader for the tree of `source`. Compiles nothing yet.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, compiler: &Arc<Compiler>, source: Source) -> Self {
        Self::with(gpu, layouts, Library::new(source, compiler.clone(), &stages()))
    }

    /// [`Reloader::new`] with the stages that measure the BRDF.
    pub fn measuring(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, compiler: &Arc<Compiler>, source: Source) -> Self {
        Self::with(gpu, layouts, Library::new(source, compiler.clone(), &all_stages()))
    }

    fn with(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, library: Library) -> Self {
        Self { gpu: gpu.clone(), layouts: layouts.clone(), library, current: None, unbuilt: None }
    }

    /// Reads another tree, with its number ([`ShaderSet::tree`]). Compiles nothing yet.
    pub fn open(&mut self, source: Source, tree: usize) {
        let mut next = Self::new(&self.gpu, &self.layouts, self.library.compiler(), source);
        next.library.follow(&self.library, tree);
        *self = next;
    }

    /// Reads the same tree from scratch. Compiles nothing yet.
    pub fn restart(&mut self) {
        self.open(self.library.source().clone(), self.library.tree());
    }

    /// Reads the tree from another source. The next update must name the files whose texts this changes.
    pub fn set_source(&mut self, source: Source) {
        self.library.set_source(source);
    }

    /// Watches the expression of the settings. Returns the paths that the next update must name, if anything differs.
    ///
    /// # Errors
    /// A message if the setting is no place and expression. Nothing is watched then.
    pub fn watch(&mut self, settings: &ExpressionSettings) -> Result<Option<Change>, String> {
        let ExpressionSettings { at, evaluation } = settings;
        let parsed = (!at.is_empty()).then(|| Expression::parse(at, *evaluation)).transpose();
        let message = parsed.as_ref().err().map(|error| format!("expression.at: {error}"));
        let change = self.library.watch(parsed.unwrap_or_default());
        message.map_or(Ok(change), Err)
    }

    /// The shader tree.
    pub fn library(&self) -> &Library {
        &self.library
    }

    /// [`Library::compile_whole`].
    pub fn compile_whole(&mut self, is_whole: bool) {
        self.library.compile_whole(is_whole);
    }

    /// Compiles the stages that `change` made dirty, and builds the pipelines that `request` returns for the new shaders.
    pub fn update(&mut self, change: Change, request: impl Fn(&Arc<ShaderSet>) -> PipelineRequest) -> Reload {
        let update = self.library.update(&change);
        self.build(update, request, || false)
    }

    /// [`Reloader::update`] restricted to what is on screen: the stages and pipelines that `request` needs. If these are good,
    /// other stages may be pending in the new set, and [`Reloader::finish`] compiles them.
    ///
    /// With `with_light`, stages that bake light count as on screen; in a window, an edit of them first appears in the previous
    /// light. `superseded` returns whether a newer edit waits. If so, the update ends after compiling with
    /// [`Outcome::Unchanged`], and the next update builds the pipelines.
    pub fn update_first(
        &mut self,
        change: Change,
        with_light: bool,
        request: impl Fn(&Arc<ShaderSet>) -> PipelineRequest,
        superseded: impl Fn() -> bool,
    ) -> Reload {
        let Some(on_screen) = self.library.set().map(|shaders| request(shaders).stages()) else {
            let update = self.compile_first_picture(false);
            return self.build(update, request, superseded);
        };
        let is_first = |path: &TreePath| {
            on_screen.contains(path.as_str()) || (with_light && StageKind::of(path) == Some(StageKind::Compute))
        };
        let update = self.library.update_first(&change, is_first);
        self.build(update, request, superseded)
    }

    /// Compiles what a first frame needs, while the model may still be loading. [`Reloader::build`] takes the result. Declared
    /// passes that are off are skipped, unless `with_all_passes`.
    pub fn compile_first_picture(&mut self, with_all_passes: bool) -> Update {
        self.library.first_picture(with_all_passes)
    }

    /// Compiles the stages that [`Reloader::update_first`] has left. The returned set has the pipelines of the previous one.
    pub fn finish(
        &mut self,
        request: impl Fn(&Arc<ShaderSet>) -> PipelineRequest,
        superseded: impl Fn() -> bool + Sync,
    ) -> Reload {
        let update = self.library.finish(&superseded);
        self.build(update, request, superseded)
    }

    /// Builds the pipelines that `request` returns for the shaders of an update. Ends early if `superseded` says so.
    pub fn build(
        &mut self,
        update: Update,
        request: impl Fn(&Arc<ShaderSet>) -> PipelineRequest,
        superseded: impl Fn() -> bool,
    ) -> Reload {
        let (shaders, report) = match update {
            Update::Failed(diagnostics, report) => {
                return Reload { report, pipelines: 0, pipeline_ms: 0.0, outcome: Outcome::Failed(diagnostics) };
            }
            Update::Ready(shaders, mut report) => {
                // A superseded edit becomes visible with this one.
                if let Some(before) = self.unbuilt.take() {
                    report.changed = joined(before.changed, report.changed);
                }
                self.unbuilt = Some(report.clone());
                (shaders, report)
            }
            Update::Unchanged { cleared } => match self.library.set() {
                Some(shaders) if self.unbuilt.is_some() => (shaders.clone(), self.unbuilt.clone().unwrap_or_default()),
                _ => {
                    let outcome = Outcome::Unchanged { cleared };
                    return Reload { report: Report::default(), pipelines: 0, pipeline_ms: 0.0, outcome };
                }
            },
        };
        if superseded() {
            return Reload { report, pipelines: 0, pipeline_ms: 0.0, outcome: Outcome::Unchanged { cleared: false } };
        }
        let start = Instant::now();
        let before = self.current.as_deref();
        let mut problems = beyond_limits(&self.gpu, &shaders, self.library.source());
        let textures =
            PassTextures::load(&self.gpu, &shaders.graph, before.map(PipelineSet::textures)).unwrap_or_else(|errors| {
                problems.extend(errors.into_iter().map(|error| self.library.source().explained(error)));
                Arc::default()
            });
        if !problems.is_empty() {
            return Reload { report, pipelines: 0, pipeline_ms: 0.0, outcome: Outcome::Failed(problems) };
        }
        let request = request(&shaders);
        let built = PipelineSet::new(&self.gpu, &self.layouts, shaders, textures, &request, before);
        let pipeline_ms = start.elapsed().as_secs_f64() * 1e3;
        let (outcome, pipelines) = match built {
            Ok((set, pipelines)) => {
                self.unbuilt = None;
                self.current = Some(set.clone());
                (Outcome::Ready(set), pipelines)
            }
            Err(error) => {
                (Outcome::Failed(vec![Diagnostic::error(self.library.source().name(), error.to_string())]), 0)
            }
        };
        Reload { report, pipelines, pipeline_ms, outcome }
    }
}

/// The files of two edits, each once.
fn joined(mut earlier: Vec<String>, later: Vec<String>) -> Vec<String> {
    earlier.retain(|file| !later.contains(file));
    earlier.extend(later);
    earlier
}
