//! Why the model cannot be path-traced.

use crate::gpu::GpuError;

/// Why a model cannot be path-traced.
#[derive(Debug, thiserror::Error)]
pub enum PathTracingError {
    /// The scene has too many triangles.
    #[error(
        "random paths trace at most {most} triangles, and this model has more. Modes without `traces` still show it"
    )]
    TooManyTriangles {
        /// The limit.
        most: usize,
    },
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
