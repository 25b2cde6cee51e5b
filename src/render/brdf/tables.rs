//! Tables of the BRDF's albedo for one choice of models, integrated on the device by the shaders' own functions. The split
//! sum and multiple scattering read them.

use std::sync::Arc;

use crate::disk_cache;
use crate::gpu::{Buffer, Gpu, GpuError, Image, ImageDesc, Memory, Use, one_shot, vk};
use crate::interface::{BINDING_TARGET, Task};

use crate::render::compute;
use crate::render::pipeline::PipelineSet;
use crate::render::state::{BakeStage, TablesKey};

/// The stages that compute the tables.
pub(crate) const TABLE_STAGES: [&str; 3] = ["ibl/dfg.comp", "ibl/diffuse_albedo.comp", "ibl/sheen_albedo.comp"];

/// Size and sampling of a table: `slices` square maps below each other. Columns are a cosine, rows roughness.
struct Table {
    side: u32,
    slices: u32,
    samples: u32,
    groups: [u32; 3],
    /// The slice and channel of a texel that says which functions returned wrong values, with their files by bit.
    flags: Option<(u32, usize, &'static [&'static str])>,
}

/// In the order of [`TABLE_STAGES`]; brdf/dfg.glsl has the same sizes.
const TABLES: [Table; 3] = [
    Table {
        side: 128,
        slices: 5,
        samples: 512,
        groups: [1, 128, 1],
        flags: Some((4, 2, &["D in brdf/ndf.glsl", "V in brdf/visibility.glsl", "F in brdf/fresnel.glsl"])),
    },
    Table {
        side: 64,
        slices: 2,
        samples: 256,
        groups: [8, 8, 1],
        flags: Some((0, 3, &["f_diffuse in brdf/diffuse.glsl"])),
    },
    Table { side: 64, slices: 1, samples: 512, groups: [8, 8, 1], flags: None },
];
const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

impl Table {
    fn desc(&self) -> ImageDesc {
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        ImageDesc::new(self.side, self.side * self.slices, FORMAT, usage)
    }

    /// The functions that returned wrong values, from the flags in `texels`.
    fn wrong(&self, texels: &[u8]) -> Vec<&'static str> {
        let Some((slice, channel, names)) = self.flags else { return Vec::new() };
        let map = (self.side * self.side) as usize * 4;
        let halves = bytemuck::pod_collect_to_vec::<u8, u16>(texels);
        let flags = halves.iter().skip(slice as usize * map).take(map).skip(channel).step_by(4);
        let bits = flags.fold(0, |bits, half| bits | half::f16::from_bits(*half).to_f32() as u32);
        names.iter().enumerate().filter(|(bit, _)| bits >> bit & 1 == 1).map(|(_, name)| *name).collect()
    }
}

/// All tables, in [`Use::Sampled`].
pub struct Tables {
    /// Moments of the specular lobe: see brdf/dfg.glsl.
    pub(crate) dfg: Arc<Image>,
    /// Albedo of the diffuse lobe.
    pub(crate) diffuse_albedo: Arc<Image>,
    /// Albedo of the sheen lobe.
    pub(crate) sheen_albedo: Arc<Image>,
    /// The functions that returned NaN, infinite, negative or huge values, which count as 0 in the tables.
    pub wrong: Vec<&'static str>,
    stages: Vec<BakeStage>,
}

impl Tables {
    /// Computes the tables of `key`, or loads them from the disk cache. Those of `before` whose stages are the same are shared.
    ///
    /// # Errors
    /// A device error.
    pub fn bake(set: &PipelineSet, key: &TablesKey, before: Option<&Self>) -> Result<Arc<Self>, GpuError> {
        let mut wrong = Vec::new();
        let mut images = Vec::new();
        for (table, stage) in TABLES.iter().zip(&key.0) {
            let known = before.and_then(|before| before.image_of(stage));
            // A table with wrong values is baked again, so that the warning comes again.
            match known.filter(|_| before.is_some_and(|before| before.wrong.is_empty())) {
                Some(image) => images.push(image),
                None => {
                    let (image, functions) = bake(set, table, stage)?;
                    images.push(image);
                    wrong.extend(functions);
                }
            }
        }
        let images: Result<[Arc<Image>; 3], _> = images.try_into();
        let missing = || GpuError::NoStage(TABLE_STAGES.join(", "));
        let [dfg, diffuse_albedo, sheen_albedo] = images.map_err(|_| missing())?;
        Ok(Arc::new(Self { dfg, diffuse_albedo, sheen_albedo, wrong, stages: key.0.clone() }))
    }

    /// Tables of one texel, for a mirror: what a picture is drawn with when no tables could be baked.
    pub(crate) fn of_mirror(gpu: &Arc<Gpu>) -> Result<Arc<Self>, GpuError> {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let texel = |name: &str, value: [f32; 4]| {
            let image = Image::new(gpu, name, ImageDesc::new(1, 1, FORMAT, usage))?;
            let halves = value.map(|x| half::f16::from_f32(x).to_bits());
            compute::upload(gpu, &[(&image, bytemuck::cast_slice(&halves))])?;
            Ok::<_, GpuError>(image)
        };
        Ok(Arc::new(Self {
            dfg: texel("mirror", [1.0, 0.0, 1.0, 0.0])?,
            diffuse_albedo: texel("Lambert", [1.0, 1.0, 1.0, 0.0])?,
            sheen_albedo: texel("no sheen", [0.0; 4])?,
            wrong: Vec::new(),
            stages: Vec::new(),
        }))
    }

    fn image_of(&self, stage: &BakeStage) -> Option<Arc<Image>> {
        let images = [&self.dfg, &self.diffuse_albedo, &self.sheen_albedo];
        self.stages.iter().zip(images).find(|(known, _)| *known == stage).map(|(_, image)| image.clone())
    }
}

/// The warning for a function whose values a bake could not use.
pub fn wrong_values(function: &str) -> String {
    format!("{function} returns NaN, infinite, negative or huge values, which count as 0 in light from all directions")
}

fn bake(set: &PipelineSet, table: &Table, of: &BakeStage) -> Result<(Arc<Image>, Vec<&'static str>), GpuError> {
    let gpu = &set.gpu;
    let (path, desc) = (of.stage.path.as_str(), table.desc());
    let image = Image::new(gpu, path, desc)?;
    let task = Task { size: [table.side; 2], levels: 1, samples: table.samples, ..Task::default() };
    let key = disk_cache::key(&[&of.module.to_le_bytes(), bytemuck::bytes_of(&task)]);
    if let Some(bytes) = disk_cache::load(&key, desc.bytes()) {
        compute::upload(gpu, &[(&image, &bytes)])?;
        return Ok((image, Vec::new()));
    }
    let pipeline = set.compute(path, &of.constants)?;
    let readback = vk::BufferUsageFlags::TRANSFER_DST;
    let buffer = Buffer::new(gpu, "table", desc.bytes(), readback, Memory::Readback)?;
    let bindings =
        compute::bindings(gpu, &set.layouts, &task, |writer| writer.storage_level(BINDING_TARGET, &image, 0))?;
    one_shot(gpu, |encoder| {
        encoder.transition(&image, Use::Undefined, Use::Storage);
        encoder.dispatch(&set.layouts, &pipeline, &[&bindings], table.groups);
        encoder.transition(&image, Use::Storage, Use::CopyFrom);
        encoder.copy_levels_from_image(&image, &buffer, 0);
        encoder.transition(&image, Use::CopyFrom, Use::Sampled);
        encoder.copies_done();
        Ok(())
    })?;
    let texels = buffer.read();
    let wrong = table.wrong(&texels);
    if wrong.is_empty() {
        disk_cache::store(&key, &texels);
    }
    Ok((image, wrong))
}
