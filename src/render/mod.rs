//! The only place where shaders, the device and the scene meet.
//!
//! [`Reloader`] turns a set of changed files into a [`PipelineSet`], all or nothing, on any thread. [`GpuScene`] is a model on the
//! device. [`Renderer::frame`] draws one with the other.

mod capture;
mod frame;
mod mips;
mod pipelines;
mod reload;
mod scene;
mod shot;
mod targets;
mod uniforms;
mod values;
mod wanted;

pub use capture::Capture;
pub use frame::{Drawn, FrameInput, Renderer, Target, UiFrame};
pub use pipelines::{PipelineSet, STAGES};
pub use reload::{Outcome, Reload, Reloader, tree_name};
pub use scene::{GpuScene, UploadError};
pub use shot::Shot;
pub use values::{misfits, number, unknown_names};
pub use wanted::{MaterialVariant, Wanted};
