//! Draws egui's output. The renderer is egui-ash-renderer's; this gives it our device, and its textures a life of their own.

use std::mem::ManuallyDrop;
use std::sync::Arc;

use ash::vk;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer};

use super::device::Gpu;
use super::encoder::Encoder;
use super::error::{Context, GpuError};

/// egui's renderer on our device.
pub struct UiRenderer {
    gpu: Arc<Gpu>,
    inner: ManuallyDrop<Renderer<egui_ash_renderer::allocator::GpuAllocator>>,
    pool: vk::CommandPool,
}

impl UiRenderer {
    /// Makes the renderer for targets of `format`, with `in_flight` frame slots.
    ///
    /// # Errors
    /// Out of memory.
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
        Ok(Self { gpu: gpu.clone(), inner: ManuallyDrop::new(inner), pool })
    }

    /// Uploads new and changed textures. A changed one may be in use by a frame in flight, so the caller has waited for all.
    ///
    /// # Errors
    /// Out of memory.
    pub fn set_textures(&mut self, delta: &egui::TexturesDelta) -> Result<(), GpuError> {
        let queue = self.gpu.lock_queue();
        for (id, images) in &delta.set {
            for image in images {
                self.inner.set_texture(*queue, self.pool, *id, image).map_err(ui)?;
            }
        }
        Ok(())
    }

    /// Frees textures that no frame in flight uses.
    ///
    /// # Errors
    /// An unknown texture.
    pub fn free_textures(&mut self, delta: &egui::TexturesDelta) -> Result<(), GpuError> {
        delta.free.iter().try_for_each(|id| self.inner.free_texture(*id).map_err(ui))
    }

    /// Draws inside a rendering pass over a target of `extent` pixels.
    ///
    /// # Errors
    /// Out of memory.
    pub fn draw(
        &mut self,
        encoder: &mut Encoder,
        extent: (u32, u32),
        pixels_per_point: f32,
        primitives: &[egui::ClippedPrimitive],
    ) -> Result<(), GpuError> {
        let extent = vk::Extent2D { width: extent.0, height: extent.1 };
        self.inner.cmd_draw(encoder.raw, extent, pixels_per_point, primitives).map_err(ui)
    }
}

fn ui(error: egui_ash_renderer::RendererError) -> GpuError {
    GpuError::Ui(error.to_string())
}

impl Drop for UiRenderer {
    fn drop(&mut self) {
        self.gpu.wait_idle();
        // SAFETY: the device is idle, and the renderer goes before the device that `gpu` keeps alive.
        unsafe {
            ManuallyDrop::drop(&mut self.inner);
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}
