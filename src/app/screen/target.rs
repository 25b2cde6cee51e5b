//! Where frames go: to the images of a window's swapchain or, in a session without a window, to an image that nobody sees.

use std::sync::Arc;

use winit::raw_window_handle::{HasDisplayHandle as _, HasWindowHandle as _};
use winit::window::Window;

use super::request::FRAMES_IN_FLIGHT;
use crate::gpu::{Acquired, Gpu, GpuError, Image, NextImage, Submission, Surface, Swapchain, Use};
use crate::render::View;

/// Where frames go. The swapchain is dropped before its surface.
pub(super) enum Target {
    Window {
        swapchain: Option<Swapchain>,
        surface: Arc<Surface>,
        /// Whether the swapchain no longer fits the window.
        is_stale: bool,
    },
    Image(Arc<Image>),
}

/// An image to draw a frame to.
pub(super) struct TargetImage {
    pub(super) image: Arc<Image>,
    /// How it was used before.
    pub(super) before: Use,
    /// Present for a window.
    acquired: Option<Acquired>,
}

/// The next image to draw to.
pub(super) enum NextTarget {
    Image(TargetImage),
    /// The swapchain must be created anew.
    Outdated,
    /// The screen has released no image.
    Hidden,
}

impl TargetImage {
    /// The semaphores of the frame's submission.
    pub(super) fn submission(&self) -> Submission {
        self.acquired.as_ref().map(|acquired| acquired.submission).unwrap_or_default()
    }

    /// Whether the frame is presented.
    pub(super) fn is_presented(&self) -> bool {
        self.acquired.is_some()
    }
}

impl Target {
    /// A window.
    pub(super) fn window(gpu: &Arc<Gpu>, window: &Window) -> Result<Self, GpuError> {
        let handles = window.display_handle().and_then(|d| Ok((d.as_raw(), window.window_handle()?.as_raw())));
        let (display, handle) = handles.map_err(|e| GpuError::NoDevice(format!("the window has no handle: {e}")))?;
        let surface = Surface::new(gpu, display, handle)?;
        Ok(Self::Window { swapchain: None, surface, is_stale: true })
    }

    /// An image of this size.
    pub(super) fn image(view: &View, size: (u32, u32)) -> Result<Self, GpuError> {
        view.output_image(size).map(Self::Image)
    }

    /// Whether it is a window.
    pub(super) fn is_window(&self) -> bool {
        matches!(self, Self::Window { .. })
    }

    /// Its size in pixels; `None` while a window has no images.
    pub(super) fn extent(&self) -> Option<(u32, u32)> {
        match self {
            Self::Window { swapchain, .. } => swapchain.as_ref().map(Swapchain::extent),
            Self::Image(image) => Some((image.desc().width, image.desc().height)),
        }
    }

    /// Notes that a window has another size.
    pub(super) fn outdate(&mut self) {
        if let Self::Window { is_stale, .. } = self {
            *is_stale = true;
        }
    }

    /// Whether the swapchain must be created anew.
    pub(super) fn is_outdated(&self) -> bool {
        matches!(self, Self::Window { is_stale: true, .. })
    }

    /// Recreates the swapchain if it does not fit a window of this size. Returns whether there are images.
    pub(super) fn fit(&mut self, gpu: &Gpu, size: (u32, u32)) -> Result<bool, GpuError> {
        let Self::Window { swapchain, surface, is_stale } = self else { return Ok(true) };
        if *is_stale || swapchain.is_none() {
            let (old, is_fast) = (swapchain.take(), gpu.info().kind != "cpu");
            *swapchain = Swapchain::new(surface, size, FRAMES_IN_FLIGHT, is_fast, old)?;
            *is_stale = false;
        }
        Ok(swapchain.is_some())
    }

    /// The image of the next frame. Call after [`crate::gpu::Frames::begin`].
    pub(super) fn acquire(&mut self) -> Result<NextTarget, GpuError> {
        let next = match self {
            Self::Image(image) => {
                let image = TargetImage { image: image.clone(), before: Use::Undefined, acquired: None };
                return Ok(NextTarget::Image(image));
            }
            Self::Window { swapchain, .. } => swapchain.as_mut().map_or(Ok(NextImage::Outdated), Swapchain::acquire)?,
        };
        Ok(match next {
            NextImage::Acquired(acquired) => {
                let image = acquired.image.clone();
                NextTarget::Image(TargetImage { image, before: Use::Acquired, acquired: Some(acquired) })
            }
            NextImage::Outdated => {
                self.outdate();
                NextTarget::Outdated
            }
            NextImage::Busy => NextTarget::Hidden,
        })
    }

    /// Presents a frame that was submitted, if it is a window's.
    pub(super) fn present(&mut self, image: &TargetImage) -> Result<(), GpuError> {
        if let (Self::Window { swapchain: Some(swapchain), is_stale, .. }, Some(acquired)) = (self, &image.acquired) {
            *is_stale |= !swapchain.present(acquired)?;
        }
        Ok(())
    }
}
