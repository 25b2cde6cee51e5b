//! Draws egui's output with egui-ash-renderer on our device, queue and allocator.

use std::mem::ManuallyDrop;
use std::sync::Arc;

use ash::vk;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer, RendererError};

use crate::gpu::error::Context;
use crate::gpu::{Encoder, Gpu, GpuError, fault};

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
