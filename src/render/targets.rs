//! The images that a frame draws to before the picture: HDR color, its multisampled twin, and depth.

use std::sync::Arc;

use crate::gpu::{Gpu, GpuError, Image, ImageDesc, vk};

/// Targets of one size. Replaced as a whole; frames in flight keep the old ones.
pub(super) struct Targets {
    /// Resolved HDR color.
    pub(super) color: Arc<Image>,
    /// Multisampled color, when there is more than one sample.
    pub(super) multisampled: Option<Arc<Image>>,
    /// Depth.
    pub(super) depth: Arc<Image>,
    pub(super) samples: u32,
}

impl Targets {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        (width, height): (u32, u32),
        samples: u32,
        format: vk::Format,
    ) -> Result<Self, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let color = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC;
        let multi = |format, usage| ImageDesc { samples, ..ImageDesc::new(width, height, format, usage) };
        Ok(Self {
            color: Image::new(gpu, "hdr color", ImageDesc::new(width, height, format, color))?,
            multisampled: (samples > 1)
                .then(|| Image::new(gpu, "multisampled color", multi(format, Usage::COLOR_ATTACHMENT)))
                .transpose()?,
            depth: Image::new(gpu, "depth", multi(vk::Format::D32_SFLOAT, Usage::DEPTH_STENCIL_ATTACHMENT))?,
            samples,
        })
    }

    pub(super) fn fits(&self, (width, height): (u32, u32), samples: u32) -> bool {
        let desc = self.color.desc();
        (desc.width, desc.height, self.samples) == (width, height, samples)
    }
}
