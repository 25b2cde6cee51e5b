//! A reload: changed files in, a new pipeline set or diagnostics out. Nothing that works is touched on the way.

use std::sync::Arc;
use std::time::Instant;

use crate::gpu::{Gpu, SetLayouts};
use crate::shader::{Change, Diagnostic, Library, Report, ShaderSet, Source, Update};

use super::pipelines::{PipelineSet, STAGES};
use super::wanted::Wanted;

/// Compiles a shader tree and builds its pipelines. `app` holds it on a thread of its own; headless calls it directly.
pub struct Reloader {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    library: Library,
    current: Option<Arc<ShaderSet>>,
    unbuilt: bool,
}

/// What a reload came to.
pub enum Outcome {
    /// No stage changed. `cleared`: the tree is good again after a failed reload, so old diagnostics are void.
    Unchanged {
        /// Whether diagnostics on screen are void now.
        cleared: bool,
    },
    /// New pipelines.
    Ready(Arc<PipelineSet>),
    /// Why there are none. The last good set stays.
    Failed(Vec<Diagnostic>),
}

/// A finished reload.
pub struct Reload {
    /// What was compiled, and how long it took.
    pub report: Report,
    /// Time to create the pipelines, milliseconds.
    pub pipeline_ms: f64,
    /// What it came to.
    pub outcome: Outcome,
}

impl Reloader {
    /// For the tree of `source`. Compiles nothing yet.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, source: Source) -> Self {
        Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            library: Library::new(source, &STAGES),
            current: None,
            unbuilt: false,
        }
    }

    /// The tree.
    pub fn library(&self) -> &Library {
        &self.library
    }

    /// Compiles what `change` made dirty and builds the pipelines that `wanted` names for the new shaders.
    ///
    /// `superseded` is asked between the steps; when it says that a newer edit waits, the work is dropped as unchanged and its
    /// stages are built with that edit.
    pub fn update(
        &mut self,
        change: Change,
        wanted: impl FnOnce(&ShaderSet) -> Result<Wanted, String>,
        superseded: impl Fn() -> bool,
    ) -> Reload {
        let (shaders, report) = match self.library.update(change) {
            Update::Failed(diagnostics, report) => {
                return Reload { report, pipeline_ms: 0.0, outcome: Outcome::Failed(diagnostics) };
            }
            Update::Ready(shaders, report) => {
                self.unbuilt = true;
                (shaders, report)
            }
            Update::Unchanged { cleared, report } => match &self.current {
                Some(shaders) if self.unbuilt => (shaders.clone(), report),
                _ => return Reload { report, pipeline_ms: 0.0, outcome: Outcome::Unchanged { cleared } },
            },
        };
        self.current = Some(shaders.clone());
        if superseded() {
            return Reload { report, pipeline_ms: 0.0, outcome: Outcome::Unchanged { cleared: false } };
        }
        let start = Instant::now();
        let built = wanted(&shaders).and_then(|wanted| {
            PipelineSet::new(&self.gpu, &self.layouts, shaders, &wanted).map_err(|e| e.to_string())
        });
        let pipeline_ms = start.elapsed().as_secs_f64() * 1e3;
        let outcome = match built {
            Ok(set) => {
                self.unbuilt = false;
                Outcome::Ready(set)
            }
            Err(message) => Outcome::Failed(vec![Diagnostic::error(self.library.display_root(), None, message)]),
        };
        Reload { report, pipeline_ms, outcome }
    }
}
