//! How commands use images.

use ash::vk;

/// The stages that read images and buffers.
pub(super) const SHADERS: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::from_raw(
    vk::PipelineStageFlags2::PRE_RASTERIZATION_SHADERS.as_raw()
        | vk::PipelineStageFlags2::FRAGMENT_SHADER.as_raw()
        | vk::PipelineStageFlags2::COMPUTE_SHADER.as_raw(),
);

/// How commands use an image: its layout, and the stages and accesses that a transition waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// The contents are undefined.
    Undefined,
    /// Just acquired from the swapchain. The contents are undefined, and color output waits for the acquire semaphore.
    Acquired,
    /// Color attachment.
    Color,
    /// Depth attachment.
    Depth,
    /// Depth attachment that receives the resolved samples of another.
    DepthResolve,
    /// Shaders sample it.
    Sampled,
    /// Compute shaders write and read single levels.
    Storage,
    /// Source of a copy or blit.
    CopyFrom,
    /// Destination of a copy or blit.
    CopyTo,
    /// The presentation engine shows it.
    Present,
}

impl Use {
    pub(super) fn scope(self) -> (vk::PipelineStageFlags2, vk::AccessFlags2, vk::ImageLayout) {
        use vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};
        match self {
            Self::Undefined => (S::ALL_COMMANDS, A::MEMORY_WRITE, L::UNDEFINED),
            Self::Acquired => (S::COLOR_ATTACHMENT_OUTPUT, A::NONE, L::UNDEFINED),
            Self::Color => (
                S::COLOR_ATTACHMENT_OUTPUT,
                A::COLOR_ATTACHMENT_WRITE | A::COLOR_ATTACHMENT_READ,
                L::COLOR_ATTACHMENT_OPTIMAL,
            ),
            Self::Depth => (
                S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS,
                A::DEPTH_STENCIL_ATTACHMENT_WRITE | A::DEPTH_STENCIL_ATTACHMENT_READ,
                L::DEPTH_ATTACHMENT_OPTIMAL,
            ),
            // Vulkan resolves depth as it resolves color.
            Self::DepthResolve => (
                S::COLOR_ATTACHMENT_OUTPUT | S::LATE_FRAGMENT_TESTS,
                A::COLOR_ATTACHMENT_WRITE | A::COLOR_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE,
                L::DEPTH_ATTACHMENT_OPTIMAL,
            ),
            Self::Sampled => (SHADERS, A::SHADER_SAMPLED_READ, L::SHADER_READ_ONLY_OPTIMAL),
            Self::Storage => (S::COMPUTE_SHADER, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE, L::GENERAL),
            Self::CopyFrom => (S::ALL_TRANSFER, A::TRANSFER_READ, L::TRANSFER_SRC_OPTIMAL),
            Self::CopyTo => (S::ALL_TRANSFER, A::TRANSFER_WRITE, L::TRANSFER_DST_OPTIMAL),
            Self::Present => (S::BOTTOM_OF_PIPE, A::NONE, L::PRESENT_SRC_KHR),
        }
    }
}
