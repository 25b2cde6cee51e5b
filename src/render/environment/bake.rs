//! Bakes an environment map into the images that image-based lighting reads. Any thread may bake; each pass is a submission
//! of its own, so that frames run in between.

use std::sync::Arc;
use std::time::Instant;

use crate::disk_cache;
use crate::gpu::{Buffer, Gpu, GpuError, Image, ImageDesc, Memory, Sampler, Use, one_shot, vk};
use crate::scene::{Environment, EnvironmentError, EnvironmentFile};

use crate::render::compute;
use crate::render::environment::passes::{IRRADIANCE_LEVEL, Passes, no_results};
use crate::render::pipeline::PipelineSet;

pub(crate) const CUBE: &str = "ibl/cube.comp";
pub(crate) const DOWNSAMPLE: &str = "ibl/downsample.comp";
pub(crate) const IRRADIANCE: &str = "ibl/irradiance.comp";
const PREFILTER: &str = "ibl/prefilter.comp";
const PREFILTER_SHEEN: &str = "ibl/prefilter_sheen.comp";
/// The stages of a bake. If one of them changes, the environment is baked again.
pub const BAKE_STAGES: [&str; 5] = [CUBE, DOWNSAMPLE, IRRADIANCE, PREFILTER, PREFILTER_SHEEN];

const CUBE_SIDE: u32 = 512;
const CUBE_LEVELS: u32 = 10;
const PREFILTERED_SIDE: u32 = 256;
const PREFILTERED_LEVELS: u32 = 9;
const SHEEN_SIDE: u32 = 32;
const SHEEN_LEVELS: u32 = 6;
const SHEEN_SAMPLES: u32 = 256;
/// 32 texels are enough: irradiance varies as slowly as the cosine, except for a kink where a sun sets.
const IRRADIANCE_SIDE: u32 = 32;
const HALF: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
/// Largest half float.
pub(crate) const LARGEST_HALF: f32 = 65504.0;
/// A map is scaled down at most by this factor to fit half floats, and clipped beyond: more would lose its dark parts.
const LARGEST_RANGE: f32 = 4096.0;

/// Samples per texel of each prefiltered level. Rougher levels need more samples and have fewer texels.
const PREFILTER_SAMPLES: [u32; PREFILTERED_LEVELS as usize] = [1, 64, 128, 256, 512, 512, 512, 512, 512];

/// Why a bake failed.
#[derive(Debug, thiserror::Error)]
pub enum BakeError {
    /// The map is missing or bad.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The map exceeds the device's image size.
    #[error("{0}x{1} pixels are too many: this device has images of at most {2} a side")]
    TooLarge(u32, u32, u32),
    /// The caller has canceled the bake for a newer one.
    #[error("a newer environment or shader came first")]
    Superseded,
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
    /// Creating the compute pipelines.
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
    /// From the opened file to the last pass, without writing the cache.
    pub total_ms: f64,
}

/// An environment on the device; all images in [`Use::Sampled`].
pub struct GpuEnvironment {
    pub(crate) cube: Arc<Image>,
    pub(crate) prefiltered: Arc<Image>,
    pub(crate) sheen: Arc<Image>,
    pub(crate) irradiance: Arc<Image>,
    pub(crate) sampler: Arc<Sampler>,
    /// The images hold radiance times this factor.
    pub(crate) scale: f32,
    /// How long the bake took.
    pub report: BakeReport,
}

/// Callbacks and options of a bake.
pub struct BakeControl<'a> {
    /// Receives the fraction that is done, 0..1, and the name of the next pass.
    pub progress: &'a (dyn Fn(f32, &str) + Sync),
    /// Returns whether to cancel. Called before each pass.
    pub superseded: &'a (dyn Fn() -> bool + Sync),
    /// Whether a cached result may be used. Otherwise the bake replaces it.
    pub from_disk: bool,
}

impl GpuEnvironment {
    /// The same radiance from every direction, in images of one texel.
    ///
    /// # Errors
    /// Out of memory.
    pub(crate) fn uniform(gpu: &Arc<Gpu>, radiance: [f32; 3]) -> Result<Arc<Self>, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let cube = |name: &str| Image::new(gpu, name, ImageDesc::cube(1, 1, HALF, usage));
        let names = ["uniform cube", "uniform prefiltered", "uniform sheen", "uniform irradiance"];
        let [a, b, c, d] = names.map(cube);
        let this = Self::with(gpu, [a?, b?, c?, d?])?;
        let texel = [radiance[0], radiance[1], radiance[2], 1.0].map(half::f16::from_f32);
        let texels = this.bytes() as usize / size_of_val(&texel);
        this.fill(gpu, &bytemuck::cast_slice(&texel.map(half::f16::to_bits)).repeat(texels))?;
        Ok(Arc::new(this))
    }

    fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let cube = |name: &str, side, levels| Image::new(gpu, name, ImageDesc::cube(side, levels, HALF, usage));
        let images = [
            cube("environment", CUBE_SIDE, CUBE_LEVELS)?,
            cube("prefiltered", PREFILTERED_SIDE, PREFILTERED_LEVELS)?,
            cube("prefiltered sheen", SHEEN_SIDE, SHEEN_LEVELS)?,
            cube("irradiance", IRRADIANCE_SIDE, 1)?,
        ];
        Self::with(gpu, images)
    }

    fn with(gpu: &Arc<Gpu>, [cube, prefiltered, sheen, irradiance]: [Arc<Image>; 4]) -> Result<Self, GpuError> {
        let sampler = compute::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        Ok(Self { cube, prefiltered, sheen, irradiance, sampler, scale: 1.0, report: BakeReport::default() })
    }

    fn images(&self) -> [&Arc<Image>; 4] {
        [&self.cube, &self.prefiltered, &self.sheen, &self.irradiance]
    }

    /// Bytes of all images.
    fn bytes(&self) -> u64 {
        self.images().iter().map(|image| image.desc().bytes()).sum()
    }

    /// Uploads all images, in the order of [`Self::read`].
    fn fill(&self, gpu: &Arc<Gpu>, bytes: &[u8]) -> Result<(), GpuError> {
        let mut rest = bytes;
        let mut images = Vec::new();
        for image in self.images() {
            let (own, others) = rest.split_at(image.desc().bytes() as usize);
            images.push((image, own));
            rest = others;
        }
        compute::upload(gpu, &images)
    }

    /// Reads all images back.
    fn read(&self, gpu: &Arc<Gpu>) -> Result<Vec<u8>, GpuError> {
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let out = Buffer::new(gpu, "baked", self.bytes(), usage, Memory::Readback)?;
        one_shot(gpu, |encoder| {
            let mut at = 0;
            for image in self.images() {
                encoder.transition(image, Use::Sampled, Use::CopyFrom);
                encoder.copy_levels_from_image(image, &out, at);
                encoder.transition(image, Use::CopyFrom, Use::Sampled);
                at += image.desc().bytes();
            }
            encoder.copies_done();
            Ok(())
        })?;
        Ok(out.read())
    }

    /// Bakes an environment, built-in or a file, with the stages of `set`, or loads the result from the disk cache. Any thread
    /// may call this.
    ///
    /// # Errors
    /// A bad map, a device error, or `control` has canceled the bake.
    pub fn bake(set: &PipelineSet, name: &str, control: &BakeControl<'_>) -> Result<Arc<Self>, BakeError> {
        let file = &EnvironmentFile::open(name)?;
        let start = Instant::now();
        let gpu = &set.gpu;
        let mut this = Self::new(gpu)?;
        this.report.environment.clone_from(&file.name);
        let key = key(set, file)?;
        // An entry holds the images, then the scale.
        if let Some(bytes) = disk_cache::load(&key, this.bytes() + 4).filter(|_| control.from_disk) {
            let upload = Instant::now();
            let (images, scale) = bytes.split_at(bytes.len() - 4);
            this.fill(gpu, images)?;
            this.scale = bytemuck::pod_read_unaligned(scale);
            this.report.cached = true;
            this.report.upload_ms = ms(upload);
            this.report.total_ms = ms(start);
            return Ok(Arc::new(this));
        }
        (control.progress)(0.0, "reading");
        let map = file.decode()?;
        this.report.decode_ms = ms(start);
        this.run(set, &map, control)?;
        this.report.total_ms = ms(start);
        let mut bytes = this.read(gpu)?;
        bytes.extend(this.scale.to_ne_bytes());
        disk_cache::store(&key, &bytes);
        Ok(Arc::new(this))
    }

    /// All passes, each a submission of its own.
    fn run(&mut self, set: &PipelineSet, map: &Environment, control: &BakeControl<'_>) -> Result<(), BakeError> {
        let (gpu, layouts) = (&set.gpu, &set.layouts);
        let begin = |done: f32, next: &str| -> Result<Instant, BakeError> {
            (control.progress)(done, next);
            tracing::debug!("bake: {next}");
            if (control.superseded)() { Err(BakeError::Superseded) } else { Ok(Instant::now()) }
        };
        let most = gpu.max_image_size();
        if map.width.max(map.height) > most {
            return Err(BakeError::TooLarge(map.width, map.height, most));
        }
        let time = begin(0.05, "pipelines")?;
        let results = no_results(gpu, set)?;
        let passes = Passes { gpu, layouts, set, results: &results };
        for stage in BAKE_STAGES {
            set.compute(stage, &Vec::new())?;
        }
        self.report.pipeline_ms = ms(time);

        let time = begin(0.1, "upload")?;
        self.scale = (LARGEST_HALF / map.peak.max(LARGEST_HALF)).max(1.0 / LARGEST_RANGE);
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc::new(map.width, map.height, vk::Format::R32G32B32A32_SFLOAT, usage);
        let equirect = Image::new(gpu, "environment map", desc)?;
        compute::upload(gpu, &[(&equirect, bytemuck::cast_slice(&map.pixels))])?;
        self.report.upload_ms = ms(time);

        let time = begin(0.15, "cube map")?;
        passes.cube(&equirect, &self.cube, self.scale)?;
        self.report.cube_ms = ms(time);

        let time = begin(0.25, "irradiance")?;
        passes.irradiance(&self.cube, &self.irradiance)?;
        self.report.irradiance_ms = ms(time);

        // A software device prefilters one level per submission, so that frames run in between. A GPU is fast enough for all.
        let at_once = if gpu.info().kind == "cpu" { 1 } else { PREFILTERED_LEVELS };
        let source = (&self.cube, &self.sampler);
        for first in (0..PREFILTERED_LEVELS).step_by(at_once as usize) {
            let time = begin(0.3 + 0.6 * first as f32 / PREFILTERED_LEVELS as f32, "reflections")?;
            let levels = first..(first + at_once).min(PREFILTERED_LEVELS);
            passes.prefilter(PREFILTER, source, &self.prefiltered, levels, &PREFILTER_SAMPLES)?;
            self.report.prefilter_ms += ms(time);
        }
        let time = begin(0.9, "sheen")?;
        let samples = [SHEEN_SAMPLES; SHEEN_LEVELS as usize];
        passes.prefilter(PREFILTER_SHEEN, source, &self.sheen, 0..SHEEN_LEVELS, &samples)?;
        self.report.sheen_ms = ms(time);
        (control.progress)(1.0, "");
        Ok(())
    }
}

/// The cache key: a hash of the map, of all sizes and sample counts, and of the SPIR-V of the bake stages.
fn key(set: &PipelineSet, file: &EnvironmentFile) -> Result<String, GpuError> {
    let numbers = [
        CUBE_SIDE,
        PREFILTERED_SIDE,
        SHEEN_SIDE,
        SHEEN_SAMPLES,
        IRRADIANCE_SIDE,
        IRRADIANCE_LEVEL,
        LARGEST_RANGE.to_bits(),
    ];
    let fingerprint = file.fingerprint.to_le_bytes();
    let mut parts: Vec<&[u8]> = vec![&fingerprint, bytemuck::cast_slice(&numbers)];
    parts.push(bytemuck::cast_slice(&PREFILTER_SAMPLES));
    for stage in BAKE_STAGES {
        parts.push(bytemuck::cast_slice(set.spirv(stage)?));
    }
    Ok(disk_cache::key(&parts))
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
