//! The window's surface and its swapchain.

use std::sync::Arc;

use ash::vk;
use raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use super::device::Gpu;
use super::error::{Context, GpuError};
use super::frames::Submission;
use super::image::{Image, ImageDesc};

/// A window as Vulkan sees it.
pub struct Surface {
    gpu: Arc<Gpu>,
    raw: vk::SurfaceKHR,
}

impl Surface {
    /// Makes the surface of a window. The caller keeps the window open while the surface lives.
    ///
    /// # Errors
    /// A device that cannot show this window, or that was opened without a display.
    pub fn new(gpu: &Arc<Gpu>, display: RawDisplayHandle, window: RawWindowHandle) -> Result<Arc<Self>, GpuError> {
        let loader =
            gpu.surface.as_ref().ok_or_else(|| GpuError::NoDevice("it was opened without a display".into()))?;
        // SAFETY: the handles come from a live window; the instance has the extensions of this display.
        let raw = unsafe { ash_window::create_surface(&gpu.entry, &gpu.instance, display, window, None) }
            .context("creating the window's surface")?;
        let surface = Self { gpu: gpu.clone(), raw };
        // SAFETY: surface and device are live.
        let shown = unsafe { loader.get_physical_device_surface_support(gpu.physical, gpu.queue_family, raw) }
            .context("asking whether the device can show the window")?;
        match shown {
            true => Ok(Arc::new(surface)),
            false => Err(GpuError::NoDevice(format!("{} cannot show this window", gpu.info().name))),
        }
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        if let Some(loader) = &self.gpu.surface {
            // SAFETY: the swapchain holds the surface by `Arc`, so none is left.
            unsafe { loader.destroy_surface(self.raw, None) };
        }
    }
}

/// An image to draw a frame to.
pub struct Acquired {
    /// The image, in [`super::Use::Acquired`].
    pub image: Arc<Image>,
    /// For [`super::Frames::submit`].
    pub submission: Submission,
    /// Whether the swapchain fits the window no longer; the frame can still be shown.
    pub stale: bool,
    index: u32,
}

/// The images of a window.
pub struct Swapchain {
    gpu: Arc<Gpu>,
    _surface: Arc<Surface>,
    raw: vk::SwapchainKHR,
    images: Vec<Arc<Image>>,
    acquired: Vec<vk::Semaphore>,
    rendered: Vec<vk::Semaphore>,
    next: usize,
}

impl Swapchain {
    /// The format of every swapchain: shaders encode sRGB themselves, so that data modes reach the screen as they are.
    pub const FORMAT: vk::Format = vk::Format::B8G8R8A8_UNORM;

    /// Makes a swapchain of `width` x `height` pixels, in place of `old`; `None` when the window has no area.
    /// `in_flight` is the number of frame slots.
    ///
    /// # Errors
    /// A window that is gone, or without the format.
    pub fn new(
        surface: &Arc<Surface>,
        (width, height): (u32, u32),
        in_flight: usize,
        vsync: bool,
        old: Option<Self>,
    ) -> Result<Option<Self>, GpuError> {
        let gpu = &surface.gpu;
        let (Some(loader), Some(swapchains)) = (&gpu.surface, &gpu.swapchain) else {
            return Err(GpuError::NoDevice("it was opened without a display".into()));
        };
        // SYNC: the old images may still be on their way to the screen, which no fence tells. Resize only.
        gpu.wait_idle();
        // SAFETY: surface and device are live, in all three calls.
        let (capabilities, formats, modes) = unsafe {
            (
                loader
                    .get_physical_device_surface_capabilities(gpu.physical, surface.raw)
                    .context("asking for the window's size")?,
                loader
                    .get_physical_device_surface_formats(gpu.physical, surface.raw)
                    .context("asking for the window's formats")?,
                loader
                    .get_physical_device_surface_present_modes(gpu.physical, surface.raw)
                    .context("asking for the window's present modes")?,
            )
        };
        let extent = match capabilities.current_extent {
            vk::Extent2D { width: u32::MAX, .. } => vk::Extent2D {
                width: width.clamp(capabilities.min_image_extent.width, capabilities.max_image_extent.width),
                height: height.clamp(capabilities.min_image_extent.height, capabilities.max_image_extent.height),
            },
            fixed => fixed,
        };
        if extent.width == 0 || extent.height == 0 {
            return Ok(None);
        }
        let format = formats
            .iter()
            .find(|f| f.format == Self::FORMAT && f.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR)
            .ok_or_else(|| GpuError::NoDevice("the window has no B8G8R8A8_UNORM format".into()))?;
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let free = [vk::PresentModeKHR::MAILBOX, vk::PresentModeKHR::IMMEDIATE];
        let mode = free.into_iter().find(|m| !vsync && modes.contains(m)).unwrap_or(vk::PresentModeKHR::FIFO);
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count((capabilities.min_image_count + 1).min(most))
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT)
            .pre_transform(capabilities.current_transform)
            .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
            .present_mode(mode)
            .clipped(true)
            .old_swapchain(old.as_ref().map_or(vk::SwapchainKHR::null(), |o| o.raw));
        // SAFETY: the surface is live; the old swapchain is retired by this call and destroyed below.
        let raw = unsafe { swapchains.create_swapchain(&info, None) }.context("creating the swapchain")?;
        drop(old);
        let mut this = Self {
            gpu: gpu.clone(),
            _surface: surface.clone(),
            raw,
            images: Vec::new(),
            acquired: Vec::new(),
            rendered: Vec::new(),
            next: 0,
        };
        // SAFETY: the swapchain is live.
        let images = unsafe { swapchains.get_swapchain_images(raw) }.context("asking for the swapchain's images")?;
        let desc = ImageDesc::new(extent.width, extent.height, Self::FORMAT, vk::ImageUsageFlags::COLOR_ATTACHMENT);
        for image in images {
            this.images.push(Image::from_swapchain(gpu, image, desc)?);
            this.rendered.push(semaphore(gpu)?);
        }
        for _ in 0..=in_flight {
            this.acquired.push(semaphore(gpu)?);
        }
        Ok(Some(this))
    }

    /// Width and height in pixels.
    pub fn extent(&self) -> (u32, u32) {
        self.images.first().map_or((0, 0), |i| (i.desc().width, i.desc().height))
    }

    /// Takes the next image, or `None` when the swapchain must be made anew first. Call after [`super::Frames::begin`], whose
    /// fence frees the semaphore used here.
    ///
    /// # Errors
    /// A lost device or window.
    pub fn acquire(&mut self) -> Result<Option<Acquired>, GpuError> {
        let Some(swapchains) = &self.gpu.swapchain else { return Ok(None) };
        self.next = (self.next + 1) % self.acquired.len();
        let wait = self.acquired[self.next];
        // SAFETY: the semaphore was last waited for by a frame older than the slots in flight.
        let result = unsafe { swapchains.acquire_next_image(self.raw, u64::MAX, wait, vk::Fence::null()) };
        match result {
            Ok((index, stale)) => Ok(Some(Acquired {
                image: self.images[index as usize].clone(),
                submission: Submission { wait: Some(wait), signal: Some(self.rendered[index as usize]) },
                stale,
                index,
            })),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(None),
            Err(other) => Err(other).context("taking a swapchain image"),
        }
    }

    /// Shows a drawn image; `false` when the swapchain must be made anew.
    ///
    /// # Errors
    /// A lost device or window.
    pub fn present(&mut self, acquired: &Acquired) -> Result<bool, GpuError> {
        let Some(swapchains) = &self.gpu.swapchain else { return Ok(false) };
        let (wait, chains, indices) = ([self.rendered[acquired.index as usize]], [self.raw], [acquired.index]);
        let info = vk::PresentInfoKHR::default().wait_semaphores(&wait).swapchains(&chains).image_indices(&indices);
        let queue = self.gpu.lock_queue();
        // SAFETY: the image was acquired and its rendering signals the semaphore; the queue is locked.
        match unsafe { swapchains.queue_present(*queue, &info) } {
            Ok(stale) => Ok(!stale && !acquired.stale),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(false),
            Err(other) => Err(other).context("showing a frame"),
        }
    }
}

fn semaphore(gpu: &Gpu) -> Result<vk::Semaphore, GpuError> {
    // SAFETY: the device is live.
    unsafe { gpu.device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None) }.context("creating a semaphore")
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        // SYNC: see `new`; the screen's use of the images has no fence.
        self.gpu.wait_idle();
        self.images.clear();
        // SAFETY: the device is idle; the images' views are gone or only kept by finished frames.
        unsafe {
            for semaphore in self.acquired.iter().chain(&self.rendered) {
                self.gpu.device.destroy_semaphore(*semaphore, None);
            }
            if let Some(swapchains) = &self.gpu.swapchain {
                swapchains.destroy_swapchain(self.raw, None);
            }
        }
    }
}
