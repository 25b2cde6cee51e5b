//! The uniform blocks of declared passes.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::frame::PassBlocks;
use crate::gpu::{Buffer, Gpu, GpuError, Memory, vk};

/// The uniform blocks of a frame's declared passes. Each frame slot has its own, so that the CPU never writes what a frame in
/// flight reads.
#[derive(Clone, Default)]
pub(in crate::render::view) struct Blocks(BTreeMap<(usize, u32), Arc<Buffer>>);

impl Blocks {
    /// Writes the blocks of a frame. SYNC: after the slot's fence.
    pub(in crate::render::view) fn write(&mut self, gpu: &Arc<Gpu>, blocks: &PassBlocks) -> Result<(), GpuError> {
        self.0.retain(|place, buffer| blocks.get(place).is_some_and(|bytes| buffer.size() == bytes.len() as u64));
        for (place, bytes) in blocks {
            let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
            let buffer = match self.0.get(place) {
                Some(buffer) => buffer.clone(),
                None => Buffer::new(gpu, "pass parameters", bytes.len() as u64, usage, Memory::Upload)?,
            };
            buffer.write(0, bytes);
            self.0.insert(*place, buffer);
        }
        Ok(())
    }

    /// The block at this binding of a pass, which has this place in `PipelineRequest::passes`.
    pub(super) fn get(&self, pass: usize, binding: u32) -> Option<&Arc<Buffer>> {
        self.0.get(&(pass, binding))
    }
}
