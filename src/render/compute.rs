//! Helpers that all compute tasks share: bindings, workgroup counts, samplers and image uploads.

use std::sync::Arc;

pub(crate) use crate::gpu::upload_images as upload;
use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Memory, Sampler, SamplerDesc, SetLayouts, SetWriter, one_shot, vk,
};
use crate::interface::{BINDING_PARAMS, BINDING_TASK, PARAMS_SIZE, SET_FRAME, SET_TASK, Task};

/// Workgroup size along x and y of most compute stages.
const GROUP: u32 = 8;

/// Workgroups that cover `layers` images of `side` x `side` texels.
pub(crate) fn groups(side: u32, layers: u32) -> [u32; 3] {
    [side.div_ceil(GROUP), side.div_ceil(GROUP), layers]
}

/// Descriptor set 3 of one dispatch: the task's parameters, and what `more` binds.
pub(crate) fn bindings(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    task: &Task,
    more: impl FnOnce(SetWriter) -> SetWriter,
) -> Result<Arc<DescriptorSet>, GpuError> {
    let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
    let buffer = Buffer::new(gpu, "task", size_of::<Task>() as u64, usage, Memory::Upload)?;
    buffer.write(0, bytemuck::bytes_of(task));
    let writer = SetWriter::default().buffer(BINDING_TASK, &buffer);
    DescriptorSet::new(layouts, SET_TASK, more(writer))
}

/// Descriptor set 0 of a bake: only the bytes of the block `Params`. The contract check refuses a stage that reads anything else
/// in the set.
pub(crate) fn frame_set(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    params: &[u8],
) -> Result<Arc<DescriptorSet>, GpuError> {
    let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
    let buffer = Buffer::new(gpu, "params of a bake", PARAMS_SIZE.into(), usage, Memory::Upload)?;
    buffer.write(0, params);
    DescriptorSet::new(layouts, SET_FRAME, SetWriter::default().buffer(BINDING_PARAMS, &buffer))
}

/// A trilinear sampler, clamped vertically. `wrap_u` is REPEAT for an equirectangular map, whose left and right edges meet.
pub(crate) fn linear(gpu: &Arc<Gpu>, wrap_u: vk::SamplerAddressMode) -> Result<Arc<Sampler>, GpuError> {
    Sampler::new(gpu, &SamplerDesc { wrap_u, ..SamplerDesc::LINEAR })
}

/// Bytes of the largest staging buffer of [`upload_buffer`].
const STAGING_BYTES: usize = 32 << 20;

/// Creates a storage buffer with this content, which must not be empty. A staging buffer of bounded size copies it in parts.
pub(crate) fn upload_buffer(gpu: &Arc<Gpu>, name: &str, bytes: &[u8]) -> Result<Arc<Buffer>, GpuError> {
    use vk::BufferUsageFlags as Usage;
    let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
    let buffer = Buffer::new(gpu, name, bytes.len() as u64, usage, Memory::Device)?;
    let largest = bytes.len().min(STAGING_BYTES);
    let staging = Buffer::new(gpu, "staging", largest as u64, Usage::TRANSFER_SRC, Memory::Upload)?;
    for (part, own) in bytes.chunks(STAGING_BYTES).enumerate() {
        staging.write(0, own);
        one_shot(gpu, |encoder| {
            encoder.copy_buffer(&staging, 0, &buffer, (part * STAGING_BYTES) as u64, own.len() as u64);
            encoder.copies_done();
            Ok(())
        })?;
    }
    Ok(buffer)
}

/// Writes bytes to a buffer that shaders read by address. A buffer that is too small is replaced.
pub(crate) fn write_addressed(
    gpu: &Arc<Gpu>,
    name: &str,
    buffer: &mut Option<Arc<Buffer>>,
    bytes: &[u8],
) -> Result<Arc<Buffer>, GpuError> {
    let buffer = match buffer.take().filter(|buffer| buffer.size() >= bytes.len() as u64) {
        Some(fits) => buffer.insert(fits),
        None => {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
            buffer.insert(Buffer::new(gpu, name, bytes.len() as u64, usage, Memory::Upload)?)
        }
    };
    buffer.write(0, bytes);
    Ok(buffer.clone())
}
