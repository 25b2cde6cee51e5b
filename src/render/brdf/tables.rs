//! Tables of the BRDF's albedo for one choice of models, integrated on the device by the shaders' own functions. The split
//! sum and multiple scattering read them.

use std::sync::Arc;

use crate::disk_cache;
use crate::gpu::{Buffer, Gpu, GpuError, Image, ImageDesc, Memory, Use, one_shot, vk};
use crate::interface::{BINDING_TARGET, Task};

use crate::frame::stages::TABLE_STAGES;
use crate::frame::{BakeStage, TablesKey};
use crate::pipeline::PipelineSet;
use crate::render::compute;

/// Size and sampling of a table: `slices` square maps below each other. Columns are a cosine, rows roughness.
struct Table {
    side: u32,
    slices: u32,
    samples: u32,
    groups: [u32; 3],
    /// The slice and channel of the texel that flags the functions which returned invalid values, with their files by bit.
    flags: Option<(u32, usize, &'static [&'static str])>,
}

/// In the order of [`TABLE_STAGES`]; brdf/energy/dfg.glsl has the same sizes.
const TABLES: [Table; 3] = [
    Table {
        side: 128,
        slices: 5,
        samples: 512,
        groups: [1, 128, 1],
        flags: Some((4, 1, &["D in brdf/ndf.glsl", "V in brdf/visibility.glsl", "F in brdf/fresnel.glsl"])),
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

    /// The functions that returned invalid values, from the flags in `texels`.
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
    /// Moments of the specular lobe: see brdf/energy/dfg.glsl.
    pub(crate) dfg: Arc<Image>,
    /// The two moments that punctual lights need (`dfg_towards_lamp` in brdf/energy/albedo.glsl).
    pub(crate) lamp_dfg: Arc<Image>,
    /// Albedo of the diffuse lobe.
    pub(crate) diffuse_albedo: Arc<Image>,
    /// Albedo of the sheen lobe.
    pub(crate) sheen_albedo: Arc<Image>,
    /// The functions that returned NaN, infinite, negative or huge values, which count as 0 in the tables.
    pub wrong: Vec<&'static str>,
    stages: Vec<BakeStage>,
}

impl Tables {
    /// Computes the tables of `key`, or loads them from the disk cache. Tables of `before` whose stages are unchanged are shared.
    ///
    /// # Errors
    /// A device error.
    pub fn bake(set: &PipelineSet, key: &TablesKey, before: Option<&Arc<Self>>) -> Result<Arc<Self>, GpuError> {
        key.resolve();
        if let Some(before) = before.filter(|before| before.stages == key.0) {
            return Ok(before.clone());
        }
        let mut wrong = Vec::new();
        let mut images = Vec::new();
        let mut lamp_dfg = before.map(|before| before.lamp_dfg.clone());
        for (table, stage) in TABLES.iter().zip(&key.0) {
            let known = before.and_then(|before| before.image_of(stage));
            // A table with invalid values is baked again each time, so that the warning is repeated.
            match known.filter(|_| before.is_some_and(|before| before.wrong.is_empty())) {
                Some(image) => images.push(image),
                None => {
                    let (image, texels) = bake(set, table, stage)?;
                    if images.is_empty() {
                        lamp_dfg = Some(table_of_lamps(&set.gpu, table, &texels)?);
                        compute::upload(&set.gpu, &[(&image, &with_fine_rows(table, &texels))])?;
                    }
                    images.push(image);
                    wrong.extend(table.wrong(&texels));
                }
            }
        }
        let images: Result<[Arc<Image>; 3], _> = images.try_into();
        let missing = || GpuError::NoStage(TABLE_STAGES.join(", "));
        let [dfg, diffuse_albedo, sheen_albedo] = images.map_err(|_| missing())?;
        let lamp_dfg = lamp_dfg.ok_or_else(missing)?;
        Ok(Arc::new(Self { dfg, lamp_dfg, diffuse_albedo, sheen_albedo, wrong, stages: key.0.clone() }))
    }

    /// Tables of one texel, for a mirror: the fallback when no tables could be baked.
    pub(crate) fn of_mirror(gpu: &Arc<Gpu>) -> Result<Arc<Self>, GpuError> {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let filled = |name: &str, value: [f32; 4], desc: ImageDesc| {
            let image = Image::new(gpu, name, desc)?;
            let halves = value.map(|x| half::f16::from_f32(x).to_bits());
            let texels = halves.repeat((desc.width * desc.height) as usize);
            compute::upload(gpu, &[(&image, bytemuck::cast_slice(&texels))])?;
            Ok::<_, GpuError>(image)
        };
        let texel = |name: &str, value| filled(name, value, ImageDesc::new(1, 1, FORMAT, usage));
        let dfg = ImageDesc { usage, ..TABLES[0].desc() };
        Ok(Arc::new(Self {
            // Its shader reads single texels of it, which must exist.
            dfg: filled("mirror", [1.0, 0.0, 1.0, 0.0], dfg)?,
            lamp_dfg: texel("mirror towards lamps", [0.0; 4])?,
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

/// The slices of the DFG table with fine rows: `DFG_MEAN` and `DFG_LOBE` of brdf/energy/dfg.glsl.
const FINE_SLICES: [usize; 2] = [2, 4];

/// The DFG table with its slices that do not depend on a cosine interpolated between their rows: `fine_texel` of
/// brdf/energy/dfg.glsl.
fn with_fine_rows(dfg: &Table, texels: &[u8]) -> Vec<u8> {
    let mut halves: Vec<half::f16> =
        bytemuck::pod_collect_to_vec::<u8, u16>(texels).into_iter().map(half::f16::from_bits).collect();
    let (side, row) = (dfg.side as usize, dfg.side as usize * 4);
    for slice in FINE_SLICES {
        let rows = &mut halves[slice * side * row..(slice + 1) * side * row];
        // All columns of a baked row are the same. The first stays.
        for y in 0..side {
            for x in 1..side {
                for channel in 0..4 {
                    let below = rows[(y + 1).min(side - 1) * row + channel].to_f32();
                    let above = rows[y * row + channel].to_f32();
                    rows[y * row + 4 * x + channel] =
                        half::f16::from_f32(above + (below - above) * x as f32 / side as f32);
                }
            }
        }
    }
    halves.into_iter().flat_map(half::f16::to_ne_bytes).collect()
}

/// B and the energy deficit (`lost`) of the directions of the DFG table: channels 1 and 3 of its first slice.
fn table_of_lamps(gpu: &Arc<Gpu>, dfg: &Table, texels: &[u8]) -> Result<Arc<Image>, GpuError> {
    let slice = texels.chunks_exact(8).take((dfg.side * dfg.side) as usize);
    let both: Vec<u8> = slice.flat_map(|texel| [&texel[2..4], &texel[6..8]].concat()).collect();
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let image = Image::new(gpu, "lamp dfg", ImageDesc::new(dfg.side, dfg.side, vk::Format::R16G16_SFLOAT, usage))?;
    compute::upload(gpu, &[(&image, &both)])?;
    Ok(image)
}

/// A table with its texels.
fn bake(set: &PipelineSet, table: &Table, of: &BakeStage) -> Result<(Arc<Image>, Vec<u8>), GpuError> {
    let gpu = &set.gpu;
    let (path, desc) = (of.stage.path.as_str(), table.desc());
    let image = Image::new(gpu, path, desc)?;
    let task = Task { size: [table.side; 2], levels: 1, samples: table.samples, ..Task::default() };
    let is_kept = !of.reads_params();
    let key = disk_cache::key(&[&of.module().to_le_bytes(), bytemuck::bytes_of(&task)]);
    if let Some(bytes) = is_kept.then(|| disk_cache::load(&key, desc.bytes())).flatten() {
        compute::upload(gpu, &[(&image, &bytes)])?;
        return Ok((image, bytes));
    }
    let pipeline = set.compute(path, &of.constants)?;
    let readback = vk::BufferUsageFlags::TRANSFER_DST;
    let buffer = Buffer::new(gpu, "table", desc.bytes(), readback, Memory::Readback)?;
    let bindings =
        compute::bindings(gpu, &set.layouts, &task, |writer| writer.storage_level(BINDING_TARGET, &image, 0))?;
    let frame = compute::frame_set(gpu, &set.layouts, &of.params)?;
    one_shot(gpu, |encoder| {
        encoder.transition(&image, Use::Undefined, Use::Storage);
        encoder.dispatch(&pipeline, &[&frame, &bindings], table.groups);
        encoder.transition(&image, Use::Storage, Use::CopyFrom);
        encoder.copy_levels_from_image(&image, &buffer, 0);
        encoder.transition(&image, Use::CopyFrom, Use::Sampled);
        encoder.copies_done();
        Ok(())
    })?;
    let texels = buffer.read();
    if is_kept && table.wrong(&texels).is_empty() {
        disk_cache::store(&key, &texels);
    }
    Ok((image, texels))
}
