//! The only place where shaders, the device and the scene meet.
//!
//! [`FrameState`] says what a picture shows, as a pure function of the settings, the shaders and the model. [`Resources`] holds
//! what is on the device and binds a state to it once everything is there. A [`View`] draws the [`BoundFrame`].
//! [`Reloader`] turns changed files into a new [`PipelineSet`], all or nothing, on any thread.

mod brdf;
pub(crate) mod compute;
mod environment;
mod pipeline;
mod resources;
mod scene;
mod state;
mod view;

pub(crate) use brdf::{ltc, measured::measured_buffer};
pub use environment::bake::{BakeControl, BakeError, BakeReport, GpuEnvironment};
pub use pipeline::{MEASURE_STAGES, Outcome, PipelineSet, Reload, Reloader, all_stages, stages, tree_name};
pub use resources::{BoundFrame, Missing, ProvideError, Resources, read_measured};
pub use scene::{GpuModel, UploadError};
pub use state::{
    EnvironmentKey, FrameInputs, FrameState, MaterialVariant, MeasuredKey, PipelineRequest, Revisions, Scene,
    TargetFormat,
};
pub use view::{Capture, Output, PixelAt, Redraw, View};
pub(crate) use view::{SharedImages, Sources, Uniforms};
