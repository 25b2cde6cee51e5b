//! The surface of a window.

use std::sync::Arc;

use ash::vk;
use raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};

/// A surface that shows images in a window.
pub struct Surface {
    pub(in crate::gpu) gpu: Arc<Gpu>,
    pub(in crate::gpu) raw: vk::SurfaceKHR,
}

impl Surface {
    /// Creates the surface of a window. The caller keeps the window open while the surface lives.
    ///
    /// # Errors
    /// The device cannot show this window, or was opened without a display.
    pub fn new(gpu: &Arc<Gpu>, display: RawDisplayHandle, window: RawWindowHandle) -> Result<Arc<Self>, GpuError> {
        let loader = gpu.surface.as_ref().ok_or_else(no_display)?;
        // SAFETY: the handles come from a live window; the instance has the extensions of this display.
        let raw = unsafe { ash_window::create_surface(&gpu.instance.entry, &gpu.instance.raw, display, window, None) }
            .context("creating the window's surface")?;
        // It gets no debug name: the surface belongs to the instance, and lavapipe (22.3) crashes when it is named, as do the
        // validation layers 1.3.239.
        let surface = Self { gpu: gpu.clone(), raw };
        // SAFETY: surface and device are live.
        let shown = unsafe { loader.get_physical_device_surface_support(gpu.physical, gpu.queue_family, raw) }
            .context("querying whether the device can show the window")?;
        match shown {
            true => Ok(Arc::new(surface)),
            false => Err(GpuError::NoDevice(format!("{} cannot show this window", gpu.info().name))),
        }
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        if let Some(loader) = &self.gpu.surface {
            // SAFETY: swapchains hold an `Arc` of the surface, so none is left.
            unsafe { loader.destroy_surface(self.raw, None) };
        }
    }
}

/// The error of a device that was opened for headless use.
pub(in crate::gpu) fn no_display() -> GpuError {
    GpuError::NoDevice("the device was opened without a display".into())
}
