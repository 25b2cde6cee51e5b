//! Buffers that the CPU fills again and again, each of which the device may still read when the next is filled.

use std::sync::{Arc, Mutex, PoisonError};

use crate::gpu::{Buffer, Gpu, GpuError, Memory, vk};

/// Buffers that nothing uses are filled again.
pub(super) struct BufferPool {
    gpu: Arc<Gpu>,
    buffers: Mutex<Vec<Arc<Buffer>>>,
}

impl BufferPool {
    /// The number of idle buffers that are kept.
    const MOST_IDLE: usize = 4;

    pub(super) fn new(gpu: &Arc<Gpu>) -> Self {
        Self { gpu: gpu.clone(), buffers: Mutex::default() }
    }

    /// A buffer with this content, for draws and for stages that know its address. It is filled again once it is dropped.
    pub(super) fn filled(&self, bytes: &[u8]) -> Result<Arc<Buffer>, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let mut buffers = self.buffers.lock().unwrap_or_else(PoisonError::into_inner);
        // Frames in flight hold what they use, so a buffer that is held here alone is idle.
        let idle: Vec<usize> = (0..buffers.len()).filter(|at| Arc::get_mut(&mut buffers[*at]).is_some()).collect();
        // Their size changes from frame to frame, as the camera moves.
        let size = bytes.len().max(1).next_power_of_two() as u64;
        let fits = |at: &&usize| (size..=2 * size).contains(&buffers[**at].size());
        if let Some(at) = idle.iter().find(fits) {
            let buffer = buffers[*at].clone();
            buffer.write(0, bytes);
            return Ok(buffer);
        }
        idle.iter().rev().take(idle.len().saturating_sub(Self::MOST_IDLE - 1)).for_each(|at| drop(buffers.remove(*at)));
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS | Usage::INDIRECT_BUFFER;
        let buffer = Buffer::new(&self.gpu, "draws", size, usage, Memory::Upload)?;
        buffer.write(0, bytes);
        buffers.push(buffer.clone());
        Ok(buffer)
    }
}
