//! Samplers.

use std::sync::Arc;

use ash::vk;

use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};

/// Filtering and addressing of texture reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SamplerDesc {
    /// Filter for magnification.
    pub mag: vk::Filter,
    /// Filter for minification.
    pub min: vk::Filter,
    /// Filter between mip levels.
    pub mip: vk::SamplerMipmapMode,
    /// Whether reads use levels beyond 0.
    pub mips: bool,
    /// Horizontal addressing.
    pub wrap_u: vk::SamplerAddressMode,
    /// Vertical addressing.
    pub wrap_v: vk::SamplerAddressMode,
    /// Addressing of the third coordinate, of volumes.
    pub wrap_w: vk::SamplerAddressMode,
    /// Largest number of anisotropic samples; 1 disables them.
    pub anisotropy: u32,
}

impl SamplerDesc {
    /// Reads the nearest texel of level 0, clamped to the edge.
    pub const NEAREST: Self = Self {
        mag: vk::Filter::NEAREST,
        min: vk::Filter::NEAREST,
        mip: vk::SamplerMipmapMode::NEAREST,
        mips: false,
        wrap_u: vk::SamplerAddressMode::CLAMP_TO_EDGE,
        wrap_v: vk::SamplerAddressMode::CLAMP_TO_EDGE,
        wrap_w: vk::SamplerAddressMode::CLAMP_TO_EDGE,
        anisotropy: 1,
    };
    /// Blends texels of level 0, clamped to the edge.
    pub const BILINEAR: Self = Self { mag: vk::Filter::LINEAR, min: vk::Filter::LINEAR, ..Self::NEAREST };
    /// Blends texels and levels, clamped to the edge.
    pub const LINEAR: Self = Self {
        mag: vk::Filter::LINEAR,
        min: vk::Filter::LINEAR,
        mip: vk::SamplerMipmapMode::LINEAR,
        mips: true,
        ..Self::NEAREST
    };
}

/// A sampler.
pub struct Sampler {
    gpu: Arc<Gpu>,
    pub(in crate::gpu) raw: vk::Sampler,
}

impl Sampler {
    /// Creates a sampler. Its debug name lists its filters.
    ///
    /// # Errors
    /// The device is out of memory or has too many samplers.
    pub fn new(gpu: &Arc<Gpu>, desc: &SamplerDesc) -> Result<Arc<Self>, GpuError> {
        let anisotropy = (desc.anisotropy as f32).min(gpu.properties.limits.max_sampler_anisotropy);
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(desc.mag)
            .min_filter(desc.min)
            .mipmap_mode(desc.mip)
            .address_mode_u(desc.wrap_u)
            .address_mode_v(desc.wrap_v)
            .address_mode_w(desc.wrap_w)
            .anisotropy_enable(gpu.anisotropy && anisotropy > 1.0)
            .max_anisotropy(anisotropy.max(1.0))
            // With 0, the magnification filter would apply everywhere. The Vulkan specification gives 0.25 for OpenGL's filters
            // without mip levels.
            .max_lod(if desc.mips { vk::LOD_CLAMP_NONE } else { 0.25 });
        // SAFETY: the device is live.
        let raw = unsafe { gpu.device.create_sampler(&info, None) }.context("creating a sampler")?;
        let mip = if desc.mips { format!("{:?}", desc.mip) } else { "no".to_owned() };
        gpu.name(raw, &format!("{:?} / {:?} sampler, {mip} mip levels", desc.mag, desc.min));
        Ok(Arc::new(Self { gpu: gpu.clone(), raw }))
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, so no descriptor in flight uses the sampler.
        unsafe { self.gpu.device.destroy_sampler(self.raw, None) };
    }
}
