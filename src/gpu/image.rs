//! Images with their view, and samplers.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::device::Gpu;
use super::error::{Context, GpuError};

/// What an image is.
#[derive(Clone, Copy, Debug)]
pub struct ImageDesc {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Mip levels.
    pub mips: u32,
    /// Layers: 1, or the six faces of a cube.
    pub layers: u32,
    /// Samples a pixel.
    pub samples: u32,
    /// Format.
    pub format: vk::Format,
    /// Usage.
    pub usage: vk::ImageUsageFlags,
}

impl ImageDesc {
    /// A single-sampled image with one level.
    pub fn new(width: u32, height: u32, format: vk::Format, usage: vk::ImageUsageFlags) -> Self {
        Self { width, height, mips: 1, layers: 1, samples: 1, format, usage }
    }

    /// A cube map, `side` texels wide, with `mips` levels.
    pub fn cube(side: u32, mips: u32, format: vk::Format, usage: vk::ImageUsageFlags) -> Self {
        Self { mips, layers: CUBE_FACES, ..Self::new(side, side, format, usage) }
    }

    /// Bytes of all levels and layers, tightly packed.
    pub fn bytes(&self) -> u64 {
        (0..self.mips).map(|level| self.level_bytes(level)).sum()
    }

    /// Bytes of one level with all its layers, tightly packed.
    pub fn level_bytes(&self, level: u32) -> u64 {
        let side = |pixels: u32| u64::from((pixels >> level).max(1));
        side(self.width) * side(self.height) * u64::from(self.layers) * texel_bytes(self.format)
    }
}

const CUBE_FACES: u32 = 6;

/// Bytes of a texel, for the formats that are copied to and from buffers.
fn texel_bytes(format: vk::Format) -> u64 {
    match format {
        vk::Format::R16G16B16A16_SFLOAT => 8,
        vk::Format::R32G32B32A32_SFLOAT => 16,
        _ => 4,
    }
}

/// An image, its memory and a view of all of it; one view of each level, too, when shaders write it. A swapchain's image has no memory of its own.
pub struct Image {
    gpu: Arc<Gpu>,
    pub(super) raw: vk::Image,
    pub(super) view: vk::ImageView,
    pub(super) level_views: Vec<vk::ImageView>,
    allocation: Option<Allocation>,
    owned: bool,
    desc: ImageDesc,
}

impl Image {
    /// Makes an image: 2D, or a cube of six layers.
    ///
    /// # Errors
    /// Out of memory, or a format that the device lacks.
    pub fn new(gpu: &Arc<Gpu>, name: &str, desc: ImageDesc) -> Result<Arc<Self>, GpuError> {
        let is_cube = desc.layers == CUBE_FACES;
        let flags = if is_cube { vk::ImageCreateFlags::CUBE_COMPATIBLE } else { vk::ImageCreateFlags::empty() };
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(vk::ImageType::TYPE_2D)
            .format(desc.format)
            .extent(vk::Extent3D { width: desc.width, height: desc.height, depth: 1 })
            .mip_levels(desc.mips)
            .array_layers(desc.layers)
            .samples(vk::SampleCountFlags::from_raw(desc.samples))
            .usage(desc.usage);
        // SAFETY: the device is live.
        let raw = unsafe { gpu.device.create_image(&info, None) }.context("creating an image")?;
        let view = vk::ImageView::null();
        let mut image =
            Self { gpu: gpu.clone(), raw, view, level_views: Vec::new(), allocation: None, owned: true, desc };
        // SAFETY: `raw` belongs to this device.
        let requirements = unsafe { gpu.device.get_image_memory_requirements(raw) };
        let allocation = gpu
            .lock_allocator()
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location: MemoryLocation::GpuOnly,
                linear: false,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|e| GpuError::Allocation { what: name.into(), message: e.to_string() })?;
        // SAFETY: the memory was allocated for these requirements and is bound once.
        let bound = unsafe { gpu.device.bind_image_memory(raw, allocation.memory(), allocation.offset()) };
        image.allocation = Some(allocation);
        bound.context("binding image memory")?;
        image.view = create_view(gpu, raw, &desc)?;
        if desc.usage.contains(vk::ImageUsageFlags::STORAGE) {
            for level in 0..desc.mips {
                image.level_views.push(create_level_view(gpu, raw, &desc, level)?);
            }
        }
        Ok(Arc::new(image))
    }

    /// Wraps an image of the swapchain, which the swapchain frees.
    pub(super) fn from_swapchain(gpu: &Arc<Gpu>, raw: vk::Image, desc: ImageDesc) -> Result<Arc<Self>, GpuError> {
        let view = create_view(gpu, raw, &desc)?;
        Ok(Arc::new(Self {
            gpu: gpu.clone(),
            raw,
            view,
            level_views: Vec::new(),
            allocation: None,
            owned: false,
            desc,
        }))
    }

    /// Its description.
    pub fn desc(&self) -> &ImageDesc {
        &self.desc
    }

    pub(super) fn aspect(&self) -> vk::ImageAspectFlags {
        aspect(self.desc.format)
    }
}

fn aspect(format: vk::Format) -> vk::ImageAspectFlags {
    if format == vk::Format::D32_SFLOAT { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR }
}

fn create_view(gpu: &Gpu, raw: vk::Image, desc: &ImageDesc) -> Result<vk::ImageView, GpuError> {
    let kind = if desc.layers == CUBE_FACES { vk::ImageViewType::CUBE } else { vk::ImageViewType::TYPE_2D };
    view_of_levels(gpu, raw, desc, kind, 0..desc.mips)
}

/// What a shader's `image2DArray` writes.
fn create_level_view(gpu: &Gpu, raw: vk::Image, desc: &ImageDesc, level: u32) -> Result<vk::ImageView, GpuError> {
    view_of_levels(gpu, raw, desc, vk::ImageViewType::TYPE_2D_ARRAY, level..level + 1)
}

fn view_of_levels(
    gpu: &Gpu,
    raw: vk::Image,
    desc: &ImageDesc,
    kind: vk::ImageViewType,
    levels: std::ops::Range<u32>,
) -> Result<vk::ImageView, GpuError> {
    let range = vk::ImageSubresourceRange {
        aspect_mask: aspect(desc.format),
        base_mip_level: levels.start,
        level_count: levels.end - levels.start,
        base_array_layer: 0,
        layer_count: desc.layers,
    };
    let info =
        vk::ImageViewCreateInfo::default().image(raw).view_type(kind).format(desc.format).subresource_range(range);
    // SAFETY: the image is live.
    unsafe { gpu.device.create_image_view(&info, None) }.context("creating an image view")
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, so no command in flight uses the image; a null view may be destroyed.
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

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SamplerDesc {
    /// Magnification.
    pub mag: vk::Filter,
    /// Minification.
    pub min: vk::Filter,
    /// Between mip levels.
    pub mip: vk::SamplerMipmapMode,
    /// Whether levels beyond 0 are read.
    pub mips: bool,
    /// Horizontal wrap.
    pub wrap_u: vk::SamplerAddressMode,
    /// Vertical wrap.
    pub wrap_v: vk::SamplerAddressMode,
    /// Samples along the axis of anisotropy; 1 is off.
    pub anisotropy: u32,
}

impl SamplerDesc {
    /// The nearest texel of level 0, clamped.
    pub const NEAREST: Self = Self {
        mag: vk::Filter::NEAREST,
        min: vk::Filter::NEAREST,
        mip: vk::SamplerMipmapMode::NEAREST,
        mips: false,
        wrap_u: vk::SamplerAddressMode::CLAMP_TO_EDGE,
        wrap_v: vk::SamplerAddressMode::CLAMP_TO_EDGE,
        anisotropy: 1,
    };
}

/// A sampler.
pub struct Sampler {
    gpu: Arc<Gpu>,
    pub(super) raw: vk::Sampler,
}

impl Sampler {
    /// Makes a sampler.
    ///
    /// # Errors
    /// Too many samplers.
    pub fn new(gpu: &Arc<Gpu>, desc: &SamplerDesc) -> Result<Arc<Self>, GpuError> {
        let anisotropy = (desc.anisotropy as f32).min(gpu.properties.limits.max_sampler_anisotropy);
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(desc.mag)
            .min_filter(desc.min)
            .mipmap_mode(desc.mip)
            .address_mode_u(desc.wrap_u)
            .address_mode_v(desc.wrap_v)
            .address_mode_w(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .anisotropy_enable(gpu.anisotropy && anisotropy > 1.0)
            .max_anisotropy(anisotropy.max(1.0))
            // 0.25 keeps minification apart from magnification at level 0, as the Vulkan specification advises for GL's filters.
            .max_lod(if desc.mips { vk::LOD_CLAMP_NONE } else { 0.25 });
        // SAFETY: the device is live.
        let raw = unsafe { gpu.device.create_sampler(&info, None) }.context("creating a sampler")?;
        Ok(Arc::new(Self { gpu: gpu.clone(), raw }))
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, so no descriptor in flight uses the sampler.
        unsafe { self.gpu.device.destroy_sampler(self.raw, None) };
    }
}
