//! Bakes an environment map into the images that image-based lighting reads. Any thread may bake; each pass is a submission
//! of its own, so that frames run in between.

use std::sync::Arc;
use std::time::Instant;

use crate::cancel::wait_unless;
use crate::disk_cache;
use crate::gpu::{Buffer, Gpu, GpuError, Image, ImageDesc, Memory, Sampler, Use, fault, one_shot, vk};
use crate::scene::{EnvironmentError, EnvironmentFile};

use crate::render::compute;
use crate::render::environment::passes::{IRRADIANCE_LEVEL, Lobes, Passes, Target, small_lights, small_lights_size};
use crate::render::pipeline::PipelineSet;
use crate::render::state::{BakeStage, EnvironmentKey};

pub(crate) const CUBE: &str = "ibl/cube.comp";
pub(crate) const DOWNSAMPLE: &str = "ibl/downsample.comp";
pub(crate) const IRRADIANCE: &str = "ibl/irradiance.comp";
pub(crate) const PREFILTER: &str = "ibl/prefilter.comp";
const PREFILTER_SHEEN: &str = "ibl/prefilter_sheen.comp";
pub(crate) const LOBE: &str = "ibl/lobe.comp";
/// The stages of each part of a bake. If one of them changes, the part is baked again.
pub(crate) const RADIANCE_STAGES: [&str; 3] = [CUBE, DOWNSAMPLE, IRRADIANCE];
pub(crate) const PREFILTER_STAGES: [&str; 2] = [LOBE, PREFILTER];
pub(crate) const SHEEN_STAGES: [&str; 1] = [PREFILTER_SHEEN];

const CUBE_SIDE: u32 = 512;
const CUBE_LEVELS: u32 = 10;
const PREFILTERED_SIDE: u32 = 256;
/// Mip levels of the even levels of ibl/levels.glsl; the odd ones have one less.
const PREFILTERED_LEVELS: u32 = 6;
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

/// Samples per texel of each mip level. Rougher lobes need more samples and have fewer texels.
const PREFILTER_SAMPLES: [u32; PREFILTERED_LEVELS as usize] = [1, 64, 128, 256, 512, 512];

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
    /// From the file to the last pass, without writing the cache.
    pub total_ms: f64,
}

/// An environment on the device; all images in [`Use::Sampled`].
pub struct GpuEnvironment {
    pub(crate) radiance: Arc<Radiance>,
    pub(crate) prefiltered: Arc<Prefiltered>,
    pub(crate) sheen: Arc<Image>,
    pub(crate) sampler: Arc<Sampler>,
    /// How long the bake took.
    pub report: BakeReport,
}

/// The part of an environment that depends on its map alone; images in [`Use::Sampled`].
pub(crate) struct Radiance {
    pub(crate) cube: Arc<Image>,
    pub(crate) irradiance: Arc<Image>,
    /// The images hold radiance times this factor.
    pub(crate) scale: f32,
    /// The list of ibl/small_lights.glsl. `None` in an environment that is never prefiltered.
    small_lights: Option<Arc<Buffer>>,
    /// Fingerprint of the map.
    map: u128,
}

/// The levels of the specular lobe (ibl/levels.glsl), in [`Use::Sampled`].
pub(crate) struct Prefiltered {
    pub(crate) even: Arc<Image>,
    pub(crate) odd: Arc<Image>,
    /// Whether D or V returned values that are no densities. They count as 0.
    wrong: bool,
}

/// Callbacks and options of a bake.
pub struct BakeControl<'a> {
    /// Receives the fraction that is done, 0..1, and the name of the next pass.
    pub progress: &'a (dyn Fn(f32, &str) + Sync),
    /// Returns whether to cancel. Called while a file is read and decoded, and before each pass.
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
        let texel = [radiance[0], radiance[1], radiance[2], 1.0].map(|x| half::f16::from_f32(x).to_bits());
        let texels = bytemuck::cast_slice(&texel).repeat(6);
        let cube = |name: &str| {
            let image = Image::new(gpu, name, ImageDesc::cube(1, 1, HALF, usage))?;
            compute::upload(gpu, &[(&image, &texels)])?;
            Ok::<_, GpuError>(image)
        };
        let (even, odd) = (cube("uniform even levels")?, cube("uniform odd levels")?);
        let (sheen, irradiance, cube) = (cube("uniform sheen")?, cube("uniform irradiance")?, cube("uniform cube")?);
        let prefiltered = Arc::new(Prefiltered { even, odd, wrong: false });
        let radiance = Arc::new(Radiance { cube, irradiance, scale: 1.0, small_lights: None, map: 0 });
        Ok(Arc::new(Self::of(gpu, radiance, prefiltered, sheen)?))
    }

    fn of(
        gpu: &Arc<Gpu>,
        radiance: Arc<Radiance>,
        prefiltered: Arc<Prefiltered>,
        sheen: Arc<Image>,
    ) -> Result<Self, GpuError> {
        let sampler = compute::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        Ok(Self { radiance, prefiltered, sheen, sampler, report: BakeReport::default() })
    }

    /// The functions that returned values which are no densities, and count as 0 in this light.
    pub fn wrong(&self) -> Option<&'static str> {
        self.prefiltered.wrong.then_some("D or V in brdf/ndf.glsl or brdf/visibility.glsl")
    }

    /// Bakes the environment of `key`, built-in or a file, with the stages of `set`. A part is taken from `before` if its stages
    /// and its map are the same, else from the disk cache; else it is computed. Any thread may call this.
    ///
    /// # Errors
    /// A bad map, a device error, or `control` has canceled the bake.
    pub fn bake(
        set: &PipelineSet,
        key: &EnvironmentKey,
        before: Option<&(EnvironmentKey, Arc<Self>)>,
        control: &BakeControl<'_>,
    ) -> Result<Arc<Self>, BakeError> {
        let start = Instant::now();
        let report = BakeReport { environment: key.name.clone(), cached: true, ..BakeReport::default() };
        let mut bake = Bake { gpu: &set.gpu, set, key, control, report, storing_ms: 0.0 };
        let before = before.filter(|(old, _)| old.has_radiance_of(key));
        let radiance = match before {
            Some((_, old)) => {
                bake.report.environment.clone_from(&old.report.environment);
                old.radiance.clone()
            }
            None => bake.radiance()?,
        };
        let prefiltered = match before.filter(|(old, made)| old.prefilter == key.prefilter && made.wrong().is_none()) {
            Some((_, old)) => old.prefiltered.clone(),
            None => bake.prefiltered(&radiance)?,
        };
        let sheen = match before.filter(|(old, _)| old.sheen == key.sheen) {
            Some((_, old)) => old.sheen.clone(),
            None => bake.sheen(&radiance)?,
        };
        (control.progress)(1.0, "");
        let mut this = Self::of(&set.gpu, radiance, prefiltered, sheen)?;
        this.report = bake.report;
        this.report.total_ms = ms(start) - bake.storing_ms;
        Ok(Arc::new(this))
    }
}

/// A running bake.
struct Bake<'a> {
    gpu: &'a Arc<Gpu>,
    set: &'a PipelineSet,
    key: &'a EnvironmentKey,
    control: &'a BakeControl<'a>,
    report: BakeReport,
    /// Time of reading back and writing to the disk, milliseconds.
    storing_ms: f64,
}

impl Bake<'_> {
    /// Begins a pass. Returns its start.
    fn begin(&self, done: f32, next: &str) -> Result<Instant, BakeError> {
        (self.control.progress)(done, next);
        tracing::debug!("bake: {next}");
        if (self.control.superseded)() { Err(BakeError::Superseded) } else { Ok(Instant::now()) }
    }

    fn passes<'a>(&'a self, small_lights: &'a Arc<Buffer>) -> Passes<'a> {
        Passes { gpu: self.gpu, layouts: &self.set.layouts, set: self.set, small_lights }
    }

    /// Creates the pipelines of a part, which counts as a time of its own.
    fn pipelines(&mut self, stages: &[BakeStage]) -> Result<(), BakeError> {
        let time = Instant::now();
        for stage in stages {
            self.set.compute(stage.stage.path.as_str(), &stage.constants)?;
        }
        self.report.pipeline_ms += ms(time);
        self.report.cached = false;
        Ok(())
    }

    fn cached(&self, key: &str, bytes: u64) -> Option<Vec<u8>> {
        disk_cache::load(key, bytes).filter(|_| self.control.from_disk)
    }

    fn image(&self, name: &str, side: u32, levels: u32) -> Result<Arc<Image>, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        Image::new(self.gpu, name, ImageDesc::cube(side, levels, HALF, usage))
    }

    /// Uploads the images one after the other.
    fn fill(&mut self, images: &[&Arc<Image>], bytes: &[u8]) -> Result<(), GpuError> {
        let time = Instant::now();
        let mut rest = bytes;
        let mut parts = Vec::new();
        for image in images {
            let (own, others) = rest.split_at(image.desc().bytes() as usize);
            parts.push((*image, own));
            rest = others;
        }
        compute::upload(self.gpu, &parts)?;
        self.report.upload_ms += ms(time);
        Ok(())
    }

    /// Reads back the images one after the other, then the buffer.
    fn read(&self, images: &[&Arc<Image>], buffer: Option<&Arc<Buffer>>) -> Result<Vec<u8>, GpuError> {
        let size = |image: &&Arc<Image>| image.desc().bytes();
        let bytes = images.iter().map(size).sum::<u64>() + buffer.map_or(0, |buffer| buffer.size());
        let out = Buffer::new(self.gpu, "baked", bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
        one_shot(self.gpu, |encoder| {
            let mut at = 0;
            for image in images {
                encoder.transition(image, Use::Sampled, Use::CopyFrom);
                encoder.copy_levels_from_image(image, &out, at);
                encoder.transition(image, Use::CopyFrom, Use::Sampled);
                at += size(image);
            }
            if let Some(buffer) = buffer {
                encoder.copy_buffer(buffer, 0, &out, at, buffer.size());
            }
            encoder.copies_done();
            Ok(())
        })?;
        Ok(out.read())
    }

    /// The cube map, the irradiance and the small lights of the map.
    fn radiance(&mut self) -> Result<Arc<Radiance>, BakeError> {
        let time = self.begin(0.0, "reading")?;
        let name = self.key.name.clone();
        let file = wait_unless(self.control.superseded, move || EnvironmentFile::open(&name));
        let file = Arc::new(file.ok_or(BakeError::Superseded)??);
        self.report.environment.clone_from(&file.name);
        let sizes = [CUBE_SIDE, IRRADIANCE_SIDE, IRRADIANCE_LEVEL, LARGEST_RANGE.to_bits()];
        let disk_key = key(&[file.fingerprint], &self.key.radiance, &sizes);
        let cube = self.image("environment", CUBE_SIDE, CUBE_LEVELS)?;
        let irradiance = self.image("irradiance", IRRADIANCE_SIDE, 1)?;
        let images = [&cube, &irradiance];
        let lights = small_lights_size(self.set);
        let bytes: u64 = images.iter().map(|image| image.desc().bytes()).sum();
        // An entry holds the images, the small lights, and the scale.
        if let Some(entry) = self.cached(&disk_key, bytes + lights + 4) {
            self.report.decode_ms = ms(time);
            let (images_part, rest) = entry.split_at(bytes as usize);
            self.fill(&images, images_part)?;
            let (lights, scale) = rest.split_at(rest.len() - 4);
            let small_lights = Some(small_lights(self.gpu, lights)?);
            let scale = bytemuck::pod_read_unaligned(scale);
            return Ok(Arc::new(Radiance { cube, irradiance, scale, small_lights, map: file.fingerprint }));
        }
        let decoded = file.clone();
        let map = wait_unless(self.control.superseded, move || {
            fault::delay("decode-delay-ms");
            decoded.decode()
        });
        let map = map.ok_or(BakeError::Superseded)??;
        self.report.decode_ms = ms(time);
        let most = self.gpu.max_image_size();
        if map.width.max(map.height) > most {
            return Err(BakeError::TooLarge(map.width, map.height, most));
        }
        self.begin(0.05, "pipelines")?;
        self.pipelines(&self.key.radiance.clone())?;

        let time = self.begin(0.1, "upload")?;
        let scale = (LARGEST_HALF / map.peak.max(LARGEST_HALF)).max(1.0 / LARGEST_RANGE);
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc::new(map.width, map.height, vk::Format::R32G32B32A32_SFLOAT, usage);
        let equirect = Image::new(self.gpu, "environment map", desc)?;
        compute::upload(self.gpu, &[(&equirect, bytemuck::cast_slice(&map.pixels))])?;
        drop(map);
        self.report.upload_ms = ms(time);

        let lights = small_lights(self.gpu, &vec![0; lights as usize])?;
        let time = self.begin(0.15, "cube map")?;
        self.passes(&lights).cube(&equirect, &cube, scale)?;
        self.report.cube_ms = ms(time);

        let time = self.begin(0.25, "irradiance")?;
        self.passes(&lights).irradiance(&cube, &irradiance)?;
        self.report.irradiance_ms = ms(time);

        let time = Instant::now();
        let mut entry = self.read(&images, Some(&lights))?;
        entry.extend(f32::to_ne_bytes(scale));
        disk_cache::store(&disk_key, &entry);
        self.storing_ms += ms(time);
        Ok(Arc::new(Radiance { cube, irradiance, scale, small_lights: Some(lights), map: file.fingerprint }))
    }

    /// The levels of the specular lobe.
    fn prefiltered(&mut self, radiance: &Radiance) -> Result<Arc<Prefiltered>, BakeError> {
        let stages = [&*self.key.radiance, &*self.key.prefilter].concat();
        let mut sizes = vec![CUBE_SIDE, PREFILTERED_SIDE];
        sizes.extend(PREFILTER_SAMPLES);
        let disk_key = key(&[radiance.map], &stages, &sizes);
        let even = self.image("even levels", PREFILTERED_SIDE, PREFILTERED_LEVELS)?;
        let odd = self.image("odd levels", PREFILTERED_SIDE / 2, PREFILTERED_LEVELS - 1)?;
        let size = even.desc().bytes() + odd.desc().bytes();
        if let Some(entry) = self.cached(&disk_key, size) {
            self.fill(&[&even, &odd], &entry)?;
            return Ok(Arc::new(Prefiltered { even, odd, wrong: false }));
        }
        let Some(lights) = &radiance.small_lights else { return Err(GpuError::NoStage(CUBE.into()).into()) };
        self.begin(0.3, "pipelines")?;
        self.pipelines(&self.key.prefilter.clone())?;
        let time = self.begin(0.3, "reflections")?;
        let [lobe, prefilter] = &*self.key.prefilter else { return Err(GpuError::NoStage(PREFILTER.into()).into()) };
        let lobes = Lobes::new(self.set, lobe, &PREFILTER_SAMPLES)?;
        self.passes(lights).lobes(lobe, &lobes, &radiance.cube)?;
        // A software device prefilters one level per submission, so that frames run in between. A GPU is fast enough for all.
        let at_once = if self.gpu.info().kind == "cpu" { 1 } else { PREFILTERED_LEVELS };
        for first in (0..PREFILTERED_LEVELS).step_by(at_once as usize) {
            self.begin(0.3 + 0.6 * first as f32 / PREFILTERED_LEVELS as f32, "reflections")?;
            let levels = first..(first + at_once).min(PREFILTERED_LEVELS);
            let to = Target { image: &even, samples: &PREFILTER_SAMPLES, specular: Some((&odd, &lobes.buffer)) };
            self.passes(lights).prefilter(prefilter, &radiance.cube, &to, levels)?;
        }
        self.report.prefilter_ms = ms(time);
        let time = Instant::now();
        let read = self.read(&[&even, &odd], Some(&lobes.buffer))?;
        let (texels, lobe_bytes) = read.split_at(size as usize);
        let wrong = lobes.wrong(lobe_bytes);
        if !wrong {
            disk_cache::store(&disk_key, texels);
        }
        self.storing_ms += ms(time);
        Ok(Arc::new(Prefiltered { even, odd, wrong }))
    }

    /// The levels of the sheen lobe.
    fn sheen(&mut self, radiance: &Radiance) -> Result<Arc<Image>, BakeError> {
        let stages = [&*self.key.radiance, &*self.key.sheen].concat();
        let disk_key = key(&[radiance.map], &stages, &[CUBE_SIDE, SHEEN_SIDE, SHEEN_SAMPLES]);
        let image = self.image("prefiltered sheen", SHEEN_SIDE, SHEEN_LEVELS)?;
        if let Some(entry) = self.cached(&disk_key, image.desc().bytes()) {
            self.fill(&[&image], &entry)?;
            return Ok(image);
        }
        let Some(lights) = &radiance.small_lights else { return Err(GpuError::NoStage(CUBE.into()).into()) };
        self.pipelines(&self.key.sheen.clone())?;
        let time = self.begin(0.9, "sheen")?;
        let [stage] = &*self.key.sheen else { return Err(GpuError::NoStage(PREFILTER_SHEEN.into()).into()) };
        let samples = [SHEEN_SAMPLES; SHEEN_LEVELS as usize];
        let to = Target { image: &image, samples: &samples, specular: None };
        self.passes(lights).prefilter(stage, &radiance.cube, &to, 0..SHEEN_LEVELS)?;
        self.report.sheen_ms = ms(time);
        let time = Instant::now();
        disk_cache::store(&disk_key, &self.read(&[&image], None)?);
        self.storing_ms += ms(time);
        Ok(image)
    }
}

/// The cache key of a part: a hash of the map, of the modules of its stages, and of sizes and sample counts.
fn key(map: &[u128], stages: &[BakeStage], sizes: &[u32]) -> String {
    let modules: Vec<u64> = stages.iter().map(|stage| stage.module).collect();
    disk_cache::key(&[bytemuck::cast_slice(map), bytemuck::cast_slice(&modules), bytemuck::cast_slice(sizes)])
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
