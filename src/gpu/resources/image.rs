//! Images with their views.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::memory::{Resource, allocate};
use crate::astc;
use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};

/// Size, format and usage of an image.
#[derive(Clone, Copy, Debug)]
pub struct ImageDesc {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Mip levels.
    pub mips: u32,
    /// Slices of a volume at level 0; 1 for all other images.
    pub depth: u32,
    /// Layers: 1, the six faces of a cube, or any number of an array.
    pub layers: u32,
    /// How shaders sample the image.
    pub view: vk::ImageViewType,
    /// Samples per pixel.
    pub samples: u32,
    /// Format of a texel.
    pub format: vk::Format,
    /// Every way in which commands may use the image.
    pub usage: vk::ImageUsageFlags,
}

impl ImageDesc {
    /// A single-sampled image with one level.
    pub fn new(width: u32, height: u32, format: vk::Format, usage: vk::ImageUsageFlags) -> Self {
        let view = vk::ImageViewType::TYPE_2D;
        Self { width, height, depth: 1, mips: 1, layers: 1, view, samples: 1, format, usage }
    }

    /// The same as an array of `layers` images, for a shader's `sampler2DArray`.
    #[must_use]
    pub fn array(self, layers: u32) -> Self {
        Self { layers, view: vk::ImageViewType::TYPE_2D_ARRAY, ..self }
    }

    /// The same as a volume of `depth` slices, for a shader's `sampler3D`.
    #[must_use]
    pub fn volume(self, depth: u32) -> Self {
        Self { depth, view: vk::ImageViewType::TYPE_3D, ..self }
    }

    /// A cube map, `side` texels wide, with `mips` levels.
    pub fn cube(side: u32, mips: u32, format: vk::Format, usage: vk::ImageUsageFlags) -> Self {
        Self { mips, layers: 6, view: vk::ImageViewType::CUBE, ..Self::new(side, side, format, usage) }
    }

    /// Bytes of all levels and layers, tightly packed.
    pub fn bytes(&self) -> u64 {
        (0..self.mips).map(|level| self.level_bytes(level)).sum()
    }

    /// Bytes of one level with all its layers and slices, tightly packed.
    pub fn level_bytes(&self, level: u32) -> u64 {
        let side = |pixels: u32| (pixels >> level).max(1);
        let (width, height, bytes) = block(self.format);
        let blocks = u64::from(side(self.width).div_ceil(width)) * u64::from(side(self.height).div_ceil(height));
        blocks * u64::from(side(self.depth)) * u64::from(self.layers) * bytes
    }
}

/// Width and height of a block in texels, and its bytes, for the formats that are copied to and from buffers. Without compression, a block
/// is a texel.
fn block(format: vk::Format) -> (u32, u32, u64) {
    use vk::Format as F;
    match format {
        F::R16G16B16A16_SFLOAT | F::R16G16B16A16_UNORM => (1, 1, 8),
        F::R32G32B32A32_SFLOAT => (1, 1, 16),
        _ => match format.as_raw() {
            raw if in_formats(raw, F::BC1_RGB_UNORM_BLOCK, F::BC1_RGBA_SRGB_BLOCK) => (4, 4, 8),
            raw if in_formats(raw, F::BC4_UNORM_BLOCK, F::BC4_SNORM_BLOCK) => (4, 4, 8),
            raw if in_formats(raw, F::BC2_UNORM_BLOCK, F::BC7_SRGB_BLOCK) => (4, 4, 16),
            raw if in_formats(raw, F::ETC2_R8G8B8_UNORM_BLOCK, F::ETC2_R8G8B8A1_SRGB_BLOCK) => (4, 4, 8),
            raw if in_formats(raw, F::ETC2_R8G8B8A8_UNORM_BLOCK, F::ETC2_R8G8B8A8_SRGB_BLOCK) => (4, 4, 16),
            raw if in_formats(raw, F::ASTC_4X4_UNORM_BLOCK, F::ASTC_12X12_SRGB_BLOCK) => {
                // Each size is there as UNORM and as SRGB.
                let size = (raw - F::ASTC_4X4_UNORM_BLOCK.as_raw()) / 2;
                let (width, height) = astc::BLOCKS[size as usize];
                (width.into(), height.into(), 16)
            }
            _ => (1, 1, 4),
        },
    }
}

/// Whether a format is one of those between two, which Vulkan numbers in order.
fn in_formats(raw: i32, first: vk::Format, last: vk::Format) -> bool {
    (first.as_raw()..=last.as_raw()).contains(&raw)
}

/// An image with its memory and a view of all levels. An image with `STORAGE` usage also has a view of each level. The memory
/// of a swapchain's image belongs to the swapchain.
pub struct Image {
    gpu: Arc<Gpu>,
    pub(in crate::gpu) raw: vk::Image,
    pub(in crate::gpu) view: vk::ImageView,
    pub(in crate::gpu) level_views: Vec<vk::ImageView>,
    allocation: Option<Allocation>,
    owned: bool,
    /// The image that has the memory, if this is another view of it or another image in it.
    _of: Option<Arc<Image>>,
    desc: ImageDesc,
}

impl Image {
    /// Creates an image. GPU debuggers and validation messages show `name`.
    ///
    /// # Errors
    /// The device is out of memory ([`GpuError::OutOfMemory`]) or lacks the format.
    pub fn new(gpu: &Arc<Gpu>, name: &str, desc: ImageDesc) -> Result<Arc<Self>, GpuError> {
        let mut image = Self::without_memory(gpu, name, desc)?;
        let allocation = image.allocation.insert(allocate(
            gpu,
            &Resource {
                name,
                action: &format!("creating the image {}", description(name, &desc)),
                requirements: image.requirements(),
                location: MemoryLocation::GpuOnly,
                linear: false,
                limit: "image-bytes",
            },
        )?);
        // SAFETY: the memory was allocated for this image.
        let (memory, offset) = unsafe { (allocation.memory(), allocation.offset()) };
        image.bind(name, memory, offset)?;
        Ok(Arc::new(image))
    }

    /// Creates an image in the memory of this one. What is written to one of them makes the content of the other undefined, so each begins
    /// as [`Use::Undefined`](crate::gpu::Use::Undefined). `None` if the memory of this image is too small, or of a kind for other formats.
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn in_same_memory(self: &Arc<Self>, name: &str, desc: ImageDesc) -> Result<Option<Arc<Self>>, GpuError> {
        let Some(allocation) = &self.allocation else { return Ok(None) };
        let mut image = Self::without_memory(&self.gpu, name, desc)?;
        let (own, needed) = (self.requirements(), image.requirements());
        let fits = needed.size <= own.size && allocation.offset().is_multiple_of(needed.alignment);
        if !fits || own.memory_type_bits & !needed.memory_type_bits != 0 {
            return Ok(None);
        }
        // SAFETY: the memory lives as long as `self`, which the new image holds.
        let (memory, offset) = unsafe { (allocation.memory(), allocation.offset()) };
        image.bind(name, memory, offset)?;
        image._of = Some(self.clone());
        Ok(Some(Arc::new(image)))
    }

    /// The image alone. Its `Drop` frees what is already there when a later step fails.
    fn without_memory(gpu: &Arc<Gpu>, name: &str, desc: ImageDesc) -> Result<Self, GpuError> {
        let is_cube = desc.view == vk::ImageViewType::CUBE;
        let flags = if is_cube { vk::ImageCreateFlags::CUBE_COMPATIBLE } else { vk::ImageCreateFlags::empty() };
        let is_volume = desc.view == vk::ImageViewType::TYPE_3D;
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(if is_volume { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D })
            .format(desc.format)
            .extent(vk::Extent3D { width: desc.width, height: desc.height, depth: desc.depth })
            .mip_levels(desc.mips)
            .array_layers(desc.layers)
            .samples(vk::SampleCountFlags::from_raw(desc.samples))
            .usage(desc.usage);
        // SAFETY: the device is live.
        let raw = unsafe { gpu.device.create_image(&info, None) }
            .context_of("creating the image", &description(name, &desc))?;
        gpu.name(raw, name);
        let (view, level_views) = (vk::ImageView::null(), Vec::new());
        Ok(Self { gpu: gpu.clone(), raw, view, level_views, allocation: None, owned: true, _of: None, desc })
    }

    fn requirements(&self) -> vk::MemoryRequirements {
        // SAFETY: the image belongs to this device.
        unsafe { self.gpu.device.get_image_memory_requirements(self.raw) }
    }

    /// Binds the memory, once, and creates the views.
    fn bind(&mut self, name: &str, memory: vk::DeviceMemory, offset: u64) -> Result<(), GpuError> {
        let Self { gpu, raw, desc, .. } = self;
        // SAFETY: the memory has the size, the alignment and the kind that the image requires.
        unsafe { gpu.device.bind_image_memory(*raw, memory, offset) }
            .context_of("binding memory to the image", &description(name, desc))?;
        self.view = create_view(gpu, *raw, desc)?;
        gpu.name(self.view, name);
        if desc.usage.contains(vk::ImageUsageFlags::STORAGE) {
            for level in 0..desc.mips {
                let view = create_level_view(gpu, *raw, desc, level)?;
                gpu.name(view, &format!("{name} level {level}"));
                self.level_views.push(view);
            }
        }
        Ok(())
    }

    /// Wraps an image that a swapchain owns.
    pub(in crate::gpu) fn from_swapchain(
        gpu: &Arc<Gpu>,
        name: &str,
        raw: vk::Image,
        desc: ImageDesc,
    ) -> Result<Arc<Self>, GpuError> {
        let view = create_view(gpu, raw, &desc)?;
        gpu.name(raw, name);
        gpu.name(view, name);
        Ok(Arc::new(Self {
            gpu: gpu.clone(),
            raw,
            view,
            level_views: Vec::new(),
            allocation: None,
            owned: false,
            _of: None,
            desc,
        }))
    }

    /// The same image, sampled with these channels, red first, as 1.
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn with_ones(self: &Arc<Self>, ones: [bool; 4]) -> Result<Arc<Self>, GpuError> {
        let channel = |is_one| if is_one { vk::ComponentSwizzle::ONE } else { vk::ComponentSwizzle::IDENTITY };
        let [r, g, b, a] = ones.map(channel);
        let components = vk::ComponentMapping { r, g, b, a };
        let Self { gpu, raw, desc, .. } = &**self;
        let view = view_of_levels(gpu, *raw, desc, desc.view, 0..desc.mips, components)?;
        gpu.name(view, "a texture without some channels");
        Ok(Arc::new(Self {
            gpu: gpu.clone(),
            raw: *raw,
            view,
            level_views: Vec::new(),
            allocation: None,
            owned: false,
            _of: Some(self.clone()),
            desc: *desc,
        }))
    }

    /// Size, format and usage.
    pub fn desc(&self) -> &ImageDesc {
        &self.desc
    }

    pub(in crate::gpu) fn aspect(&self) -> vk::ImageAspectFlags {
        aspect(self.desc.format)
    }
}

/// An image in messages, as "`depth` (1280 x 720, 4 samples)".
fn description(name: &str, desc: &ImageDesc) -> String {
    let samples = if desc.samples > 1 { format!(", {} samples", desc.samples) } else { String::new() };
    format!("`{name}` ({} x {}{samples})", desc.width, desc.height)
}

fn aspect(format: vk::Format) -> vk::ImageAspectFlags {
    if format == vk::Format::D32_SFLOAT { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR }
}

fn create_view(gpu: &Gpu, raw: vk::Image, desc: &ImageDesc) -> Result<vk::ImageView, GpuError> {
    view_of_levels(gpu, raw, desc, desc.view, 0..desc.mips, vk::ComponentMapping::default())
}

/// A view of one level with all its layers, for a shader's `image2DArray`.
fn create_level_view(gpu: &Gpu, raw: vk::Image, desc: &ImageDesc, level: u32) -> Result<vk::ImageView, GpuError> {
    let same = vk::ComponentMapping::default();
    view_of_levels(gpu, raw, desc, vk::ImageViewType::TYPE_2D_ARRAY, level..level + 1, same)
}

fn view_of_levels(
    gpu: &Gpu,
    raw: vk::Image,
    desc: &ImageDesc,
    kind: vk::ImageViewType,
    levels: std::ops::Range<u32>,
    components: vk::ComponentMapping,
) -> Result<vk::ImageView, GpuError> {
    let range = vk::ImageSubresourceRange {
        aspect_mask: aspect(desc.format),
        base_mip_level: levels.start,
        level_count: levels.end - levels.start,
        base_array_layer: 0,
        layer_count: desc.layers,
    };
    let info = vk::ImageViewCreateInfo::default().image(raw).view_type(kind).format(desc.format);
    let info = info.components(components).subresource_range(range);
    // SAFETY: the image is live.
    unsafe { gpu.device.create_image_view(&info, None) }.context("creating an image view")
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, so no command in flight uses the image. Vulkan ignores a null view.
        unsafe {
            for view in std::iter::once(&self.view).chain(&self.level_views) {
                self.gpu.device.destroy_image_view(*view, None);
            }
            if self.owned {
                self.gpu.device.destroy_image(self.raw, None);
            }
        }
        if let Some(allocation) = self.allocation.take() {
            let _ = self.gpu.lock_allocator().free(allocation);
        }
    }
}
