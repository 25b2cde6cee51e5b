//! Copies between images of different size or format.

use std::sync::Arc;

use ash::vk;

use super::encoder::{Encoder, Use};
use crate::gpu::Image;

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

    fn blit(&mut self, (from, from_level): (&Image, u32), (to, to_level): (&Image, u32), to_layer: u32) {
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
        let region = [vk::ImageBlit::default()
            .src_subresource(layers(from_level, 0))
            .src_offsets([vk::Offset3D::default(), corner(from, from_level)])
            .dst_subresource(layers(to_level, to_layer))
            .dst_offsets([vk::Offset3D::default(), corner(to, to_level)])];
        let (source, target) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        // SAFETY: this encoder records the command buffer; the caller keeps both images, and the regions lie within them.
        unsafe {
            let device = &self.gpu.device;
            device.cmd_blit_image(self.raw, from.raw, source, to.raw, target, &region, vk::Filter::LINEAR);
        }
    }
}
