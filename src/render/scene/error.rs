//! Why a model cannot be uploaded.

use crate::gpu::GpuError;

/// Why a model cannot be uploaded.
#[derive(Debug, thiserror::Error)]
pub enum UploadError {
    /// An image is too large.
    #[error("image '{name}' is {width}x{height}; this device takes at most {most} pixels a side. Scale it down")]
    ImageTooLarge {
        /// Its name.
        name: String,
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The device's limit.
        most: u32,
    },
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
