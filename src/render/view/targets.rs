//! The render targets of a view: HDR color, multisampled color, depth, the copy behind transmissive surfaces, and the mean.
//!
//! Where a pass resolves the samples and nothing reads the depth afterwards, the resolved color is in the memory of the depth: at four samples
//! and full floats, both have 16 bytes a pixel.

use std::sync::Arc;

use crate::frame::TargetFormat;
use crate::gpu::{Gpu, GpuError, Image, ImageDesc, vk};
use crate::scene::mips;

/// Resolved and multisampled HDR color of one mode.
pub(super) struct ColorTarget {
    pub(super) color: Arc<Image>,
    /// `None` with one sample per pixel.
    pub(super) multisampled: Option<Arc<Image>>,
}

impl ColorTarget {
    /// The image that draws write.
    pub(super) fn drawn(&self) -> &Arc<Image> {
        self.multisampled.as_ref().unwrap_or(&self.color)
    }
}

/// The properties of a frame that determine its targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TargetDesc {
    /// Width and height, pixels.
    pub(super) size: (u32, u32),
    /// HDR color and samples.
    pub(super) format: TargetFormat,
    /// Whether the scene has transmissive surfaces.
    pub(super) transmission: bool,
    /// Whether the mode accumulates.
    pub(super) accumulates: bool,
    /// Whether a declared pass reads the model's depth.
    pub(super) reads_depth: bool,
    /// Whether blended surfaces are sorted in each pixel.
    pub(super) peels: bool,
    /// Whether a pass resolves the samples of the whole model, after its last draw.
    pub(super) resolves_last: bool,
}

impl TargetDesc {
    /// Whether nothing needs the depth once something is written to the resolved color.
    fn ends_depth_before_color(&self) -> bool {
        self.resolves_last && self.format.samples > 1 && !self.transmission && !self.reads_depth && !self.peels
    }
}

/// The images of one [`TargetDesc`], replaced as a whole. Frames in flight keep the old ones alive.
pub(super) struct Targets {
    pub(super) desc: TargetDesc,
    /// Resolved HDR color.
    pub(super) color: Arc<Image>,
    /// Whether `color` is in the memory of `depth`, so that its content begins with the resolve.
    pub(super) color_replaces_depth: bool,
    /// Multisampled color, if there is more than one sample per pixel.
    pub(super) multisampled: Option<Arc<Image>>,
    /// Depth.
    pub(super) depth: Arc<Image>,
    /// Depth of the first sample of each pixel, if a pass reads it and there is more than one.
    pub(super) resolved_depth: Option<Arc<Image>>,
    /// Depth of the last layer of blended surfaces and of the next one, in turn, if these are sorted in each pixel.
    pub(super) peeled: Option<[Arc<Image>; 2]>,
    /// The opaque scene color, with mip levels, for transmissive surfaces to look up.
    pub(super) opaque_scene: Option<Arc<Image>>,
    /// The accumulation buffer: the mean of the frames so far.
    pub(super) mean: Option<Arc<Image>>,
}

impl Targets {
    pub(super) fn new(gpu: &Arc<Gpu>, desc: TargetDesc) -> Result<Self, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let TargetDesc { size: (width, height), format: TargetFormat { color: format, samples, .. }, .. } = desc;
        let image = |name: &str, desc: ImageDesc| Image::new(gpu, name, desc);
        let drawn = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC;
        let multi = |format, usage| ImageDesc { samples, ..ImageDesc::new(width, height, format, usage) };
        let multisampled = match samples {
            1 => None,
            _ => Some(image("multisampled color", multi(format, Usage::COLOR_ATTACHMENT | Usage::SAMPLED))?),
        };
        let (depth_format, attached) = (vk::Format::D32_SFLOAT, Usage::DEPTH_STENCIL_ATTACHMENT);
        let read = attached | Usage::SAMPLED;
        let is_read = (desc.reads_depth && samples == 1) || desc.peels;
        let depth = image("depth", multi(depth_format, if is_read { read } else { attached }))?;
        let color = ImageDesc::new(width, height, format, drawn);
        let in_depth = match desc.ends_depth_before_color() {
            true => depth.in_same_memory("hdr color", color)?,
            false => None,
        };
        let color_replaces_depth = in_depth.is_some();
        let color = in_depth.map_or_else(|| image("hdr color", color), Ok)?;
        let peeled = || image("depth of a layer", multi(depth_format, read));
        let peeled = if desc.peels { Some([peeled()?, peeled()?]) } else { None };
        let resolved_depth = match desc.reads_depth && samples > 1 {
            true => Some(image("resolved depth", ImageDesc::new(width, height, depth_format, read))?),
            false => None,
        };
        let copied = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let levels = mips::count(width, height);
        let opaque_scene = match desc.transmission {
            true => Some(image("behind", ImageDesc { mips: levels, ..ImageDesc::new(width, height, format, copied) })?),
            false => None,
        };
        let mean = match desc.accumulates {
            true => Some(image("mean", ImageDesc::new(width, height, vk::Format::R32G32B32A32_SFLOAT, drawn))?),
            false => None,
        };
        Ok(Self { desc, color, color_replaces_depth, multisampled, depth, resolved_depth, peeled, opaque_scene, mean })
    }

    /// Another color target of the same size and format.
    pub(super) fn another_color(&self, gpu: &Arc<Gpu>) -> Result<ColorTarget, GpuError> {
        let color = Image::new(gpu, "hdr color", *self.color.desc())?;
        let multisampled = self.multisampled.as_ref();
        let multisampled =
            multisampled.map(|image| Image::new(gpu, "multisampled color", *image.desc())).transpose()?;
        Ok(ColorTarget { color, multisampled })
    }

    /// The depth that passes read.
    pub(super) fn read_depth(&self) -> Option<&Arc<Image>> {
        self.desc.reads_depth.then(|| self.resolved_depth.as_ref().unwrap_or(&self.depth))
    }

    /// The image that the tone map reads: the accumulation buffer of an accumulating mode, otherwise the newest frame.
    pub(super) fn picture(&self) -> &Arc<Image> {
        self.mean.as_ref().unwrap_or(&self.color)
    }
}
