//! Copies between buffers and images.

use std::sync::Arc;

use ash::vk;

use super::encoder::Encoder;
use crate::gpu::{Buffer, Image};

impl Encoder {
    /// Copies `size` bytes of a buffer to an offset in another. Both ranges lie inside their buffers.
    pub fn copy_buffer(&mut self, from: &Arc<Buffer>, from_offset: u64, to: &Arc<Buffer>, to_offset: u64, size: u64) {
        self.keep(from);
        self.keep(to);
        let region = [vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size }];
        // SAFETY: this encoder records the command buffer; both buffers are kept.
        unsafe { self.gpu.device.cmd_copy_buffer(self.raw, from.raw, to.raw, &region) };
    }

    /// Resets the loop report buffer: its first words become 0, 0, 1.
    pub(in crate::gpu) fn clear_loops(&mut self, buffer: &Arc<Buffer>) {
        self.keep(buffer);
        // SAFETY: this encoder records the command buffer; the buffer is kept and has three words.
        unsafe {
            self.gpu.device.cmd_fill_buffer(self.raw, buffer.raw, 0, 8, 0);
            self.gpu.device.cmd_fill_buffer(self.raw, buffer.raw, 8, 4, 1);
        }
    }

    /// Copies the loop report that shaders wrote, and clears the buffer for the next submission. SYNC: after all earlier
    /// commands, and before all later ones and the CPU's read after the fence.
    pub(in crate::gpu) fn take_loops(&mut self, from: &Arc<Buffer>, to: &Arc<Buffer>) {
        use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};
        self.order(
            (S::ALL_COMMANDS, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE),
            (S::ALL_TRANSFER, A::TRANSFER_READ),
        );
        self.copy_buffer(from, 0, to, 0, from.size());
        self.order((S::ALL_TRANSFER, A::TRANSFER_READ), (S::ALL_TRANSFER, A::TRANSFER_WRITE));
        self.clear_loops(from);
        self.copies_done();
    }

    /// Fills every mip level of an image in [`crate::gpu::Use::CopyTo`]. The buffer holds the levels one after the other, each with
    /// all its layers, tightly packed.
    pub fn copy_to_image(&mut self, from: &Arc<Buffer>, offset: u64, to: &Arc<Image>) {
        self.keep(from);
        self.keep(to);
        let mut regions = Vec::new();
        let mut at = offset;
        for level in 0..to.desc().mips {
            let region = whole_level(to, level, at);
            at += to.desc().level_bytes(level);
            regions.push(region);
        }
        // SAFETY: this encoder records the command buffer; buffer and image are kept.
        unsafe {
            let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            self.gpu.device.cmd_copy_buffer_to_image(self.raw, from.raw, to.raw, layout, &regions);
        }
    }

    /// Reads every mip level of an image in [`crate::gpu::Use::CopyFrom`], in the order that [`Encoder::copy_to_image`] takes.
    pub fn copy_levels_from_image(&mut self, from: &Arc<Image>, to: &Arc<Buffer>, offset: u64) {
        let mut at = offset;
        for level in 0..from.desc().mips {
            self.copy_region(from, whole_level(from, level, at), to);
            at += from.desc().level_bytes(level);
        }
    }

    /// Reads mip level 0 of an image in [`crate::gpu::Use::CopyFrom`] into tightly packed rows.
    pub fn copy_from_image(&mut self, from: &Arc<Image>, to: &Arc<Buffer>) {
        self.copy_region(from, whole_level(from, 0, 0), to);
    }

    /// Reads one pixel of mip level 0 of an image in [`crate::gpu::Use::CopyFrom`].
    pub fn copy_pixel(&mut self, from: &Arc<Image>, at: (u32, u32), to: &Arc<Buffer>) {
        self.copy_region(from, one_pixel(from, at), to);
    }

    fn copy_region(&mut self, from: &Arc<Image>, region: vk::BufferImageCopy, to: &Arc<Buffer>) {
        self.keep(from);
        self.keep(to);
        // SAFETY: this encoder records the command buffer; buffer and image are kept, and the buffer holds the region.
        unsafe {
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            self.gpu.device.cmd_copy_image_to_buffer(self.raw, from.raw, layout, to.raw, &[region]);
        }
    }
}

/// The region of one pixel of mip level 0.
fn one_pixel(image: &Image, (x, y): (u32, u32)) -> vk::BufferImageCopy {
    vk::BufferImageCopy {
        image_offset: vk::Offset3D { x: x as i32, y: y as i32, z: 0 },
        image_extent: vk::Extent3D { width: 1, height: 1, depth: 1 },
        ..whole_level(image, 0, 0)
    }
}

/// The region of a mip level with all its layers.
fn whole_level(image: &Image, level: u32, offset: u64) -> vk::BufferImageCopy {
    let side = |pixels: u32| (pixels >> level).max(1);
    let desc = image.desc();
    vk::BufferImageCopy {
        buffer_offset: offset,
        image_subresource: vk::ImageSubresourceLayers {
            aspect_mask: image.aspect(),
            mip_level: level,
            base_array_layer: 0,
            layer_count: desc.layers,
        },
        image_extent: vk::Extent3D { width: side(desc.width), height: side(desc.height), depth: side(desc.depth) },
        ..Default::default()
    }
}
