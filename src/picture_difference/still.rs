//! A picture from a file on the device, scaled to the view that it is compared with.
//!
//! Threads read and scale the file. The colors of a PNG or JPEG are copied to the target unchanged. The light of an HDR
//! or EXR replaces the HDR target of the second `View` (`View::override_image`), so it goes through the same tone map,
//! range and display passes as the frame beside it.

use std::sync::Arc;

use image::RgbaImage;

use super::Picture;
use super::fit::{Fitted, fit};
use crate::gpu::{Gpu, GpuError, Image, ImageDesc, Rect, Swapchain, upload_images, vk};

/// A scaled picture on the device.
pub struct Still {
    /// In `Use::Sampled`. LDR colors in the swapchain's format, or light in full floats.
    pub image: Arc<Image>,
    /// The part of the image that the picture covers. The rest is black, or without coverage.
    pub covered: Rect,
    /// The LDR colors on the CPU; `None` for light, which a view tone maps first.
    pub display: Option<Arc<RgbaImage>>,
}

impl Still {
    /// Scales a picture to fit a view of `size`, and uploads it.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(gpu: &Arc<Gpu>, picture: &Picture, size: (u32, u32)) -> Result<Self, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let Fitted { picture, covered } = fit(picture, size);
        let usage = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let upload = |format, bytes: &[u8]| {
            let image = Image::new(gpu, "compared picture", ImageDesc::new(size.0, size.1, format, usage))?;
            upload_images(gpu, &[(&image, bytes)]).map(|()| image)
        };
        match picture {
            Picture::Display(image) => {
                let mut bgra = image.as_raw().clone();
                bgra.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
                let on_device = upload(Swapchain::FORMAT, &bgra)?;
                Ok(Self { image: on_device, covered, display: Some(Arc::new(image)) })
            }
            Picture::Raw(image) => {
                let on_device = upload(vk::Format::R32G32B32A32_SFLOAT, bytemuck::cast_slice(image.as_raw()))?;
                Ok(Self { image: on_device, covered, display: None })
            }
        }
    }

    /// The size of the view.
    pub fn size(&self) -> (u32, u32) {
        (self.image.desc().width, self.image.desc().height)
    }
}
