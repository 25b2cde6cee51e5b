//! The formats of the images that a picture is drawn to.

use crate::gpu::vk;
use crate::shader::annotation::pass::PassFormat;

/// Format of the HDR target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetFormat {
    /// Format of the HDR color target.
    pub color: vk::Format,
    /// Samples per pixel.
    pub samples: u32,
    /// Whether `resolve.frag` weights the samples of a pixel for the display. Linear light for a file is their plain average.
    pub weighs: bool,
}

impl TargetFormat {
    /// Half floats: precise enough for display, at half the bandwidth.
    pub fn half(samples: u32) -> Self {
        Self { color: vk::Format::R16G16B16A16_SFLOAT, samples, weighs: true }
    }

    /// Full floats, so that readback returns exactly what the shader wrote.
    pub fn full(samples: u32) -> Self {
        Self { color: vk::Format::R32G32B32A32_SFLOAT, samples, weighs: true }
    }

    /// Whether the target holds half floats, in which values beyond 65504 overflow.
    pub fn is_half(self) -> bool {
        self.color == vk::Format::R16G16B16A16_SFLOAT
    }
}

/// Format of the accumulation buffer.
pub(crate) const MEAN_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// The Vulkan format of a pass's image.
pub(crate) fn pass_format(format: PassFormat) -> vk::Format {
    match format {
        PassFormat::Rgba16f => vk::Format::R16G16B16A16_SFLOAT,
        PassFormat::Rgba32f => vk::Format::R32G32B32A32_SFLOAT,
        PassFormat::Rgba8 => vk::Format::R8G8B8A8_UNORM,
        PassFormat::Rg16f => vk::Format::R16G16_SFLOAT,
        PassFormat::Rg32f => vk::Format::R32G32_SFLOAT,
        PassFormat::R16f => vk::Format::R16_SFLOAT,
        PassFormat::R32f => vk::Format::R32_SFLOAT,
    }
}
