//! The only place where shaders, the device and the scene meet.
//!
//! [`Reloader`] turns a set of changed files into a [`PipelineSet`], all or nothing, on any thread. [`GpuScene`] is a model on the
//! device. [`Renderer::frame`] draws one with the other.

mod bake;
mod bake_passes;
mod cache;
mod capture;
mod draw;
mod dress;
mod environment;
mod frame;
mod ltc;
mod materials;
pub mod measure;
mod measured;
mod mips;
mod pipelines;
mod reload;
mod scene;
mod shot;
mod sources;
mod tables;
mod targets;
mod task;
mod uniforms;
mod values;
mod wanted;

pub use bake::{BakeControl, BakeError, BakeReport, GpuEnvironment};
pub use capture::Capture;
pub use environment::Baked;
pub use frame::{Drawn, FrameInput, Renderer, Target, UiFrame};
pub use measured::measured_buffer;
pub use pipelines::{MEASURE_STAGES, PipelineSet, all_stages, stages};
pub use reload::{Outcome, Reload, Reloader, tree_name};
pub use scene::{GpuScene, UploadError};
pub use shot::Shot;
pub use values::{is_absent, misfits, number, unknown_names};
pub use wanted::{MaterialVariant, Wanted};
