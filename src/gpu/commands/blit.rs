//! Copies between images of different size or format.

use std::sync::Arc;

use ash::vk;

use super::encoder::Encoder;
use super::image_use::Use;
use crate::gpu::{Buffer, Image, Rect};

impl Encoder {
    /// Fills every level of `to`: copies `from`, an image of the same size, to level 0, and halves each level into the next.
    /// `from` must be in [`Use::CopyFrom`] and `to` in [`Use::CopyTo`]. Leaves `to` in [`Use::CopyFrom`].
    pub fn fill_levels(&mut self, from: &Arc<Image>, to: &Arc<Image>) {
        self.keep(from);
        self.keep(to);
        self.blit((from, 0), (to, 0), 0);
        for level in 1..to.desc().mips {
            self.transition_level(to, level - 1, Use::CopyTo, Use::CopyFrom);
            self.blit((to, level - 1), (to, level), 0);
        }
        self.transition_level(to, to.desc().mips - 1, Use::CopyTo, Use::CopyFrom);
    }

    /// Scales a level of an image in [`Use::CopyFrom`] to a layer of an array in [`Use::CopyTo`], with a linear filter.
    pub fn scale_to_layer(&mut self, from: &Arc<Image>, level: u32, to: &Arc<Image>, layer: u32) {
        self.keep(from);
        self.keep(to);
        self.blit((from, level), (to, 0), layer);
    }

    /// Scales an image in [`Use::CopyFrom`] to one in [`Use::CopyTo`], with a linear filter.
    pub fn scale(&mut self, from: &Arc<Image>, to: &Arc<Image>) {
        self.keep(from);
        self.keep(to);
        self.blit((from, 0), (to, 0), 0);
    }

    /// Scales an image in [`Use::CopyFrom`] to a part of one in [`Use::CopyTo`], as far as the part lies within it, with a linear filter.
    pub fn scale_to_part(&mut self, from: &Arc<Image>, to: &Arc<Image>, part: Rect) {
        self.keep(from);
        self.keep(to);
        let (own, whole) = (from.desc(), to.desc());
        let Rect { x, y, width, height } = part;
        let (right, bottom) = ((x + width).min(whole.width), (y + height).min(whole.height));
        if right <= x || bottom <= y {
            return;
        }
        // The columns and rows of the source that fill what is left of the part.
        let kept =
            |pixels: u32, left: u32, all: u32| (u64::from(pixels) * u64::from(left) / u64::from(all)).max(1) as u32;
        let (columns, rows) = (kept(own.width, right - x, width), kept(own.height, bottom - y, height));
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let offset = |x: u32, y: u32, z| vk::Offset3D { x: x as i32, y: y as i32, z };
        let region = [vk::ImageBlit::default()
            .src_subresource(layers)
            .src_offsets([offset(0, 0, 0), offset(columns, rows, 1)])
            .dst_subresource(layers)
            .dst_offsets([offset(x, y, 0), offset(right, bottom, 1)])];
        let filter = if self.gpu.blends_texels(own.format) { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
        let (source, target) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        // SAFETY: this encoder records the command buffer; both images are kept, and the regions lie within them.
        unsafe { self.gpu.device.cmd_blit_image(self.raw, from.raw, source, to.raw, target, &region, filter) };
    }

    /// Scales an image in [`Use::CopyFrom`] to one in [`Use::CopyTo`], whose texels are single texels of the first.
    pub fn pick(&mut self, from: &Arc<Image>, to: &Arc<Image>) {
        self.keep(from);
        self.keep(to);
        self.blit_with((from, 0), (to, 0), 0, vk::Filter::NEAREST, false);
    }

    /// Copies a texel of level 0 of an image in [`Use::CopyFrom`] to an image of one texel in [`Use::CopyTo`], which may have another
    /// format: compressed texels are decoded, and sRGB-encoded ones become linear.
    pub fn pick_texel(&mut self, from: &Arc<Image>, (x, y): (u32, u32), to: &Arc<Image>) {
        self.keep(from);
        self.keep(to);
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let offset = |x: u32, y: u32, z| vk::Offset3D { x: x as i32, y: y as i32, z };
        let region = [vk::ImageBlit::default()
            .src_subresource(layers)
            .src_offsets([offset(x, y, 0), offset(x + 1, y + 1, 1)])
            .dst_subresource(layers)
            .dst_offsets([offset(0, 0, 0), offset(1, 1, 1)])];
        let (source, target) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        let filter = vk::Filter::NEAREST;
        // SAFETY: this encoder records the command buffer; both images are kept, and the caller's texel lies within the image.
        unsafe { self.gpu.device.cmd_blit_image(self.raw, from.raw, source, to.raw, target, &region, filter) };
    }

    /// [`Encoder::pick`] with the rows in the opposite order.
    pub fn pick_flipped(&mut self, from: &Arc<Image>, to: &Arc<Image>) {
        self.keep(from);
        self.keep(to);
        self.blit_with((from, 0), (to, 0), 0, vk::Filter::NEAREST, true);
    }

    /// Sets all texels of an image in [`Use::CopyTo`] to 0.
    pub fn clear_image(&mut self, image: &Arc<Image>) {
        self.keep(image);
        let range = vk::ImageSubresourceRange {
            aspect_mask: image.aspect(),
            base_mip_level: 0,
            level_count: image.desc().mips,
            base_array_layer: 0,
            layer_count: image.desc().layers,
        };
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let zero = vk::ClearColorValue { float32: [0.0; 4] };
        // SAFETY: this encoder records the command buffer; the image is kept and in this layout.
        unsafe { self.gpu.device.cmd_clear_color_image(self.raw, image.raw, layout, &zero, &[range]) };
    }

    /// Sets all bytes of a buffer to 0, after earlier shaders have used it. Its usage must include `TRANSFER_DST`.
    pub fn clear_buffer(&mut self, buffer: &Arc<Buffer>) {
        use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};
        self.keep(buffer);
        let shaders = (S::FRAGMENT_SHADER | S::COMPUTE_SHADER, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE);
        self.order(shaders, (S::ALL_TRANSFER, A::TRANSFER_WRITE));
        // SAFETY: this encoder records the command buffer; the buffer is kept.
        unsafe { self.gpu.device.cmd_fill_buffer(self.raw, buffer.raw, 0, vk::WHOLE_SIZE, 0) };
    }

    /// Copies an image in [`Use::CopyFrom`] to the place `at` of one in [`Use::CopyTo`] of the same format, as far as it fits.
    pub fn copy_image_to(&mut self, from: &Arc<Image>, to: &Arc<Image>, at: (u32, u32)) {
        self.copy_columns_to(from, from.desc().width, to, at);
    }

    /// [`Encoder::copy_image_to`] for the left `columns` of the image alone.
    pub fn copy_columns_to(&mut self, from: &Arc<Image>, columns: u32, to: &Arc<Image>, at: (u32, u32)) {
        self.keep(from);
        self.keep(to);
        let width = columns.min(from.desc().width).min(to.desc().width.saturating_sub(at.0));
        let height = from.desc().height.min(to.desc().height.saturating_sub(at.1));
        if width == 0 || height == 0 {
            return;
        }
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let region = [vk::ImageCopy::default()
            .src_subresource(layers)
            .dst_subresource(layers)
            .dst_offset(vk::Offset3D { x: at.0 as i32, y: at.1 as i32, z: 0 })
            .extent(vk::Extent3D { width, height, depth: 1 })];
        let (source, target) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        // SAFETY: this encoder records the command buffer; both images are kept, and the region lies within them.
        unsafe { self.gpu.device.cmd_copy_image(self.raw, from.raw, source, to.raw, target, &region) };
    }

    fn blit(&mut self, from: (&Image, u32), to: (&Image, u32), to_layer: u32) {
        let blends = self.gpu.blends_texels(from.0.desc().format);
        self.blit_with(from, to, to_layer, if blends { vk::Filter::LINEAR } else { vk::Filter::NEAREST }, false);
    }

    fn blit_with(
        &mut self,
        (from, from_level): (&Image, u32),
        (to, to_level): (&Image, u32),
        to_layer: u32,
        filter: vk::Filter,
        flips_rows: bool,
    ) {
        let side = |pixels: u32, level: u32| (pixels >> level).max(1) as i32;
        let corner = |image: &Image, level: u32| vk::Offset3D {
            x: side(image.desc().width, level),
            y: side(image.desc().height, level),
            z: 1,
        };
        let layers = |level, layer| {
            let color = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR);
            color.mip_level(level).base_array_layer(layer).layer_count(1)
        };
        let (mut first, mut last) = (vk::Offset3D::default(), corner(from, from_level));
        if flips_rows {
            std::mem::swap(&mut first.y, &mut last.y);
        }
        let region = [vk::ImageBlit::default()
            .src_subresource(layers(from_level, 0))
            .src_offsets([first, last])
            .dst_subresource(layers(to_level, to_layer))
            .dst_offsets([vk::Offset3D::default(), corner(to, to_level)])];
        let (source, target) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        // SAFETY: this encoder records the command buffer; the caller keeps both images, and the regions lie within them.
        unsafe {
            self.gpu.device.cmd_blit_image(self.raw, from.raw, source, to.raw, target, &region, filter);
        }
    }
}
