//! Why a window or a session without one ends early.

use crate::gpu::GpuError;

/// Why there is no window, or why it closed early.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// No display.
    #[error(
        "no display to open a window on: {0}. Without one, `specula render --watch` writes a new PNG at every save"
    )]
    NoDisplay(String),
    /// A picture that the device cannot draw.
    #[error("--size {0}x{1}: this device draws 1 to {2} pixels a side")]
    Size(u32, u32, u32),
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The validation layers reported messages.
    #[error("the validation layers reported {0} messages (above)")]
    Validation(usize),
}
