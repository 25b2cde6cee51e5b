//! Recording commands. Every resource that the commands use stays alive until the fence of their submission signals.

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use super::counts::Counter;
use super::image_use::{SHADERS, Use};
use super::pass_timer::PassTimer;
use crate::gpu::{Buffer, DescriptorSet, Gpu, Image, PassLayout, Pipeline, SetLayouts};

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

/// The targets of drawing commands.
#[derive(Clone, Copy)]
pub struct Attachments<'a> {
    /// Color target, in [`Use::Color`].
    pub color: &'a Arc<Image>,
    /// Further color targets of the same size, in [`Use::Color`], at locations 1 and up.
    pub more: &'a [Arc<Image>],
    /// Clear color; `None` keeps the contents.
    pub clear: Option<[f32; 4]>,
    /// Image in [`Use::Color`] that receives the average of the color samples.
    pub resolve: Option<&'a Arc<Image>>,
    /// Image in [`Use::DepthResolve`] that receives the depth of each pixel's first sample.
    pub resolve_depth: Option<&'a Arc<Image>>,
    /// Depth target, in [`Use::Depth`]. If color is cleared, depth is cleared to 0, which is far.
    pub depth: Option<&'a Arc<Image>>,
    /// Clears depth to this value; `None` treats it as color.
    pub clear_depth: Option<f32>,
    /// Whether later commands read the depth target.
    pub keeps_depth: bool,
    /// Whether later commands continue to draw to these targets. If so, depth and multisampled color are stored too.
    pub keeps_contents: bool,
    /// The part of the targets that is drawn.
    pub area: Rect,
}

impl<'a> Attachments<'a> {
    /// A color target alone, whose contents do not matter, drawn as a whole.
    pub fn of(color: &'a Arc<Image>) -> Self {
        let area = Rect { x: 0, y: 0, width: color.desc().width, height: color.desc().height };
        let (clear, resolve, resolve_depth, depth, clear_depth) = (None, None, None, None, None);
        let (keeps_depth, keeps_contents, more) = (false, false, &[]);
        Self { color, more, clear, resolve, resolve_depth, depth, clear_depth, keeps_depth, keeps_contents, area }
    }
}

/// Records into one command buffer.
pub struct Encoder {
    pub(in crate::gpu) gpu: Arc<Gpu>,
    pub(in crate::gpu) raw: vk::CommandBuffer,
    pub(in crate::gpu) kept: Vec<Arc<dyn Any + Send + Sync>>,
    pub(in crate::gpu) timer: Option<PassTimer>,
    pub(in crate::gpu) is_rendering: bool,
    pub(in crate::gpu) counter: Counter,
    /// Whether fragments behind others pass the depth test, too.
    pub(in crate::gpu) draws_hidden: bool,
    /// The loop report buffer, if a pipeline has loops that may not end.
    pub(in crate::gpu) loops: Option<Arc<Buffer>>,
}

impl Encoder {
    pub(in crate::gpu) fn new(gpu: &Arc<Gpu>, raw: vk::CommandBuffer, timer: Option<PassTimer>) -> Self {
        Self {
            gpu: gpu.clone(),
            raw,
            kept: Vec::new(),
            timer,
            is_rendering: false,
            counter: Counter::default(),
            draws_hidden: false,
            loops: None,
        }
    }

    /// Keeps `object` alive until the device has run the commands.
    pub fn keep<T: Any + Send + Sync>(&mut self, object: &Arc<T>) {
        self.kept.push(object.clone());
    }

    /// SYNC: orders all earlier commands that use `image` as `from` before all later commands that use it as `to`.
    pub fn transition(&mut self, image: &Arc<Image>, from: Use, to: Use) {
        self.transition_levels(image, 0..image.desc().mips, from, to);
    }

    /// SYNC: as [`Encoder::transition`], for one mip level.
    pub(in crate::gpu) fn transition_level(&mut self, image: &Arc<Image>, level: u32, from: Use, to: Use) {
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
        // SAFETY: this encoder records the command buffer; the image is kept.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.raw, &info) };
    }

    /// Begins drawing to `to`, and sets viewport and scissor to its area.
    pub fn begin_rendering(&mut self, to: &Attachments<'_>) {
        let load = if to.clear.is_some() { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD };
        let store = if to.keeps_contents { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::DONT_CARE };
        let color_of = |image: &Image| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view)
                .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
                .load_op(load)
                .clear_value(vk::ClearValue { color: vk::ClearColorValue { float32: to.clear.unwrap_or_default() } })
        };
        let color = color_of(to.color);
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
        let more = to.more.iter().map(|image| color_of(image).store_op(vk::AttachmentStoreOp::STORE));
        let colors: Vec<_> = std::iter::once(color).chain(more).collect();
        to.more.iter().for_each(|image| self.keep(image));
        let depth = to.depth.map(|depth| {
            self.keep(depth);
            let info = vk::RenderingAttachmentInfo::default()
                .image_view(depth.view)
                .image_layout(vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL)
                .load_op(if to.clear_depth.is_some() { vk::AttachmentLoadOp::CLEAR } else { load })
                .clear_value(vk::ClearValue {
                    depth_stencil: vk::ClearDepthStencilValue { depth: to.clear_depth.unwrap_or(0.0), stencil: 0 },
                })
                .store_op(if to.keeps_depth { vk::AttachmentStoreOp::STORE } else { store });
            match to.resolve_depth {
                Some(resolve) => {
                    self.keep(resolve);
                    info.resolve_mode(vk::ResolveModeFlags::SAMPLE_ZERO)
                        .resolve_image_view(resolve.view)
                        .resolve_image_layout(vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL)
                }
                None => info,
            }
        });
        let mut info =
            vk::RenderingInfo::default().render_area(to.area.vulkan()).layer_count(1).color_attachments(&colors);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: this encoder records the command buffer; the images are kept.
        unsafe { self.gpu.device.cmd_begin_rendering(self.raw, &info) };
        self.is_rendering = true;
        self.set_viewport(to.area);
        if to.depth.is_some() {
            self.set_depth_test(vk::CompareOp::GREATER_OR_EQUAL);
        }
    }

    /// Whether later rendering also runs the fragment stage where a nearer surface hides it. The picture is then not the right one.
    pub fn draw_hidden(&mut self, draws_hidden: bool) {
        self.draws_hidden = draws_hidden;
    }

    /// Sets which fragments pass the depth test; at the start of rendering these are all that nothing nearer hides.
    pub fn set_depth_test(&mut self, compare: vk::CompareOp) {
        let is_of_surfaces = compare == vk::CompareOp::GREATER_OR_EQUAL;
        let compare = if self.draws_hidden && is_of_surfaces { vk::CompareOp::ALWAYS } else { compare };
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_set_depth_compare_op(self.raw, compare) };
    }

    /// Clips later draws to a rectangle. The viewport stays.
    pub fn set_scissor(&mut self, to: Rect) {
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_set_scissor(self.raw, 0, &[to.vulkan()]) };
    }

    /// Maps later draws to a rectangle, and clips them to it.
    pub fn set_viewport(&mut self, to: Rect) {
        let viewport = vk::Viewport {
            x: to.x as f32,
            y: to.y as f32,
            width: to.width as f32,
            height: to.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: this encoder records the command buffer.
        unsafe {
            self.gpu.device.cmd_set_viewport(self.raw, 0, &[viewport]);
            self.gpu.device.cmd_set_scissor(self.raw, 0, &[to.vulkan()]);
        }
    }

    /// Maps later draws to a frame of this size, of which the targets hold the part that begins at `origin`. The scissor stays.
    pub fn set_part_of_picture(&mut self, origin: (u32, u32), size: (u32, u32)) {
        let viewport = vk::Viewport {
            x: -(origin.0 as f32),
            y: -(origin.1 as f32),
            width: size.0 as f32,
            height: size.1 as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: this encoder records the command buffer. A picture is at most as large as an image, and viewports may begin as
        // far outside of their targets.
        unsafe { self.gpu.device.cmd_set_viewport(self.raw, 0, &[viewport]) };
    }

    /// Sets the interpolation weight of [`crate::gpu::Raster::Averaged`]: 0 keeps the target, 1 replaces it.
    pub fn set_weight(&mut self, weight: f32) {
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_set_blend_constants(self.raw, &[weight; 4]) };
    }

    /// Ends drawing to the targets of [`Encoder::begin_rendering`].
    pub fn end_rendering(&mut self) {
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_end_rendering(self.raw) };
        self.is_rendering = false;
    }

    /// Binds a graphics pipeline.
    pub fn bind_pipeline(&mut self, pipeline: &Arc<Pipeline>) {
        self.keep(pipeline);
        self.loops = self.loops.take().or_else(|| pipeline.loops.clone());
        // SAFETY: this encoder records the command buffer; the pipeline is kept.
        unsafe { self.gpu.device.cmd_bind_pipeline(self.raw, vk::PipelineBindPoint::GRAPHICS, pipeline.raw) };
    }

    /// Sets the dynamic state of a pipeline with a depth target and a vertex stage.
    pub fn set_raster(&mut self, topology: vk::PrimitiveTopology, cull: vk::CullModeFlags, front_face: vk::FrontFace) {
        self.counter.set_topology(topology);
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_set_primitive_topology(self.raw, topology) };
        self.set_facing(cull, front_face);
    }

    /// Sets the dynamic state of a pipeline with a depth target and a mesh stage.
    pub fn set_facing(&mut self, cull: vk::CullModeFlags, front_face: vk::FrontFace) {
        // SAFETY: this encoder records the command buffer.
        unsafe {
            self.gpu.device.cmd_set_cull_mode(self.raw, cull);
            self.gpu.device.cmd_set_front_face(self.raw, front_face);
        }
    }

    /// Binds a descriptor set for drawing, at its own number.
    pub fn bind_set(&mut self, layouts: &Arc<SetLayouts>, set: &Arc<DescriptorSet>) {
        self.bind(vk::PipelineBindPoint::GRAPHICS, layouts.pipeline, set);
    }

    /// Binds the pass set of a declared pass (`SET_PASS`) for drawing.
    pub fn bind_pass_set(&mut self, layout: &Arc<PassLayout>, set: &Arc<DescriptorSet>) {
        self.bind(vk::PipelineBindPoint::GRAPHICS, layout.pipeline, set);
    }

    /// Binds a descriptor set at its own number.
    pub(in crate::gpu) fn bind(
        &mut self,
        point: vk::PipelineBindPoint,
        layout: vk::PipelineLayout,
        set: &Arc<DescriptorSet>,
    ) {
        self.keep(set);
        let device = &self.gpu.device;
        // SAFETY: this encoder records the command buffer; the set is kept, and the layout has the set's layout at its number.
        unsafe { device.cmd_bind_descriptor_sets(self.raw, point, layout, set.index, &[set.raw], &[]) };
    }

    /// Sets the push constants.
    pub fn push<T: bytemuck::Pod>(&mut self, layouts: &SetLayouts, value: &T) {
        let (stages, bytes) = (layouts.push_stages(), bytemuck::bytes_of(value));
        // SAFETY: this encoder records the command buffer; `interface` asserts that the structs fit.
        unsafe { self.gpu.device.cmd_push_constants(self.raw, layouts.pipeline, stages, 0, bytes) };
    }

    /// Binds 32-bit indices.
    pub fn bind_indices(&mut self, buffer: &Arc<Buffer>) {
        self.keep(buffer);
        // SAFETY: this encoder records the command buffer; the index buffer is kept.
        unsafe { self.gpu.device.cmd_bind_index_buffer(self.raw, buffer.raw, 0, vk::IndexType::UINT32) };
    }

    /// Draws `vertices` vertices without an index buffer.
    pub fn draw(&mut self, vertices: u32) {
        self.counter.draw(vertices);
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_draw(self.raw, vertices, 1, 0, 0) };
    }

    /// Draws this many instances of two triangles, without vertices in memory.
    pub fn draw_quads(&mut self, instances: u32) {
        const CORNERS: u32 = 6;
        self.counter.draw(CORNERS.saturating_mul(instances));
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_draw(self.raw, CORNERS, instances, 0, 0) };
    }

    /// Draws `count` indices, beginning with index number `first`.
    pub fn draw_indexed(&mut self, count: u32, first: u32, instances: u32) {
        self.counter.draw_indexed(count, instances);
        // SAFETY: this encoder records the command buffer; the loader has checked that the indices are in range.
        unsafe { self.gpu.device.cmd_draw_indexed(self.raw, count, instances, first, 0, 0) };
    }

    /// Starts `workgroups` times `instances` workgroups of the first stage of a mesh pipeline, which draw this many triangles. Does
    /// nothing on a device without mesh stages.
    pub fn draw_mesh(&mut self, workgroups: u32, instances: u32, triangles: u32) {
        let Some(extension) = &self.gpu.mesh_shader else { return };
        self.counter.draw_mesh(triangles, instances);
        // SAFETY: this encoder records the command buffer; the stages read within the buffers that the push constants name.
        unsafe { extension.cmd_draw_mesh_tasks(self.raw, workgroups, instances, 1) };
    }

    /// SYNC: makes the writes of earlier copies visible to all later commands, and to the CPU after the fence.
    pub fn copies_done(&mut self) {
        self.writes_done(vk::PipelineStageFlags2::ALL_TRANSFER, vk::AccessFlags2::TRANSFER_WRITE);
    }

    /// SYNC: orders what earlier passes did with storage buffers before what later passes do with them.
    pub fn buffers_done(&mut self) {
        use vk::AccessFlags2 as A;
        let scope = (SHADERS, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE);
        self.order(scope, scope);
    }

    /// SYNC: makes what shaders wrote to buffers visible to all later commands, and to the CPU after the fence.
    pub fn buffers_written(&mut self) {
        self.writes_done(SHADERS, vk::AccessFlags2::SHADER_STORAGE_WRITE);
    }

    /// SYNC: makes earlier writes of a stage visible to all later commands, and to the CPU after the fence.
    pub(in crate::gpu) fn writes_done(&mut self, stage: vk::PipelineStageFlags2, access: vk::AccessFlags2) {
        use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};
        self.order((stage, access), (S::ALL_COMMANDS | S::HOST, A::MEMORY_READ | A::MEMORY_WRITE | A::HOST_READ));
    }

    /// SYNC: orders earlier commands of some stages before later ones.
    pub(in crate::gpu) fn order(
        &mut self,
        from: (vk::PipelineStageFlags2, vk::AccessFlags2),
        to: (vk::PipelineStageFlags2, vk::AccessFlags2),
    ) {
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(from.0)
            .src_access_mask(from.1)
            .dst_stage_mask(to.0)
            .dst_access_mask(to.1)];
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        // SAFETY: this encoder records the command buffer.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.raw, &info) };
    }
}
