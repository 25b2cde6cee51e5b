//! Errors of the device layer, worded for the person at the screen.

use ash::vk;
use gpu_allocator::AllocationError;

use crate::distribution::install_driver;

/// A failure of the Vulkan device or of a request to it.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is no Vulkan loader library.
    #[error("no usable Vulkan device: there is no Vulkan loader ({0}). {advice}", advice = install_driver())]
    NoLoader(String),
    /// The loader is there, but no driver.
    #[error("no usable Vulkan device: the Vulkan loader found no driver. {advice}", advice = install_driver())]
    NoDriver,
    /// The loader is there, but Specula can use none of its devices.
    #[error("no usable Vulkan device: {0}")]
    NoDevice(String),
    /// Validation was requested, but its layer is missing.
    #[error(
        "the Vulkan validation layers are not installed; on Debian and Ubuntu: apt-get install vulkan-validationlayers"
    )]
    NoValidation,
    /// The device was lost. Contains what Specula was doing.
    #[error(
        "the graphics device was lost while {0}. Usually an endless loop or a very long shader is the cause: the driver \
         stops it after a few seconds. Undo the last edit"
    )]
    DeviceLost(&'static str),
    /// A loop of a compute shader exceeded its iteration limit: the two words that name it, see `shader::spirv::loops`.
    #[error("a loop of the shaders did not end")]
    EndlessLoop([u32; 2]),
    /// Out of memory on the device or the host, with what Specula was doing.
    #[error(
        "out of graphics memory while {0}. A smaller window, fewer samples (`--set view.msaa=1`) or a smaller model \
         needs less"
    )]
    OutOfMemory(String),
    /// Images and buffers of passes take more memory than the user allows: the message with its line.
    #[error("{0}")]
    PassMemory(String),
    /// Any other Vulkan error.
    #[error("Vulkan failed while {action}: {result}")]
    Vulkan {
        /// The action that failed, as "creating the swapchain".
        action: String,
        /// The result code.
        result: vk::Result,
    },
    /// The allocator failed for another reason than a lack of memory.
    #[error("the memory allocator failed while {action}: {message}")]
    Allocation {
        /// The action that failed, as "creating the image `depth`".
        action: String,
        /// The allocator's own message.
        message: String,
    },
    /// A pipeline needs a stage that the shader tree does not have.
    #[error("the shader tree has no {0}")]
    NoStage(String),
    /// A stage reads a resource that is not bound for it. The contract check refuses such stages earlier, with their line.
    #[error("{stage} reads what {role} does not have: {resource}")]
    Unbound {
        /// Path of the stage.
        stage: String,
        /// The role of the stage: `interface::StageRole::name`.
        role: &'static str,
        /// The resource.
        resource: &'static str,
    },
    /// A stage reads more textures than the device has.
    #[error("{0}")]
    Texture(String),
    /// The user interface renderer failed.
    #[error("drawing the user interface failed: {0}")]
    Ui(String),
}

impl GpuError {
    /// Whether memory is lacking, so that smaller frames or other shaders may still be drawn.
    pub fn is_shortage(&self) -> bool {
        matches!(self, Self::OutOfMemory(_) | Self::PassMemory(_))
    }

    /// The error of a Vulkan call. `action` says what Specula was doing; `object` names the object, or is empty.
    pub(super) fn vulkan(result: vk::Result, action: &'static str, object: &str) -> Self {
        let full = || if object.is_empty() { action.to_owned() } else { format!("{action} {object}") };
        match result {
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost(action),
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | vk::Result::ERROR_OUT_OF_HOST_MEMORY => Self::OutOfMemory(full()),
            result => Self::Vulkan { action: full(), result },
        }
    }

    /// The error of the allocator.
    pub(super) fn allocation(error: &AllocationError, action: &str) -> Self {
        match error {
            // Mapping fails only when the host lacks memory or address space.
            AllocationError::OutOfMemory | AllocationError::FailedToMap(_) => Self::OutOfMemory(action.to_owned()),
            // gpu-allocator returns this result only as text.
            AllocationError::Internal(text) if text.contains("ERROR_OUT_OF_HOST_MEMORY") => {
                Self::OutOfMemory(action.to_owned())
            }
            other => Self::Allocation { action: action.to_owned(), message: other.to_string() },
        }
    }
}

/// Turns Vulkan results into errors that say what Specula was doing.
pub(super) trait Context<T> {
    /// `action` continues "failed while", as "creating a fence".
    fn context(self, action: &'static str) -> Result<T, GpuError>;

    /// The same for an object with a name, as "the image `depth`".
    fn context_of(self, action: &'static str, object: &str) -> Result<T, GpuError>;
}

impl<T> Context<T> for Result<T, vk::Result> {
    fn context(self, action: &'static str) -> Result<T, GpuError> {
        self.context_of(action, "")
    }

    fn context_of(self, action: &'static str, object: &str) -> Result<T, GpuError> {
        self.map_err(|result| GpuError::vulkan(result, action, object))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lack_of_memory_is_out_of_memory() {
        for result in [vk::Result::ERROR_OUT_OF_DEVICE_MEMORY, vk::Result::ERROR_OUT_OF_HOST_MEMORY] {
            let error = Err::<(), _>(result).context_of("creating the image", "`depth`").unwrap_err();
            assert!(matches!(&error, GpuError::OutOfMemory(what) if what == "creating the image `depth`"), "{error:?}");
            // The text that gpu-allocator 0.28 makes of a result that it does not know.
            let text = format!("Unexpected error in vkAllocateMemory: {result:?}");
            if result == vk::Result::ERROR_OUT_OF_HOST_MEMORY {
                let error = GpuError::allocation(&AllocationError::Internal(text), "creating the image `depth`");
                assert!(matches!(error, GpuError::OutOfMemory(_)), "{error:?}");
            }
        }
        for error in [AllocationError::OutOfMemory, AllocationError::FailedToMap("no address space".into())] {
            let error = GpuError::allocation(&error, "creating the image `depth`");
            assert!(matches!(error, GpuError::OutOfMemory(_)), "{error:?}");
        }
    }

    #[test]
    fn other_failures_are_not_out_of_memory() {
        let error = Err::<(), _>(vk::Result::ERROR_DEVICE_LOST).context("submitting a frame").unwrap_err();
        assert!(matches!(error, GpuError::DeviceLost("submitting a frame")), "{error:?}");
        let error = GpuError::allocation(&AllocationError::NoCompatibleMemoryTypeFound, "creating the buffer `task`");
        assert!(matches!(error, GpuError::Allocation { .. }), "{error:?}");
    }
}
