//! Draws egui's output with egui-ash-renderer on our device, queue and allocator.

use std::mem::ManuallyDrop;
use std::sync::Arc;

use ash::vk;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer, RendererError};

use crate::gpu::error::Context;
use crate::gpu::{Encoder, Gpu, GpuError, Image, Sampler, SamplerDesc, fault};

/// The action of every error.
const DRAWING: &str = "drawing the user interface";

/// egui's renderer on our device.
pub struct UiRenderer {
    gpu: Arc<Gpu>,
    inner: ManuallyDrop<Renderer<egui_ash_renderer::allocator::GpuAllocator>>,
    pool: vk::CommandPool,
}

impl UiRenderer {
    /// Creates the renderer for targets of `format`, with `in_flight` frame slots.
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn new(gpu: &Arc<Gpu>, format: vk::Format, in_flight: usize) -> Result<Self, GpuError> {
        let mode = RenderMode::DynamicRendering(DynamicRendering {
            color_attachment_format: format,
            depth_attachment_format: None,
            stencil_attachment_format: None,
        });
        let options = Options { in_flight_frames: in_flight, srgb_framebuffer: false, ..Default::default() };
        let inner =
            Renderer::with_gpu_allocator(Arc::clone(&gpu.allocator), gpu.device.clone(), mode, options).map_err(ui)?;
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.queue_family);
        // SAFETY: the device is live.
        let pool = unsafe { gpu.device.create_command_pool(&info, None) }.context("creating a command pool")?;
        gpu.name(pool, "user interface uploads");
        Ok(Self { gpu: gpu.clone(), inner: ManuallyDrop::new(inner), pool })
    }

    /// Uploads new and changed textures. A frame in flight may use a changed texture, so the caller must have waited for all
    /// frames ([`crate::gpu::Frames::wait_all`]).
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn set_textures(&mut self, delta: &egui::TexturesDelta) -> Result<(), GpuError> {
        fault::refuse("ui-textures", DRAWING)?;
        // SYNC: the renderer submits each upload, and waits for the queue, which must stay locked meanwhile.
        let queue = self.gpu.lock_queue();
        for (id, images) in &delta.set {
            for image in images {
                self.inner.set_texture(*queue, self.pool, *id, image).map_err(ui)?;
            }
        }
        Ok(())
    }

    /// Frees textures. The caller must have waited for every frame that uses them.
    ///
    /// # Errors
    /// A texture is unknown.
    pub fn free_textures(&mut self, delta: &egui::TexturesDelta) -> Result<(), GpuError> {
        delta.free.iter().try_for_each(|id| self.inner.free_texture(*id).map_err(ui))
    }

    /// Lets egui draw an image, which is in [`crate::gpu::Use::Sampled`] whenever it does. The texture keeps the image alive.
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn add_image(&mut self, image: &Arc<Image>) -> Result<UiImage, GpuError> {
        let set = ImageSet::new(&self.gpu, image)?;
        Ok(UiImage { texture: self.inner.add_user_texture(set.set), set })
    }

    /// Ends the use of an image. The caller must have waited for every frame that draws it, and egui must not draw it again.
    pub fn remove_image(&mut self, image: UiImage) {
        self.inner.remove_user_texture(image.texture);
    }

    /// Draws `primitives` to a target of `extent` pixels, between [`Encoder::begin_rendering`] and
    /// [`Encoder::end_rendering`].
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn draw(
        &mut self,
        encoder: &mut Encoder,
        extent: (u32, u32),
        pixels_per_point: f32,
        primitives: &[egui::ClippedPrimitive],
    ) -> Result<(), GpuError> {
        fault::refuse("ui-draw", DRAWING)?;
        let extent = vk::Extent2D { width: extent.0, height: extent.1 };
        self.inner.cmd_draw(encoder.raw, extent, pixels_per_point, primitives).map_err(ui)
    }
}

/// An image that egui draws.
pub struct UiImage {
    /// Its name in egui.
    pub texture: egui::TextureId,
    set: ImageSet,
}

impl UiImage {
    /// The image.
    pub fn image(&self) -> &Arc<Image> {
        &self.set.image
    }
}

/// The descriptor set of an image, with a layout like that of egui's renderer.
struct ImageSet {
    gpu: Arc<Gpu>,
    layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    image: Arc<Image>,
    _sampler: Arc<Sampler>,
}

impl ImageSet {
    fn new(gpu: &Arc<Gpu>, image: &Arc<Image>) -> Result<Self, GpuError> {
        let sampler = Sampler::new(gpu, &SamplerDesc::BILINEAR)?;
        let (layout, pool, set) = Default::default();
        // From here on, `Drop` frees what is already there when a later step fails.
        let mut this = Self { gpu: gpu.clone(), layout, pool, set, image: image.clone(), _sampler: sampler.clone() };
        let kind = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .binding(0)
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)];
        let sizes = [vk::DescriptorPoolSize { ty: kind, descriptor_count: 1 }];
        let layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let pool = vk::DescriptorPoolCreateInfo::default().pool_sizes(&sizes).max_sets(1);
        // SAFETY: the device is live; the set is written before any command uses it, with objects that this keeps.
        unsafe {
            this.layout = gpu.device.create_descriptor_set_layout(&layout, None).context(DRAWING)?;
            this.pool = gpu.device.create_descriptor_pool(&pool, None).context(DRAWING)?;
            let layouts = [this.layout];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(this.pool).set_layouts(&layouts);
            this.set = gpu.device.allocate_descriptor_sets(&info).context(DRAWING)?[0];
            let images = [vk::DescriptorImageInfo {
                sampler: sampler.raw,
                image_view: image.view,
                image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
            }];
            let write = vk::WriteDescriptorSet::default().dst_set(this.set).descriptor_type(kind).image_info(&images);
            gpu.device.update_descriptor_sets(&[write], &[]);
        }
        gpu.name(this.set, "thumbnails set");
        Ok(this)
    }
}

impl Drop for ImageSet {
    fn drop(&mut self) {
        // SAFETY: the caller of `remove_image` has waited for the frames that use the set, and `UiRenderer` waits when it is dropped.
        // Vulkan ignores null objects.
        unsafe {
            self.gpu.device.destroy_descriptor_pool(self.pool, None);
            self.gpu.device.destroy_descriptor_set_layout(self.layout, None);
        }
    }
}

fn ui(error: RendererError) -> GpuError {
    match error {
        RendererError::Vulkan(result) => GpuError::vulkan(result, DRAWING, ""),
        RendererError::GpuAllocator(error) => GpuError::allocation(&error, DRAWING),
        other => GpuError::Ui(other.to_string()),
    }
}

impl Drop for UiRenderer {
    fn drop(&mut self) {
        // SYNC: at exit only; the renderer frees its own objects, which the last frames may still use.
        self.gpu.wait_idle();
        // SAFETY: the device is idle, `gpu` keeps it alive, and nothing uses the renderer after this.
        unsafe {
            ManuallyDrop::drop(&mut self.inner);
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}
