//! The images of an environment on the device, which image-based lighting reads.

use std::sync::Arc;

use crate::gpu::{Buffer, Gpu, GpuError, Image, ImageDesc, Sampler, vk};
use crate::interface::MAX_SUNS;
use crate::render::compute;
use crate::scene::Sun;

/// Format of the cube maps.
pub(super) const HALF: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
/// Format of the octahedral maps: three mantissas of 9 bits with one exponent (ibl/maps/shared_exponent.glsl). A
/// software device reads it in two thirds of the time of four half floats.
pub(super) const SHARED_EXPONENT: vk::Format = vk::Format::E5B9G9R9_UFLOAT_PACK32;

/// An environment on the device; all images in [`Use::Sampled`](crate::gpu::Use::Sampled).
pub struct GpuEnvironment {
    pub(crate) radiance: Arc<Radiance>,
    pub(crate) prefiltered: Arc<Prefiltered>,
    pub(crate) sheen: Arc<Image>,
    pub(crate) sampler: Arc<Sampler>,
    /// How long the bake took.
    pub report: BakeReport,
}

/// The part of an environment that depends on its map alone; images in [`Use::Sampled`](crate::gpu::Use::Sampled).
pub(crate) struct Radiance {
    pub(crate) cube: Arc<Image>,
    /// Whether `cube` holds the map: see [`GpuEnvironment::without_cube`].
    pub(crate) has_cube: bool,
    /// An octahedral map (ibl/maps/octahedral.glsl).
    pub(crate) irradiance: Arc<Image>,
    /// The images hold radiance times this factor.
    pub(crate) scale: f32,
    /// The suns that irradiance, specular levels and sheen leave out.
    pub(super) suns: Vec<Sun>,
    /// The list of ibl/small_lights/list.glsl. `None` in an environment that is never prefiltered.
    pub(super) small_lights: Option<Arc<Buffer>>,
    /// Fingerprint of the map.
    pub(super) map: u128,
}

/// The levels of the specular lobe, in [`Use::Sampled`](crate::gpu::Use::Sampled).
pub(crate) struct Prefiltered {
    /// Octahedral maps of all levels, side by side (ibl/maps/levels.glsl).
    pub(crate) levels: Arc<Image>,
    /// Whether D or V returned values that are not valid densities. They count as 0.
    pub(super) wrong: bool,
}

impl GpuEnvironment {
    /// The same radiance from every direction, in images of one texel.
    ///
    /// # Errors
    /// Out of memory.
    pub(crate) fn uniform(gpu: &Arc<Gpu>, radiance: [f32; 3]) -> Result<Arc<Self>, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let texel = [radiance[0], radiance[1], radiance[2], 1.0].map(|x| half::f16::from_f32(x).to_bits());
        let image = |name: &str, desc: ImageDesc| {
            let image = Image::new(gpu, name, desc)?;
            let texels = bytemuck::cast_slice(&texel).repeat(desc.layers as usize);
            compute::upload(gpu, &[(&image, &texels)])?;
            Ok::<_, GpuError>(image)
        };
        let (flat, cube) = (ImageDesc::new(1, 1, HALF, usage), ImageDesc::cube(1, 1, HALF, usage));
        let (levels, irradiance) = (image("uniform levels", flat)?, image("uniform irradiance", flat)?);
        let (sheen, cube) = (image("uniform sheen", cube)?, image("uniform cube", cube)?);
        let prefiltered = Arc::new(Prefiltered { levels, wrong: false });
        let (scale, suns, small_lights) = (1.0, Vec::new(), None);
        let radiance = Arc::new(Radiance { cube, has_cube: true, irradiance, scale, suns, small_lights, map: 0 });
        Ok(Arc::new(Self::of(gpu, radiance, prefiltered, sheen)?))
    }

    /// The same light for a frame that does not read the cube map, which is 16 MiB. That of `other` takes its place.
    pub(crate) fn without_cube(&self, other: &Self) -> Self {
        let Radiance { irradiance, scale, suns, small_lights, map, .. } = &*self.radiance;
        let radiance = Radiance {
            cube: other.radiance.cube.clone(),
            has_cube: false,
            irradiance: irradiance.clone(),
            scale: *scale,
            suns: suns.clone(),
            small_lights: small_lights.clone(),
            map: *map,
        };
        Self {
            radiance: Arc::new(radiance),
            prefiltered: self.prefiltered.clone(),
            sheen: self.sheen.clone(),
            sampler: self.sampler.clone(),
            report: self.report.clone(),
        }
    }

    pub(super) fn of(
        gpu: &Arc<Gpu>,
        radiance: Arc<Radiance>,
        prefiltered: Arc<Prefiltered>,
        sheen: Arc<Image>,
    ) -> Result<Self, GpuError> {
        let sampler = compute::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        Ok(Self { radiance, prefiltered, sheen, sampler, report: BakeReport::default() })
    }

    /// Number of suns that the images leave out and that lighting must add.
    pub fn sun_count(&self) -> u32 {
        self.radiance.suns.len().min(MAX_SUNS) as u32
    }

    /// The factor from radiance to the values of the images, and the suns that the images leave out.
    pub(crate) fn scale_and_suns(&self) -> (f32, &[Sun]) {
        (self.radiance.scale, &self.radiance.suns)
    }

    /// The functions whose return values are not valid densities. They count as 0 in this light.
    pub fn wrong(&self) -> Option<&'static str> {
        self.prefiltered.wrong.then_some("D or V in brdf/ndf.glsl or brdf/visibility.glsl")
    }
}

/// The time of each part of a bake, in milliseconds of wall time.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct BakeReport {
    /// Name of the environment.
    pub environment: String,
    /// Whether the result came from the disk cache.
    pub cached: bool,
    /// Looking into the cache, then decoding the file or computing the built-in map.
    pub decode_ms: f64,
    /// Creating the compute pipelines, in parallel with decoding.
    pub pipeline_ms: f64,
    /// Copying the map, or the cached result, to the device.
    pub upload_ms: f64,
    /// Resampling the map to a cube map and its mip levels.
    pub cube_ms: f64,
    /// Integrating irradiance.
    pub irradiance_ms: f64,
    /// GGX prefilter of all levels.
    pub prefilter_ms: f64,
    /// Sheen prefilter of all levels.
    pub sheen_ms: f64,
    /// From the file to the last pass, excluding the cache write.
    pub total_ms: f64,
    /// Sentences about the file, such as a number of negative texels. A file that has some is not cached, so that they are told again.
    #[serde(skip)]
    pub warnings: Vec<String>,
}
