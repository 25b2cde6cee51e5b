//! The buffers of set 0, one of each for every frame slot, so that the CPU never writes what a frame in flight reads.

use std::sync::Arc;

use crate::gpu::{Buffer, DescriptorSet, GpuError, Memory, SetLayouts, SetWriter, vk};
use crate::interface::{self, Frame, Light};

/// Set 0 of one frame slot.
pub(super) struct Uniforms {
    frame: Arc<Buffer>,
    lights: Arc<Buffer>,
    params: Arc<Buffer>,
    pub(super) set: Arc<DescriptorSet>,
}

impl Uniforms {
    /// With room for `lights` lights.
    pub(super) fn new(gpu: &Arc<crate::gpu::Gpu>, layouts: &Arc<SetLayouts>, lights: usize) -> Result<Self, GpuError> {
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let light_bytes = (lights.max(8) * size_of::<Light>()) as u64;
        let frame = Buffer::new(gpu, "frame", size_of::<Frame>() as u64, uniform, Memory::Upload)?;
        let lights = Buffer::new(gpu, "lights", light_bytes, storage, Memory::Upload)?;
        let params = Buffer::new(gpu, "params", interface::PARAMS_SIZE.into(), uniform, Memory::Upload)?;
        let writer = SetWriter::default().buffer(0, &frame).buffer(1, &lights).buffer(2, &params);
        let set = DescriptorSet::new(layouts, interface::SET_FRAME, writer)?;
        Ok(Self { frame, lights, params, set })
    }

    pub(super) fn light_capacity(&self) -> usize {
        self.lights.size() as usize / size_of::<Light>()
    }

    /// Writes everything. The slot's fence has signaled.
    pub(super) fn write(&self, frame: &Frame, lights: &[Light], params: &[u8]) {
        self.frame.write(0, bytemuck::bytes_of(frame));
        self.lights.write(0, bytemuck::cast_slice(lights));
        self.params.write(0, params);
    }
}
