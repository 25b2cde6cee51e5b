//! The properties of the images of passes.

use crate::frame::pass_format;
use crate::gpu::vk;
use crate::scene::mips;
use crate::shader::GraphPass;
use crate::shader::annotation::pass::PassFormat;
use crate::shader::graph::Input;

/// The properties of a pass that determine one of its images.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct PassDesc {
    pub(super) size: (u32, u32),
    pub(super) format: vk::Format,
    pub(super) mips: u32,
    is_written: bool,
    pub(super) keeps: bool,
    has_depth: bool,
    /// Its place among the images of its pass, if they have mip levels.
    place: usize,
}

/// The properties of an image that a pass needs only while it draws.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct ScratchDesc {
    pub(super) size: (u32, u32),
    pub(super) format: vk::Format,
    /// A pass draws all of its images at once, so each has its own.
    place: usize,
}

impl PassDesc {
    /// `picture`: size of the frame, in pixels.
    pub(super) fn new(pass: &GraphPass, (name, format): (&str, PassFormat), picture: (u32, u32)) -> Self {
        let size = pass.desc.size.pixels(picture);
        let place = pass.desc.images().position(|(image, _)| pass.desc.mips && image == name);
        Self {
            size,
            format: pass_format(format),
            mips: if pass.desc.mips { mips::count(size.0, size.1) } else { 1 },
            is_written: pass.inputs.values().any(|input| *input == Input::Output),
            keeps: pass.desc.keep,
            // All images of a pass share the depth of the first.
            has_depth: pass.desc.model.is_some() && name == pass.name(),
            place: place.unwrap_or(0),
        }
    }

    /// Whether another desc has the same properties but its size.
    pub(super) fn is_resized(&self, other: &Self) -> bool {
        Self { size: other.size, mips: other.mips, ..*self } == *other
    }

    /// Number of texels in all levels, the previous frame's image included.
    pub(super) fn texels(&self) -> u64 {
        let level = |level: u32| u64::from((self.size.0 >> level).max(1)) * u64::from((self.size.1 >> level).max(1));
        (0..self.mips).map(level).sum::<u64>() * if self.keeps { 2 } else { 1 }
    }

    /// The image that the pass draws to, if mip levels are made from it: an attachment has one level.
    pub(super) fn first_level(&self) -> Option<ScratchDesc> {
        (self.mips > 1).then_some(ScratchDesc { size: self.size, format: self.format, place: self.place })
    }

    /// The depth of the model, if the pass draws it.
    pub(super) fn depth(&self) -> Option<ScratchDesc> {
        self.has_depth.then_some(ScratchDesc { size: self.size, format: vk::Format::D32_SFLOAT, place: 0 })
    }

    pub(super) fn usage(&self) -> vk::ImageUsageFlags {
        use vk::ImageUsageFlags as Usage;
        let target = if self.is_written { Usage::STORAGE } else { Usage::COLOR_ATTACHMENT };
        Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST | target
    }
}

impl ScratchDesc {
    pub(super) fn usage(&self) -> vk::ImageUsageFlags {
        use vk::ImageUsageFlags as Usage;
        match self.format {
            vk::Format::D32_SFLOAT => Usage::DEPTH_STENCIL_ATTACHMENT,
            _ => Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC,
        }
    }
}
