//! The swapchain of a window.

use std::sync::Arc;
use std::time::Duration;

use ash::vk;

use super::surface::{Surface, no_display};
use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError, Image, ImageDesc, Submission, fault};

/// An image of the swapchain to draw a frame to.
pub struct Acquired {
    /// The image, in [`crate::gpu::Use::Acquired`].
    pub image: Arc<Image>,
    /// For [`crate::gpu::Frames::submit`].
    pub submission: Submission,
    /// Whether the swapchain no longer fits the window. The frame can still be shown.
    pub stale: bool,
    index: u32,
}

/// The next image of a window.
pub enum NextImage {
    /// An image to draw to.
    Acquired(Acquired),
    /// The caller must create the swapchain anew.
    Outdated,
    /// The screen has released no image for a while, for example because the window is hidden. The caller may try again later.
    Busy,
}

/// How long to wait for an image. Events of the window wait meanwhile.
const IMAGE_TIMEOUT: Duration = Duration::from_millis(500);

/// The images of a window.
pub struct Swapchain {
    gpu: Arc<Gpu>,
    _surface: Arc<Surface>,
    raw: vk::SwapchainKHR,
    images: Vec<Arc<Image>>,
    acquired: Vec<vk::Semaphore>,
    rendered: Vec<vk::Semaphore>,
    next: usize,
    /// Whether an acquired image was not presented yet.
    is_held: bool,
}

impl Swapchain {
    /// The format of every swapchain. Shaders encode sRGB themselves, so that data modes reach the screen unchanged.
    pub const FORMAT: vk::Format = vk::Format::B8G8R8A8_UNORM;

    /// Creates a swapchain of `width` x `height` pixels that replaces `old`; `None` when the window has no area. `in_flight` is
    /// the number of frame slots.
    ///
    /// # Errors
    /// The window is gone, lacks the format, or the device is out of memory. Vulkan retires `old` even if this call fails, so
    /// `old` is destroyed in any case. After [`GpuError::OutOfMemory`] the caller may try again with `None`.
    pub fn new(
        surface: &Arc<Surface>,
        size: (u32, u32),
        in_flight: usize,
        vsync: bool,
        old: Option<Self>,
    ) -> Result<Option<Self>, GpuError> {
        // SYNC: the presentation engine may still read the old images, and no fence covers that. Only a window that opens,
        // changes its size or its vsync comes here.
        surface.gpu.wait_idle();
        let retired = old.as_ref().map_or(vk::SwapchainKHR::null(), |old| old.raw);
        match (Self::create(surface, size, in_flight, vsync, retired), old) {
            (Err(GpuError::OutOfMemory(_)), Some(old)) => {
                drop(old);
                Self::create(surface, size, in_flight, vsync, vk::SwapchainKHR::null())
            }
            (result, _) => result,
        }
    }

    fn create(
        surface: &Arc<Surface>,
        size: (u32, u32),
        in_flight: usize,
        vsync: bool,
        old: vk::SwapchainKHR,
    ) -> Result<Option<Self>, GpuError> {
        let gpu = &surface.gpu;
        let Some(swapchains) = &gpu.swapchain else { return Err(no_display()) };
        let Some(window) = Window::query(surface, size, vsync)? else { return Ok(None) };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count(window.image_count)
            .image_format(Self::FORMAT)
            .image_color_space(vk::ColorSpaceKHR::SRGB_NONLINEAR)
            .image_extent(window.extent)
            .image_array_layers(1)
            .image_usage(window.usage)
            .pre_transform(window.transform)
            .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
            .present_mode(window.mode)
            .clipped(true)
            .old_swapchain(old);
        fault::refuse("swapchain", "creating the swapchain")?;
        // SAFETY: the surface is live. This call retires the old swapchain, which the caller destroys.
        let raw = unsafe { swapchains.create_swapchain(&info, None) }.context("creating the swapchain")?;
        gpu.name(raw, "swapchain");
        // From here on, `Drop` frees what is already there when a later step fails.
        let mut this = Self {
            gpu: gpu.clone(),
            _surface: surface.clone(),
            raw,
            images: Vec::new(),
            acquired: Vec::new(),
            rendered: Vec::new(),
            next: 0,
            is_held: false,
        };
        // SAFETY: the swapchain is live.
        let images = unsafe { swapchains.get_swapchain_images(raw) }.context("querying the swapchain's images")?;
        let vk::Extent2D { width, height } = window.extent;
        let desc = ImageDesc::new(width, height, Self::FORMAT, window.usage);
        for (index, image) in images.into_iter().enumerate() {
            this.images.push(Image::from_swapchain(gpu, &format!("swapchain image {index}"), image, desc)?);
            this.rendered.push(semaphore(gpu, &format!("swapchain image {index} rendered"))?);
        }
        for index in 0..=in_flight {
            this.acquired.push(semaphore(gpu, &format!("swapchain acquisition {index}"))?);
        }
        Ok(Some(this))
    }

    /// Width and height in pixels.
    pub fn extent(&self) -> (u32, u32) {
        self.images.first().map_or((0, 0), |i| (i.desc().width, i.desc().height))
    }

    /// Acquires the next image. The swapchain is outdated if it no longer fits the window, or if the last acquired image was never
    /// presented because its frame failed. Call after [`crate::gpu::Frames::begin`], which has waited for the last use of the semaphore.
    ///
    /// # Errors
    /// The device or the window is lost, or the device is out of memory.
    pub fn acquire(&mut self) -> Result<NextImage, GpuError> {
        let Some(swapchains) = &self.gpu.swapchain else { return Ok(NextImage::Outdated) };
        // An image that is never presented is never free again, and its semaphore stays signaled.
        if self.is_held {
            return Ok(NextImage::Outdated);
        }
        if fault::value("window-hidden").is_some() {
            return Ok(NextImage::Busy);
        }
        let next = (self.next + 1) % self.acquired.len();
        let wait = self.acquired[next];
        // SYNC: with vsync, this waits until the screen releases an image.
        // SAFETY: a frame older than the slots in flight was the last to wait for the semaphore.
        let result = unsafe {
            swapchains.acquire_next_image(self.raw, IMAGE_TIMEOUT.as_nanos() as u64, wait, vk::Fence::null())
        };
        match result {
            Ok((index, stale)) => {
                (self.next, self.is_held) = (next, true);
                Ok(NextImage::Acquired(Acquired {
                    image: self.images[index as usize].clone(),
                    submission: Submission { wait: Some(wait), signal: Some(self.rendered[index as usize]) },
                    stale,
                    index,
                }))
            }
            // The semaphore stays unsignaled, so the next attempt takes it again.
            Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => Ok(NextImage::Busy),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(NextImage::Outdated),
            Err(other) => Err(other).context("acquiring a swapchain image"),
        }
    }

    /// Shows an image after its frame was submitted; `false` when the caller must create the swapchain anew.
    ///
    /// # Errors
    /// The device or the window is lost, or the device is out of memory.
    pub fn present(&mut self, acquired: &Acquired) -> Result<bool, GpuError> {
        let Some(swapchains) = &self.gpu.swapchain else { return Ok(false) };
        let (wait, chains, indices) = ([self.rendered[acquired.index as usize]], [self.raw], [acquired.index]);
        let info = vk::PresentInfoKHR::default().wait_semaphores(&wait).swapchains(&chains).image_indices(&indices);
        let queue = self.gpu.lock_queue();
        // SAFETY: the image was acquired, its frame signals the semaphore, and the queue is locked.
        match unsafe { swapchains.queue_present(*queue, &info) } {
            Ok(stale) => {
                self.is_held = false;
                Ok(!stale && !acquired.stale)
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(false),
            Err(other) => Err(other).context("presenting a frame"),
        }
    }
}

/// The properties of a window that its swapchain follows.
struct Window {
    extent: vk::Extent2D,
    image_count: u32,
    transform: vk::SurfaceTransformFlagsKHR,
    mode: vk::PresentModeKHR,
    usage: vk::ImageUsageFlags,
}

impl Window {
    /// `None` when the window has no area. `width` and `height` apply where the window system leaves the size to Vulkan.
    fn query(surface: &Surface, (width, height): (u32, u32), vsync: bool) -> Result<Option<Self>, GpuError> {
        let gpu = &surface.gpu;
        let loader = gpu.surface.as_ref().ok_or_else(no_display)?;
        // SAFETY: surface and device are live, in all three calls.
        let (capabilities, formats, modes) = unsafe {
            (
                loader
                    .get_physical_device_surface_capabilities(gpu.physical, surface.raw)
                    .context("querying the window's size")?,
                loader
                    .get_physical_device_surface_formats(gpu.physical, surface.raw)
                    .context("querying the window's formats")?,
                loader
                    .get_physical_device_surface_present_modes(gpu.physical, surface.raw)
                    .context("querying the window's present modes")?,
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
        let shown = (Swapchain::FORMAT, vk::ColorSpaceKHR::SRGB_NONLINEAR);
        if !formats.iter().any(|f| (f.format, f.color_space) == shown) {
            return Err(GpuError::NoDevice("the window does not offer the format B8G8R8A8_UNORM".into()));
        }
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let unthrottled = [vk::PresentModeKHR::MAILBOX, vk::PresentModeKHR::IMMEDIATE];
        let mode = unthrottled.into_iter().find(|m| !vsync && modes.contains(m)).unwrap_or(vk::PresentModeKHR::FIFO);
        Ok(Some(Self {
            extent,
            image_count: (capabilities.min_image_count + 1).min(most),
            transform: capabilities.current_transform,
            mode,
            // If passes follow the tone map, their result is copied to the swapchain's image.
            usage: vk::ImageUsageFlags::COLOR_ATTACHMENT
                | ((vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC)
                    & capabilities.supported_usage_flags),
        }))
    }
}

fn semaphore(gpu: &Gpu, name: &str) -> Result<vk::Semaphore, GpuError> {
    // SAFETY: the device is live.
    let semaphore = unsafe { gpu.device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None) }
        .context("creating a semaphore")?;
    gpu.name(semaphore, name);
    Ok(semaphore)
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        // SYNC: as in `new`, no fence covers the presentation engine's use of the images and semaphores.
        self.gpu.wait_idle();
        self.images.clear();
        // SAFETY: the device is idle. Views of the images are gone, or frames that are finished keep them.
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
