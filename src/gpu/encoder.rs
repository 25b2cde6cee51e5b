//! Recording commands. The encoder keeps alive, until the fence of its submission, whatever its commands use.

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use super::buffer::Buffer;
use super::descriptor::{DescriptorSet, SetLayouts};
use super::device::Gpu;
use super::image::Image;
use super::pipeline::Pipeline;

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rect {
    /// Left.
    pub x: u32,
    /// Top.
    pub y: u32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

impl Rect {
    fn vulkan(self) -> vk::Rect2D {
        vk::Rect2D {
            offset: vk::Offset2D { x: self.x as i32, y: self.y as i32 },
            extent: vk::Extent2D { width: self.width, height: self.height },
        }
    }
}

/// What an image is used for; a transition between two uses is a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Content does not matter.
    Undefined,
    /// Acquired from the swapchain: content does not matter, and the acquire semaphore was waited for at color output.
    Acquired,
    /// Color attachment.
    Color,
    /// Depth attachment.
    Depth,
    /// Read in shaders.
    Sampled,
    /// Written and read level by level in compute shaders.
    Storage,
    /// Source of a copy or blit.
    CopyFrom,
    /// Target of a copy or blit.
    CopyTo,
    /// Shown.
    Present,
}

impl Use {
    fn scope(self) -> (vk::PipelineStageFlags2, vk::AccessFlags2, vk::ImageLayout) {
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
            Self::Sampled => {
                (S::FRAGMENT_SHADER | S::COMPUTE_SHADER, A::SHADER_SAMPLED_READ, L::SHADER_READ_ONLY_OPTIMAL)
            }
            Self::Storage => (S::COMPUTE_SHADER, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE, L::GENERAL),
            Self::CopyFrom => (S::ALL_TRANSFER, A::TRANSFER_READ, L::TRANSFER_SRC_OPTIMAL),
            Self::CopyTo => (S::ALL_TRANSFER, A::TRANSFER_WRITE, L::TRANSFER_DST_OPTIMAL),
            Self::Present => (S::BOTTOM_OF_PIPE, A::NONE, L::PRESENT_SRC_KHR),
        }
    }
}

/// The targets of a rendering pass.
pub struct Attachments<'a> {
    /// Color target, in [`Use::Color`].
    pub color: &'a Arc<Image>,
    /// Clear value; `None` keeps the content.
    pub clear: Option<[f32; 4]>,
    /// Where multisampled color is averaged to, in [`Use::Color`].
    pub resolve: Option<&'a Arc<Image>>,
    /// Depth target, in [`Use::Depth`]; cleared to 0, which is far, when color is.
    pub depth: Option<&'a Arc<Image>>,
    /// Whether drawing goes on later: then depth and multisampled color are kept too.
    pub goes_on: bool,
    /// The part of the target that is drawn.
    pub area: Rect,
}

/// Records into one command buffer.
pub struct Encoder {
    pub(super) gpu: Arc<Gpu>,
    pub(super) raw: vk::CommandBuffer,
    pub(super) kept: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Encoder {
    pub(super) fn new(gpu: &Arc<Gpu>, raw: vk::CommandBuffer) -> Self {
        Self { gpu: gpu.clone(), raw, kept: Vec::new() }
    }

    /// Keeps `object` alive until the commands have run.
    pub fn keep<T: Any + Send + Sync>(&mut self, object: &Arc<T>) {
        self.kept.push(object.clone());
    }

    /// SYNC: everything before that used `image` as `from` comes before everything after that uses it as `to`.
    pub fn transition(&mut self, image: &Arc<Image>, from: Use, to: Use) {
        self.transition_levels(image, 0..image.desc().mips, from, to);
    }

    /// SYNC: the same for one mip level.
    pub(super) fn transition_level(&mut self, image: &Arc<Image>, level: u32, from: Use, to: Use) {
        self.transition_levels(image, level..level + 1, from, to);
    }

    fn transition_levels(&mut self, image: &Arc<Image>, levels: std::ops::Range<u32>, from: Use, to: Use) {
        let (src_stage, src_access, old_layout) = from.scope();
        let (dst_stage, dst_access, new_layout) = to.scope();
        let barrier = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(src_stage)
            .src_access_mask(src_access)
            .dst_stage_mask(dst_stage)
            .dst_access_mask(dst_access)
            .old_layout(old_layout)
            .new_layout(new_layout)
            .image(image.raw)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: image.aspect(),
                base_mip_level: levels.start,
                level_count: levels.end - levels.start,
                base_array_layer: 0,
                layer_count: image.desc().layers,
            });
        let barriers = [barrier];
        self.keep(image);
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: recording into our own buffer; the image is kept.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.raw, &info) };
    }

    /// Begins drawing to `to`; viewport and scissor are set to its area.
    pub fn begin_rendering(&mut self, to: &Attachments<'_>) {
        let load = if to.clear.is_some() { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD };
        let store = if to.goes_on { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::DONT_CARE };
        let color = vk::RenderingAttachmentInfo::default()
            .image_view(to.color.view)
            .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(load)
            .clear_value(vk::ClearValue { color: vk::ClearColorValue { float32: to.clear.unwrap_or_default() } });
        self.keep(to.color);
        let color = match to.resolve {
            Some(resolve) => {
                self.keep(resolve);
                color
                    .store_op(store)
                    .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                    .resolve_image_view(resolve.view)
                    .resolve_image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            }
            None => color.store_op(vk::AttachmentStoreOp::STORE),
        };
        let colors = [color];
        let depth = to.depth.map(|depth| {
            self.keep(depth);
            vk::RenderingAttachmentInfo::default()
                .image_view(depth.view)
                .image_layout(vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL)
                .load_op(load)
                .store_op(store)
        });
        let mut info =
            vk::RenderingInfo::default().render_area(to.area.vulkan()).layer_count(1).color_attachments(&colors);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: recording into our own buffer; the images are kept.
        unsafe { self.gpu.device.cmd_begin_rendering(self.raw, &info) };
        self.set_viewport(to.area);
    }

    /// Leaves all but a rectangle of what follows undrawn, in the same place.
    pub fn set_scissor(&mut self, to: Rect) {
        // SAFETY: recording into our own buffer.
        unsafe { self.gpu.device.cmd_set_scissor(self.raw, 0, &[to.vulkan()]) };
    }

    /// Confines what follows to a rectangle.
    pub fn set_viewport(&mut self, to: Rect) {
        let viewport = vk::Viewport {
            x: to.x as f32,
            y: to.y as f32,
            width: to.width as f32,
            height: to.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: recording into our own buffer.
        unsafe {
            self.gpu.device.cmd_set_viewport(self.raw, 0, &[viewport]);
            self.gpu.device.cmd_set_scissor(self.raw, 0, &[to.vulkan()]);
        }
    }

    /// Sets the weight of what [`super::Raster::Averaged`] adds.
    pub fn set_weight(&mut self, weight: f32) {
        // SAFETY: recording into our own buffer.
        unsafe { self.gpu.device.cmd_set_blend_constants(self.raw, &[weight; 4]) };
    }

    /// Ends drawing.
    pub fn end_rendering(&mut self) {
        // SAFETY: recording into our own buffer.
        unsafe { self.gpu.device.cmd_end_rendering(self.raw) };
    }

    /// Binds a pipeline.
    pub fn bind_pipeline(&mut self, pipeline: &Arc<Pipeline>) {
        self.keep(pipeline);
        // SAFETY: recording into our own buffer; the pipeline is kept.
        unsafe { self.gpu.device.cmd_bind_pipeline(self.raw, vk::PipelineBindPoint::GRAPHICS, pipeline.raw) };
    }

    /// Sets what a scene pipeline leaves open.
    pub fn set_raster(&mut self, topology: vk::PrimitiveTopology, cull: vk::CullModeFlags, front: vk::FrontFace) {
        // SAFETY: recording into our own buffer.
        unsafe {
            self.gpu.device.cmd_set_primitive_topology(self.raw, topology);
            self.gpu.device.cmd_set_cull_mode(self.raw, cull);
            self.gpu.device.cmd_set_front_face(self.raw, front);
        }
    }

    /// Binds a descriptor set at its own number.
    pub fn bind_set(&mut self, layouts: &Arc<SetLayouts>, set: &Arc<DescriptorSet>) {
        self.keep(set);
        // SAFETY: recording into our own buffer; the set is kept, and the layout is the one of every pipeline.
        unsafe {
            self.gpu.device.cmd_bind_descriptor_sets(
                self.raw,
                vk::PipelineBindPoint::GRAPHICS,
                layouts.pipeline,
                set.index,
                &[set.raw],
                &[],
            );
        }
    }

    /// Sets the push constants.
    pub fn push<T: bytemuck::Pod>(&mut self, layouts: &SetLayouts, value: &T) {
        let (stages, bytes) = (layouts.push_stages(), bytemuck::bytes_of(value));
        // SAFETY: recording into our own buffer; `interface` asserts that the structs fit.
        unsafe { self.gpu.device.cmd_push_constants(self.raw, layouts.pipeline, stages, 0, bytes) };
    }

    /// Binds 32-bit indices.
    pub fn bind_indices(&mut self, buffer: &Arc<Buffer>) {
        self.keep(buffer);
        // SAFETY: recording into our own buffer; the index buffer is kept.
        unsafe { self.gpu.device.cmd_bind_index_buffer(self.raw, buffer.raw, 0, vk::IndexType::UINT32) };
    }

    /// Draws without buffers.
    pub fn draw(&mut self, vertices: u32) {
        // SAFETY: recording into our own buffer.
        unsafe { self.gpu.device.cmd_draw(self.raw, vertices, 1, 0, 0) };
    }

    /// Draws `count` indices from `first`.
    pub fn draw_indexed(&mut self, count: u32, first: u32) {
        // SAFETY: recording into our own buffer; `scene` promises indices in range.
        unsafe { self.gpu.device.cmd_draw_indexed(self.raw, count, 1, first, 0, 0) };
    }

    /// Copies part of a buffer to the start of another one.
    pub fn copy_buffer(&mut self, from: &Arc<Buffer>, from_offset: u64, to: &Arc<Buffer>, size: u64) {
        self.copy_range(from, from_offset, to, 0, size);
    }

    /// Copies `size` bytes of a buffer to an offset in another one. Both ranges must lie inside of their buffers.
    pub fn copy_range(&mut self, from: &Arc<Buffer>, from_offset: u64, to: &Arc<Buffer>, to_offset: u64, size: u64) {
        self.keep(from);
        self.keep(to);
        let region = [vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size }];
        // SAFETY: recording into our own buffer; both buffers are kept.
        unsafe { self.gpu.device.cmd_copy_buffer(self.raw, from.raw, to.raw, &region) };
    }

    /// SYNC: copies before this are visible to every shader and index read after it, and to the CPU after the fence.
    pub fn copies_done(&mut self) {
        self.writes_done(vk::PipelineStageFlags2::ALL_TRANSFER, vk::AccessFlags2::TRANSFER_WRITE);
    }

    /// SYNC: what these stages wrote before is visible to all that comes after, and to the CPU after the fence.
    pub(super) fn writes_done(&mut self, stage: vk::PipelineStageFlags2, access: vk::AccessFlags2) {
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(stage)
            .src_access_mask(access)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS | vk::PipelineStageFlags2::HOST)
            .dst_access_mask(
                vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE | vk::AccessFlags2::HOST_READ,
            )];
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        // SAFETY: recording into our own buffer.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.raw, &info) };
    }

    /// Fills every mip level, in [`Use::CopyTo`], from tightly packed levels that follow each other, each with all its layers.
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
        // SAFETY: recording into our own buffer; buffer and image are kept.
        unsafe {
            let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            self.gpu.device.cmd_copy_buffer_to_image(self.raw, from.raw, to.raw, layout, &regions);
        }
    }

    /// Reads every mip level, in [`Use::CopyFrom`], in the order that [`Encoder::copy_to_image`] takes.
    pub fn copy_levels_from_image(&mut self, from: &Arc<Image>, to: &Arc<Buffer>, offset: u64) {
        let mut at = offset;
        for level in 0..from.desc().mips {
            self.copy_region(from, whole_level(from, level, at), to);
            at += from.desc().level_bytes(level);
        }
    }

    /// Reads mip level 0, in [`Use::CopyFrom`], into tightly packed rows.
    pub fn copy_from_image(&mut self, from: &Arc<Image>, to: &Arc<Buffer>) {
        self.copy_region(from, whole_level(from, 0, 0), to);
    }

    /// Reads one pixel of an image in [`Use::CopyFrom`].
    pub fn copy_pixel(&mut self, from: &Arc<Image>, at: (u32, u32), to: &Arc<Buffer>) {
        self.copy_region(from, one_pixel(from, at), to);
    }

    fn copy_region(&mut self, from: &Arc<Image>, region: vk::BufferImageCopy, to: &Arc<Buffer>) {
        self.keep(from);
        self.keep(to);
        // SAFETY: recording into our own buffer; buffer and image are kept, and the buffer holds the region.
        unsafe {
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            self.gpu.device.cmd_copy_image_to_buffer(self.raw, from.raw, layout, to.raw, &[region]);
        }
    }
}

/// One pixel of mip level 0.
fn one_pixel(image: &Image, (x, y): (u32, u32)) -> vk::BufferImageCopy {
    vk::BufferImageCopy {
        image_offset: vk::Offset3D { x: x as i32, y: y as i32, z: 0 },
        image_extent: vk::Extent3D { width: 1, height: 1, depth: 1 },
        ..whole_level(image, 0, 0)
    }
}

fn whole_level(image: &Image, level: u32, offset: u64) -> vk::BufferImageCopy {
    let side = |pixels: u32| (pixels >> level).max(1);
    vk::BufferImageCopy {
        buffer_offset: offset,
        image_subresource: vk::ImageSubresourceLayers {
            aspect_mask: image.aspect(),
            mip_level: level,
            base_array_layer: 0,
            layer_count: image.desc().layers,
        },
        image_extent: vk::Extent3D { width: side(image.desc().width), height: side(image.desc().height), depth: 1 },
        ..Default::default()
    }
}
