//! What the compute tasks share: their bindings, their workgroups, and the way of images in and out.

use std::sync::Arc;

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Image, Memory, Sampler, SamplerDesc, SetLayouts, SetWriter, Use, one_shot, vk,
};
use crate::interface::{BINDING_TASK, SET_TASK, Task};

/// Invocations of a workgroup along x and y, where a stage does not say otherwise.
const GROUP: u32 = 8;

/// Workgroups that cover `layers` squares of `side` texels.
pub(crate) fn groups(side: u32, layers: u32) -> [u32; 3] {
    [side.div_ceil(GROUP), side.div_ceil(GROUP), layers]
}

/// Set 3 of one dispatch.
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

/// A trilinear sampler: equirectangular maps repeat from left to right.
pub(crate) fn linear(gpu: &Arc<Gpu>, wrap_u: vk::SamplerAddressMode) -> Result<Arc<Sampler>, GpuError> {
    Sampler::new(
        gpu,
        &SamplerDesc {
            mag: vk::Filter::LINEAR,
            min: vk::Filter::LINEAR,
            mip: vk::SamplerMipmapMode::LINEAR,
            mips: true,
            wrap_u,
            wrap_v: vk::SamplerAddressMode::CLAMP_TO_EDGE,
            anisotropy: 1,
        },
    )
}

/// Fills images, all levels and layers, and leaves them in [`Use::Sampled`].
pub(crate) fn upload(gpu: &Arc<Gpu>, images: &[(&Arc<Image>, &[u8])]) -> Result<(), GpuError> {
    let place = |size: usize| (size as u64).next_multiple_of(16);
    let size = images.iter().map(|(_, bytes)| place(bytes.len())).sum();
    let staging = Buffer::new(gpu, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload)?;
    let mut at = 0;
    for (_, bytes) in images {
        staging.write(at, bytes);
        at += place(bytes.len());
    }
    one_shot(gpu, |encoder| {
        let mut at = 0;
        for (image, bytes) in images {
            encoder.transition(image, Use::Undefined, Use::CopyTo);
            encoder.copy_to_image(&staging, at, image);
            encoder.transition(image, Use::CopyTo, Use::Sampled);
            at += place(bytes.len());
        }
        encoder.copies_done();
        Ok(())
    })
}
