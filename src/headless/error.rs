//! Why rendering failed.

use crate::gpu::GpuError;
use crate::render::{BakeError, PathTracingError, ProvideError, UploadError};
use crate::scene::MeasuredError;
use crate::shader::Diagnostic;

/// Why rendering failed.
#[derive(Debug, thiserror::Error)]
pub enum HeadlessError {
    /// The shaders do not compile, and there are no earlier ones; or one of their loops does not end.
    #[error("the shaders are wrong")]
    Shaders(Vec<Diagnostic>),
    /// A setting does not fit the shaders, the model or the device.
    #[error("{0}")]
    Settings(String),
    /// The user has canceled the picture.
    #[error("canceled")]
    Canceled,
    /// The file of a measured BRDF cannot be read.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The environment cannot be read or baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The model does not fit the device.
    #[error(transparent)]
    Upload(#[from] UploadError),
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl From<ProvideError> for HeadlessError {
    fn from(error: ProvideError) -> Self {
        match error {
            ProvideError::Bake(error) => error.into(),
            ProvideError::Gpu(error) | ProvideError::Trace(PathTracingError::Gpu(error)) => error.into(),
            ProvideError::Trace(error) => Self::Settings(error.to_string()),
            ProvideError::Measured(error) => error.into(),
            ProvideError::Stale => Self::Settings(error.to_string()),
        }
    }
}
