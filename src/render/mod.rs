//! Draws a scene with shaders on a device. No other module knows all three.
//!
//! A [`FrameState`] describes a picture; it is a pure function of settings, shaders and model. [`Resources`] holds all device
//! objects and binds a state to them once none is missing. A [`View`] draws the resulting [`BoundFrame`].
//! A [`Reloader`] turns changed files into a new [`PipelineSet`], all or nothing, on any thread.

mod brdf;
pub(crate) mod compute;
mod environment;
mod paths;
mod pipeline;
mod resources;
mod scene;
mod state;
mod view;

pub(crate) use brdf::measured::measured_buffer;
pub use brdf::tables::{Tables, wrong_values};
pub use environment::bake::{BakeControl, BakeError};
pub use environment::maps::{BakeReport, GpuEnvironment};
pub use paths::{TraceError, TraceKey, TraceRequest, Traced};
pub use pipeline::{MEASURE_STAGES, Outcome, PipelineSet, Reload, Reloader, all_stages, endless_loop, stages};
pub use resources::{BoundFrame, Missing, ProvideError, Resources, read_measured};
pub use scene::{GpuModel, UploadError};
pub use state::{
    EnvironmentKey, FrameInputs, FrameState, MaterialVariant, MeasuredKey, PipelineRequest, Revisions, Scene,
    TablesKey, TargetFormat,
};
pub use view::{Capture, Output, PixelAt, Redraw, View};
pub(crate) use view::{SharedImages, Sources, Uniforms};
