//! Image-based light: environments baked on the device.

pub(super) mod bake;
mod passes;

use std::sync::Arc;

use super::pipeline::PipelineSet;
use crate::scene::EnvironmentFile;
use bake::{BakeControl, BakeError, GpuEnvironment};

/// Bakes the environment of this name, a built-in one or a file, with the stages of `set`. From any thread.
///
/// # Errors
/// As [`GpuEnvironment::bake`].
pub fn bake_named(set: &PipelineSet, name: &str, control: &BakeControl<'_>) -> Result<Arc<GpuEnvironment>, BakeError> {
    GpuEnvironment::bake(set, &EnvironmentFile::open(name)?, control)
}
