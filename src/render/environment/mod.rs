//! The environment in use: which one, and with which shaders it was baked.

pub(super) mod bake;
mod passes;

use std::path::PathBuf;
use std::sync::Arc;

use crate::gpu::{Gpu, GpuError};
use crate::scene::EnvironmentFile;

use crate::render::environment::bake::{BakeControl, BakeError, GpuEnvironment};
use crate::render::pipelines::PipelineSet;

/// A finished bake.
#[derive(Clone)]
pub struct Baked {
    name: String,
    with: Option<Arc<PipelineSet>>,
    /// What the frame binds.
    pub environment: Arc<GpuEnvironment>,
    /// The files that it was made from; these are watched.
    pub files: Vec<PathBuf>,
}

impl Baked {
    /// The same radiance from everywhere: what is bound without an environment, and until the first one is baked.
    ///
    /// # Errors
    /// The device.
    pub fn uniform(gpu: &Arc<Gpu>, radiance: [f32; 3]) -> Result<Self, GpuError> {
        let environment = GpuEnvironment::uniform(gpu, radiance)?;
        Ok(Self { name: String::new(), with: None, environment, files: Vec::new() })
    }

    /// Whether this is what `name` looks like with these shaders.
    pub fn is_for(&self, name: &str, set: &PipelineSet) -> bool {
        self.name == name && self.with.as_ref().is_some_and(|with| with.bakes_like(set))
    }

    /// Bakes the environment of this name: a built-in one or a file.
    ///
    /// # Errors
    /// As [`GpuEnvironment::bake`].
    pub fn bake(set: &Arc<PipelineSet>, name: &str, control: &BakeControl<'_>) -> Result<Self, BakeError> {
        let file = EnvironmentFile::open(name)?;
        let environment = GpuEnvironment::bake(set, &file, control)?;
        Ok(Self { name: name.to_owned(), with: Some(set.clone()), environment, files: file.files })
    }
}
