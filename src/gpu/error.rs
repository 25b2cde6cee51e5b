//! What can go wrong on the device, in words for the person at the screen.

use ash::vk;

/// A failure of the Vulkan device or of what was asked of it.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No Vulkan loader library.
    #[error(
        "no Vulkan loader found ({0}); install one, on Debian and Ubuntu: apt-get install libvulkan1 mesa-vulkan-drivers"
    )]
    NoLoader(String),
    /// The loader is there, but no device fits.
    #[error("no usable Vulkan device: {0}")]
    NoDevice(String),
    /// The validation layers were asked for and are missing.
    #[error(
        "the Vulkan validation layers are not installed; on Debian and Ubuntu: apt-get install vulkan-validationlayers"
    )]
    NoValidation,
    /// The driver gave up on the device.
    #[error(
        "the graphics device was lost while {0}. An endless loop or a very long shader is the usual cause: the driver stops \
         it after a few seconds. Undo the last edit and start again"
    )]
    DeviceLost(&'static str),
    /// Out of device memory, with what was being made.
    #[error("out of graphics memory while {0}; a smaller window, `--set view.msaa=1` or a smaller model needs less")]
    OutOfMemory(String),
    /// Any other Vulkan result.
    #[error("Vulkan failed while {action}: {result}")]
    Vulkan {
        /// What was being done, as "creating the swapchain".
        action: String,
        /// The result code.
        result: vk::Result,
    },
    /// The allocator refused.
    #[error("allocating memory for {what} failed: {message}")]
    Allocation {
        /// The object's name.
        what: String,
        /// The allocator's own message.
        message: String,
    },
    /// A pipeline needs a stage that the shader tree does not have.
    #[error("the shader tree has no {0}")]
    NoStage(String),
    /// The user-interface renderer failed.
    #[error("drawing the user interface failed: {0}")]
    Ui(String),
}

/// Adds what was being done to a Vulkan result.
pub(super) trait Context<T> {
    fn context(self, action: &'static str) -> Result<T, GpuError>;
}

impl<T> Context<T> for Result<T, vk::Result> {
    fn context(self, action: &'static str) -> Result<T, GpuError> {
        self.map_err(|result| match result {
            vk::Result::ERROR_DEVICE_LOST => GpuError::DeviceLost(action),
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => GpuError::OutOfMemory(action.into()),
            result => GpuError::Vulkan { action: action.into(), result },
        })
    }
}
