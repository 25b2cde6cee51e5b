//! The only place where shaders, the device and the scene meet.
//!
//! [`Reloader`] turns a set of changed files into a [`PipelineSet`], all or nothing, on any thread. [`GpuScene`] is a model on the
//! device. [`Renderer::frame`] draws one with the other.

pub mod brdf;
mod capture;
mod compute;
mod disk_cache;
mod draw;
mod environment;
mod frame;
mod pipelines;
mod pixel;
mod reload;
mod scene;
mod shot;
mod targets;
mod uniforms;
mod values;
mod wanted;

pub use brdf::measured::measured_buffer;
pub use capture::Capture;
pub use environment::Baked;
pub use environment::bake::{BakeControl, BakeError, BakeReport, GpuEnvironment};
pub use frame::{Drawn, FrameInput, Renderer, Target, UiFrame};
pub use pipelines::{MEASURE_STAGES, PipelineSet, all_stages, stages};
pub use pixel::PixelValue;
pub use reload::{Outcome, Reload, Reloader, tree_name};
pub use scene::{GpuScene, UploadError};
pub use shot::Shot;
pub use values::{misfits, number, unknown_names};
pub use wanted::{MaterialVariant, Wanted};
