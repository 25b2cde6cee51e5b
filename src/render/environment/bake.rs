//! Bakes an environment map into the images of `maps.rs`. Any thread may bake; each pass is a submission of its own, so that
//! frames run in between.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use crate::cancel::{GivenUp, Running};
use crate::disk_cache;
use crate::frame::stages::{CUBE, PREFILTER, PREFILTER_SHEEN};
use crate::frame::{BakeStage, EnvironmentKey, LARGEST_HALF};
use crate::gpu::{Buffer, DescriptorSet, Gpu, GpuError, Image, ImageDesc, Memory, fault, vk};
use crate::interface::{IRRADIANCE_SIDE, SPECULAR_HEIGHT, SPECULAR_LEVELS, SPECULAR_WIDTH};
use crate::pipeline::PipelineSet;
use crate::scene::environment::{MODEL, restore_clipped};
use crate::scene::{EnvironmentError, EnvironmentFile};

use crate::render::compute;
use crate::render::environment::maps::{BakeReport, GpuEnvironment, HALF, Prefiltered, Radiance, SHARED_EXPONENT};
use crate::render::environment::passes::{
    IRRADIANCE_LEVEL, Lobes, Passes, set_suns, small_lights, small_lights_size, suns_of,
};
use crate::render::environment::transfer;

/// Decoders of maps that have been superseded. A large map takes gigabytes, however often its file is saved.
static DECODERS: GivenUp = GivenUp::none();

const CUBE_SIDE: u32 = 512;
const CUBE_LEVELS: u32 = 10;
const SHEEN_SIDE: u32 = 32;
const SHEEN_LEVELS: u32 = 6;
const SHEEN_SAMPLES: u32 = 256;
/// Largest factor by which a map is scaled down to fit half floats; what is brighter is clipped. Scaling further would lose the
/// dark parts.
const LARGEST_RANGE: f32 = 4096.0;

/// Width and height of the image of all specular levels.
const SPECULAR_SIZE: [u32; 2] = [SPECULAR_WIDTH, SPECULAR_HEIGHT];
/// Samples per texel of the mirror and of each pair of levels that share samples. Rougher lobes need more samples but have fewer
/// texels.
const SPECULAR_SAMPLES: [u32; SPECULAR_LEVELS as usize / 2 + 1] = [1, 20, 56, 104, 136, 168, 208, 288, 400];

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
    /// Bakes the environment of `key`, built-in or a file, with the stages of `set`. A part comes from `before` if its stages and
    /// its map are unchanged, otherwise from the disk cache, and otherwise it is computed. Any thread may call this.
    ///
    /// # Errors
    /// A bad map, a device error, or `control` has canceled the bake.
    pub fn bake(
        set: &PipelineSet,
        key: &EnvironmentKey,
        before: Option<&(Arc<EnvironmentKey>, Arc<Self>)>,
        control: &BakeControl<'_>,
    ) -> Result<Arc<Self>, BakeError> {
        let start = Instant::now();
        key.resolve();
        let before = before.filter(|(_, made)| made.radiance.has_cube);
        if let Some((_, same)) = before.filter(|(old, _)| **old == *key) {
            return Ok(same.clone());
        }
        let report = BakeReport { environment: key.name.clone(), cached: true, ..BakeReport::default() };
        let frame = compute::frame_set(&set.gpu, &set.layouts, key.params())?;
        let mut bake = Bake { gpu: &set.gpu, set, key, frame, control, report, storing_ms: 0.0 };
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
    /// Descriptor set 0 of all passes.
    frame: Arc<DescriptorSet>,
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
        let radiance = &self.key.radiance;
        Passes { gpu: self.gpu, layouts: &self.set.layouts, set: self.set, radiance, frame: &self.frame, small_lights }
    }

    /// Creates the pipelines of these stages, and times this as a step of its own.
    fn pipelines(&mut self, stages: &[BakeStage]) -> Result<(), BakeError> {
        let time = Instant::now();
        let create = |stage: &BakeStage| self.set.compute(stage.stage.path.as_str(), &stage.constants).map(drop);
        stages.par_iter().try_for_each(create)?;
        self.report.pipeline_ms += ms(time);
        self.report.cached = false;
        Ok(())
    }

    /// A part in the disk cache. Without a key, the part is not cached.
    fn cached(&self, key: Option<&String>, bytes: u64) -> Option<Vec<u8>> {
        disk_cache::load(key?, bytes).filter(|_| self.control.from_disk)
    }

    /// Uploads a cached part.
    fn fill(&mut self, images: &[&Arc<Image>], bytes: &[u8]) -> Result<(), GpuError> {
        let time = Instant::now();
        transfer::fill(self.gpu, images, bytes)?;
        self.report.upload_ms += ms(time);
        Ok(())
    }

    /// A cube map that a pass writes.
    fn cube(&self, name: &str, side: u32, levels: u32) -> Result<Arc<Image>, GpuError> {
        Image::new(self.gpu, name, ImageDesc::cube(side, levels, HALF, written()))
    }

    /// An image of octahedral maps.
    fn octahedral(&self, name: &str, size: [u32; 2]) -> Result<Arc<Image>, GpuError> {
        Image::new(self.gpu, name, octahedral(size))
    }

    /// The buffer to which a pass writes the texels of such an image, since shaders cannot write its format.
    fn texels(&self, image: &Image) -> Result<Arc<Buffer>, GpuError> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        Buffer::new(self.gpu, "texels", image.desc().bytes(), usage, Memory::Device)
    }

    /// The cache's key of the specular levels of a map.
    fn prefiltered_key(&self, map: u128) -> Option<String> {
        let stages = [&*self.key.radiance, &*self.key.prefilter].concat();
        let mut sizes = vec![CUBE_SIDE, SPECULAR_WIDTH, SPECULAR_HEIGHT, self.key.suns.into()];
        sizes.extend(SPECULAR_SAMPLES);
        key(&[map], &stages, &sizes)
    }

    /// The cache's key of the sheen levels of a map.
    fn sheen_key(&self, map: u128) -> Option<String> {
        let stages = [&*self.key.radiance, &*self.key.sheen].concat();
        key(&[map], &stages, &[CUBE_SIDE, SHEEN_SIDE, SHEEN_SAMPLES, self.key.suns.into()])
    }

    /// The stages of all parts that must be computed for a map whose radiance is not in the cache.
    fn stages_to_run(&self, map: u128) -> Vec<BakeStage> {
        let is_cached = |key: Option<String>, desc: ImageDesc| {
            self.control.from_disk && key.is_some_and(|key| disk_cache::contains(&key, desc.bytes()))
        };
        let mut stages = self.key.radiance.clone();
        if !is_cached(self.prefiltered_key(map), octahedral(SPECULAR_SIZE)) {
            stages.extend_from_slice(&self.key.prefilter);
        }
        if !is_cached(self.sheen_key(map), ImageDesc::cube(SHEEN_SIDE, SHEEN_LEVELS, HALF, written())) {
            stages.extend_from_slice(&self.key.sheen);
        }
        stages
    }

    /// The cube map, the irradiance and the small lights of the map.
    fn radiance(&mut self) -> Result<Arc<Radiance>, BakeError> {
        let time = self.begin(0.0, "reading")?;
        let (name, of_model) = (self.key.name.clone(), self.key.of_model.clone());
        let open =
            move || if name == MODEL { EnvironmentFile::of_model(of_model) } else { EnvironmentFile::open(&name) };
        let file = Running::start(open).wait_unless(self.control.superseded);
        let file = Arc::new(file.ok_or(BakeError::Superseded)??);
        self.report.environment.clone_from(&file.name);
        let sizes = [CUBE_SIDE, IRRADIANCE_SIDE, IRRADIANCE_LEVEL, LARGEST_RANGE.to_bits(), self.key.suns.into()];
        let disk_key = key(&[file.fingerprint], &self.key.radiance, &sizes);
        let cube = self.cube("environment", CUBE_SIDE, CUBE_LEVELS)?;
        let irradiance = self.octahedral("irradiance", [IRRADIANCE_SIDE; 2])?;
        let images = [&cube, &irradiance];
        let lights = small_lights_size(self.set);
        let bytes: u64 = images.iter().map(|image| image.desc().bytes()).sum();
        // An entry holds the images, the small lights with the suns, and the scale.
        if let Some(entry) = self.cached(disk_key.as_ref(), bytes + lights + 4) {
            self.report.decode_ms = ms(time);
            let (images_part, rest) = entry.split_at(bytes as usize);
            self.fill(&images, images_part)?;
            let (lights, scale) = rest.split_at(rest.len() - 4);
            let (suns, small_lights) = (suns_of(lights), Some(small_lights(self.gpu, lights)?));
            let (scale, map) = (bytemuck::pod_read_unaligned(scale), file.fingerprint);
            return Ok(Arc::new(Radiance { cube, has_cube: true, irradiance, scale, suns, small_lights, map }));
        }
        self.report.decode_ms = ms(time);
        // The pipelines are created while another thread decodes.
        let decoded = file.clone();
        let decoding = DECODERS.start(self.control.superseded, move || {
            let time = Instant::now();
            fault::delay("decode-delay-ms");
            (decoded.decode(), ms(time))
        });
        let decoding = decoding.ok_or(BakeError::Superseded)?;
        self.begin(0.05, "pipelines")?;
        self.pipelines(&self.stages_to_run(file.fingerprint))?;
        self.begin(0.05, "decoding")?;
        let (map, decode_ms) = decoding.wait_unless(self.control.superseded).ok_or(BakeError::Superseded)?;
        let map = map?;
        self.report.decode_ms += decode_ms;
        self.report.warnings.clone_from(&map.warnings);
        let most = self.gpu.max_image_size();
        if map.width.max(map.height) > most {
            return Err(BakeError::TooLarge(map.width, map.height, most));
        }

        let time = self.begin(0.1, "upload")?;
        let scale = (LARGEST_HALF / map.peak.max(LARGEST_HALF)).max(1.0 / LARGEST_RANGE);
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc::new(map.width, map.height, vk::Format::R32G32B32A32_SFLOAT, usage);
        let equirect = Image::new(self.gpu, "environment map", desc)?;
        compute::upload(self.gpu, &[(&equirect, bytemuck::cast_slice(&map.pixels))])?;
        self.report.upload_ms = ms(time);

        let lights = small_lights(self.gpu, &vec![0; lights as usize])?;
        let time = self.begin(0.15, "cube map")?;
        self.passes(&lights).cube(&equirect, &cube, scale, self.key.suns)?;
        self.report.cube_ms = ms(time);

        let time = self.begin(0.25, "irradiance")?;
        let texels = self.texels(&irradiance)?;
        self.passes(&lights).irradiance(&cube, &texels, &irradiance)?;
        self.report.irradiance_ms = ms(time);

        let time = Instant::now();
        let buffers = [(&texels, texels.size()), (&lights, lights.size())];
        let mut entry = transfer::read(self.gpu, &[&cube], &buffers)?;
        let mut suns = suns_of(&entry[bytes as usize..]);
        restore_clipped(&mut suns, &map, scale, LARGEST_HALF);
        set_suns(&mut entry[bytes as usize..], &suns);
        entry.extend(f32::to_ne_bytes(scale));
        if let Some(key) = disk_key.filter(|_| map.warnings.is_empty()) {
            disk_cache::store(&key, &entry);
        }
        self.storing_ms += ms(time);
        let (small_lights, map) = (Some(lights), file.fingerprint);
        Ok(Arc::new(Radiance { cube, has_cube: true, irradiance, scale, suns, small_lights, map }))
    }

    /// The levels of the specular lobe.
    fn prefiltered(&mut self, radiance: &Radiance) -> Result<Arc<Prefiltered>, BakeError> {
        let disk_key = self.prefiltered_key(radiance.map);
        let levels = self.octahedral("specular levels", SPECULAR_SIZE)?;
        if let Some(entry) = self.cached(disk_key.as_ref(), levels.desc().bytes()) {
            self.fill(&[&levels], &entry)?;
            return Ok(Arc::new(Prefiltered { levels, wrong: false }));
        }
        let Some(lights) = &radiance.small_lights else { return Err(GpuError::NoStage(CUBE.into()).into()) };
        self.begin(0.3, "pipelines")?;
        self.pipelines(&self.key.prefilter.clone())?;
        let time = self.begin(0.3, "reflections")?;
        let [lobe, prefilter] = &*self.key.prefilter else { return Err(GpuError::NoStage(PREFILTER.into()).into()) };
        let lobes = Lobes::new(self.set, lobe, &SPECULAR_SAMPLES)?;
        let texels = self.texels(&levels)?;
        self.passes(lights).lobes(lobe, &lobes, &radiance.cube)?;
        // A software device prefilters one pair per submission, so that frames run in between. A GPU is fast enough for all.
        let count = SPECULAR_SAMPLES.len();
        let at_once = if self.gpu.info().kind == "cpu" { 1 } else { count };
        for first in (0..count).step_by(at_once) {
            self.begin(0.3 + 0.6 * first as f32 / count as f32, "reflections")?;
            let part = first as u32..(first + at_once).min(count) as u32;
            self.passes(lights).specular(prefilter, &radiance.cube, &lobes, &texels, part)?;
        }
        let wrong = self.passes(lights).finish_specular(&lobes, &texels, &levels)?;
        self.report.prefilter_ms = ms(time);
        let time = Instant::now();
        if let Some(key) = disk_key.filter(|_| !wrong) {
            disk_cache::store(&key, &transfer::read(self.gpu, &[], &[(&texels, texels.size())])?);
        }
        self.storing_ms += ms(time);
        Ok(Arc::new(Prefiltered { levels, wrong }))
    }

    /// The levels of the sheen lobe.
    fn sheen(&mut self, radiance: &Radiance) -> Result<Arc<Image>, BakeError> {
        let disk_key = self.sheen_key(radiance.map);
        let image = self.cube("prefiltered sheen", SHEEN_SIDE, SHEEN_LEVELS)?;
        if let Some(entry) = self.cached(disk_key.as_ref(), image.desc().bytes()) {
            self.fill(&[&image], &entry)?;
            return Ok(image);
        }
        let Some(lights) = &radiance.small_lights else { return Err(GpuError::NoStage(CUBE.into()).into()) };
        self.pipelines(&self.key.sheen.clone())?;
        let time = self.begin(0.9, "sheen")?;
        let [stage] = &*self.key.sheen else { return Err(GpuError::NoStage(PREFILTER_SHEEN.into()).into()) };
        self.passes(lights).sheen(stage, &radiance.cube, &image, SHEEN_SAMPLES)?;
        self.report.sheen_ms = ms(time);
        let time = Instant::now();
        if let Some(key) = disk_key {
            disk_cache::store(&key, &transfer::read(self.gpu, &[&image], &[])?);
        }
        self.storing_ms += ms(time);
        Ok(image)
    }
}

/// The usage of an image that a pass writes, lighting samples, and the cache copies.
fn written() -> vk::ImageUsageFlags {
    use vk::ImageUsageFlags as Usage;
    Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST
}

/// Octahedral maps that lighting samples.
fn octahedral([width, height]: [u32; 2]) -> ImageDesc {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    ImageDesc::new(width, height, SHARED_EXPONENT, usage)
}

/// The cache key of a part: a hash of the map, of the modules of its stages, and of sizes and sample counts. `None` if one of the stages
/// reads parameters: such a part is not kept on disk.
fn key(map: &[u128], stages: &[BakeStage], sizes: &[u32]) -> Option<String> {
    if stages.iter().any(BakeStage::reads_params) {
        return None;
    }
    let modules: Vec<u64> = stages.iter().map(BakeStage::module).collect();
    Some(disk_cache::key(&[bytemuck::cast_slice(map), bytemuck::cast_slice(&modules), bytemuck::cast_slice(sizes)]))
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
