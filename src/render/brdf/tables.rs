//! Tables of the BRDF's albedo for one choice of models, computed on the device. The split sum and multiple scattering read them.

use std::sync::Arc;

use crate::disk_cache;
use crate::gpu::{Buffer, GpuError, Image, ImageDesc, Memory, Specialization, Use, one_shot, vk};
use crate::interface::{BINDING_TARGET, Task};

use crate::render::compute;
use crate::render::pipeline::PipelineSet;

/// Stage that computes the DFG table.
pub(crate) const DFG: &str = "ibl/dfg.comp";
/// Stage that computes the sheen's albedo table.
pub(crate) const SHEEN_ALBEDO: &str = "ibl/sheen_albedo.comp";

const DFG_SIZE: u32 = 128;
const DFG_SAMPLES: u32 = 512;
const SHEEN_SIZE: u32 = 64;
const SHEEN_SAMPLES: u32 = 512;
const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// Both tables, in [`Use::Sampled`]. Columns are NoV or its root, rows roughness.
pub(crate) struct Tables {
    /// A, B, C and the mean albedo: see brdf/energy.glsl.
    pub(crate) dfg: Arc<Image>,
    /// Directional albedo of the sheen lobe.
    pub(crate) sheen_albedo: Arc<Image>,
}

impl Tables {
    /// Computes the tables with these values of the author's constants, or loads them from the disk cache.
    pub(crate) fn new(set: &PipelineSet, constants: &Specialization) -> Result<Arc<Self>, GpuError> {
        let rows = [1, DFG_SIZE, 1];
        let dfg = table(set, DFG, constants, DFG_SIZE, DFG_SAMPLES, rows)?;
        let sheen_albedo =
            table(set, SHEEN_ALBEDO, constants, SHEEN_SIZE, SHEEN_SAMPLES, compute::groups(SHEEN_SIZE, 1))?;
        Ok(Arc::new(Self { dfg, sheen_albedo }))
    }
}

fn table(
    set: &PipelineSet,
    stage: &str,
    constants: &Specialization,
    size: u32,
    samples: u32,
    groups: [u32; 3],
) -> Result<Arc<Image>, GpuError> {
    use vk::ImageUsageFlags as Usage;
    let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let desc = ImageDesc::new(size, size, FORMAT, usage);
    let image = Image::new(&set.gpu, stage, desc)?;
    let task = Task { size: [size; 2], levels: 1, samples, ..Task::default() };
    let values: Vec<u32> = constants.iter().flat_map(|(id, value)| [*id, *value]).collect();
    let spirv = bytemuck::cast_slice(set.spirv(stage)?);
    let key = disk_cache::key(&[spirv, bytemuck::cast_slice(&values), bytemuck::bytes_of(&task)]);
    if let Some(bytes) = disk_cache::load(&key, desc.bytes()) {
        compute::upload(&set.gpu, &[(&image, &bytes)])?;
        return Ok(image);
    }
    let pipeline = set.compute(stage, constants)?;
    let readback = vk::BufferUsageFlags::TRANSFER_DST;
    let buffer = Buffer::new(&set.gpu, "table", desc.bytes(), readback, Memory::Readback)?;
    let bindings =
        compute::bindings(&set.gpu, &set.layouts, &task, |writer| writer.storage_level(BINDING_TARGET, &image, 0))?;
    one_shot(&set.gpu, |encoder| {
        encoder.transition(&image, Use::Undefined, Use::Storage);
        encoder.dispatch(&set.layouts, &pipeline, &[&bindings], groups);
        encoder.transition(&image, Use::Storage, Use::CopyFrom);
        encoder.copy_levels_from_image(&image, &buffer, 0);
        encoder.transition(&image, Use::CopyFrom, Use::Sampled);
        encoder.copies_done();
        Ok(())
    })?;
    disk_cache::store(&key, &buffer.read());
    Ok(image)
}
