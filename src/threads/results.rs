//! The results of the threads.

use std::path::PathBuf;
use std::sync::Arc;

use crate::frame::{MeasuredKey, TablesKey};
use crate::gpu::{Buffer, GpuError};
use crate::learn::Finding;
use crate::measure::Curves;
use crate::pipeline::{PipelineSet, Reload};
use crate::render::{BakeError, BoundFrame, GpuEnvironment, GpuModel, PathTracing, PathTracingKey, Tables};
use crate::shader::trace::{Trace, TraceableStage};
use crate::shader::{Diagnostic, Source};

/// Messages of the worker.
pub(crate) enum WorkerMessage {
    /// A reload is finished.
    Reloaded {
        reload: Box<Reload>,
        /// Milliseconds from the first file event to the settled set of changes.
        detect_ms: f64,
        /// The tree that was compiled.
        source: Source,
        /// Number of edits that the reload contains, for [`super::worker::Worker::reloaded`].
        edits: u64,
    },
    /// The tree at a path, or why there is none.
    TreeFound {
        path: PathBuf,
        tree: Result<Source, String>,
        /// As in `Reloaded`.
        edits: u64,
    },
    /// The stages of the last reload that the frame did not need have been compiled.
    Completed(Box<Reload>),
    /// The result of the last [`super::worker::Worker::build`].
    Built(Result<(), String>),
    /// The pipelines of some thumbnails have been built, or cannot be.
    ThumbnailsBuilt,
    /// Statistics of a pipeline have been queried, after [`super::worker::Worker::ask_driver`].
    DriverTold,
}

/// A finished load.
pub(crate) struct Loaded {
    /// Number of the load; see [`super::loader::Loader::is_newest`].
    pub(crate) number: u64,
    /// The file; `None` is the built-in model.
    pub(crate) path: Option<PathBuf>,
    /// The model on the device, or an error message and the files that were tried.
    pub(crate) result: Result<Arc<GpuModel>, (String, Vec<PathBuf>)>,
    /// Duration in milliseconds.
    pub(crate) ms: f64,
}

/// Messages of the baker.
pub(crate) enum BakeMessage {
    /// Number of the bake, the fraction that is done, 0..1, and the next pass.
    Progress(u64, f32, String),
    /// The result of a bake.
    Environment(u64, Result<Arc<GpuEnvironment>, BakeError>),
    /// BRDF lookup tables.
    Tables(Arc<TablesKey>, Result<Arc<Tables>, GpuError>),
    /// A measured BRDF.
    Measured(MeasuredKey, Result<Arc<Buffer>, String>),
    /// The resources for path tracing.
    PathTracing(PathTracingKey, Result<Arc<PathTracing>, String>),
}

/// Result of a check.
pub(crate) struct Checked {
    /// Number of the request.
    pub(crate) number: u64,
    /// A finding for each goal, or the reason why there are none.
    pub(crate) result: Result<Vec<Finding>, String>,
}

/// Result of a request for curves.
pub(crate) struct MeasuredCurves {
    /// The number of the request.
    pub(crate) number: u64,
    /// The curves of the newest shaders, or the reason why there are none.
    pub(crate) now: Result<Curves, String>,
    /// The curves of the previous shaders, if they could be measured.
    pub(crate) before: Option<Curves>,
    pub(crate) ms: f64,
}

/// The stage and the file that were traced at a pixel, and which others can be.
#[derive(Clone, Debug, Default)]
pub(crate) struct TracedPlace {
    /// The stage; empty if there is none.
    pub(crate) stage: String,
    /// The stages of the picture.
    pub(crate) stages: Vec<TraceableStage>,
    /// The files whose statements the stage has at the pixel.
    pub(crate) files: Vec<String>,
    /// The file whose statements were traced.
    pub(crate) file: String,
}

/// Result of a trace.
pub(crate) struct Traced {
    pub(crate) place: TracedPlace,
    /// The trace, or the reason why there is none.
    pub(crate) trace: Result<Trace, String>,
    /// Pipelines with a log that were built for it.
    pub(crate) built: usize,
    pub(crate) ms: f64,
}

impl Default for Traced {
    fn default() -> Self {
        Self { place: TracedPlace::default(), trace: Err("the trace has not begun".to_owned()), built: 0, ms: 0.0 }
    }
}

/// A result of the thread of a second shader tree.
pub(crate) enum SecondTreeMessage {
    /// The tree was compiled: its pipelines, unless the picture's stages have errors, and the errors of all stages.
    Compiled(Option<Arc<PipelineSet>>, Vec<Diagnostic>),
    /// The frame that [`super::second_tree::SecondTree::provide`] was asked for, or the reason why there is none.
    Provided(Result<Box<BoundFrame>, String>),
}
