//! Buffers.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::memory::{Resource, allocate};
use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};

/// The side that reads and writes a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// The device alone reads and writes it.
    Device,
    /// The CPU writes it, the device reads it.
    Upload,
    /// The device writes it, the CPU reads it.
    Readback,
}

/// A buffer with its memory.
pub struct Buffer {
    gpu: Arc<Gpu>,
    pub(in crate::gpu) raw: vk::Buffer,
    allocation: Option<Allocation>,
    size: u64,
}

impl Buffer {
    /// Creates a buffer of `size` bytes (at least 1). GPU debuggers and validation messages show `name`.
    ///
    /// # Errors
    /// The device is out of memory ([`GpuError::OutOfMemory`]).
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        memory: Memory,
    ) -> Result<Arc<Self>, GpuError> {
        let size = size.max(1);
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        let what = format!("`{name}`");
        // SAFETY: the device is live.
        let raw = unsafe { gpu.device.create_buffer(&info, None) }.context_of("creating the buffer", &what)?;
        // From here on, `Drop` frees what is already there when a later step fails.
        let mut buffer = Self { gpu: gpu.clone(), raw, allocation: None, size };
        gpu.name(raw, name);
        let allocation = buffer.allocation.insert(allocate(
            gpu,
            &Resource {
                name,
                action: &format!("creating the buffer {what}"),
                // SAFETY: `raw` belongs to this device.
                requirements: unsafe { gpu.device.get_buffer_memory_requirements(raw) },
                location: match memory {
                    Memory::Device => MemoryLocation::GpuOnly,
                    Memory::Upload => MemoryLocation::CpuToGpu,
                    Memory::Readback => MemoryLocation::GpuToCpu,
                },
                linear: true,
                limit: "buffer-bytes",
            },
        )?);
        // SAFETY: the memory was allocated for this buffer and is bound once.
        unsafe { gpu.device.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) }
            .context_of("binding memory to the buffer", &what)?;
        Ok(Arc::new(buffer))
    }

    /// Size in bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Device address for `buffer_reference`; the usage must include `SHADER_DEVICE_ADDRESS`.
    pub fn address(&self) -> u64 {
        // SAFETY: the buffer is live and bound.
        unsafe { self.gpu.device.get_buffer_device_address(&vk::BufferDeviceAddressInfo::default().buffer(self.raw)) }
    }

    /// Copies `bytes` to `offset`, clipped to the buffer's end. For [`Memory::Upload`]. The caller must have waited for the
    /// fence of the last submission that reads the buffer.
    pub fn write(&self, offset: u64, bytes: &[u8]) {
        let Some(mapped) = self.allocation.as_ref().and_then(Allocation::mapped_ptr) else { return };
        let length = bytes.len().min(self.size.saturating_sub(offset) as usize);
        // SAFETY: the mapping is `size` bytes long and `offset + length` stays within; source and target cannot overlap.
        unsafe {
            let target = mapped.as_ptr().cast::<u8>().add(offset as usize);
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), target, length);
        }
    }

    /// Copies the contents out. For [`Memory::Readback`], after the fence of the submission that wrote them.
    pub fn read(&self) -> Vec<u8> {
        self.content().to_vec()
    }

    /// The mapped content; empty where the CPU cannot see it. For `Memory::Readback`, after the writing submission's fence.
    pub fn content(&self) -> &[u8] {
        let mapped = self.allocation.as_ref().and_then(Allocation::mapped_slice);
        mapped.map(|m| &m[..self.size as usize]).unwrap_or_default()
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, so no command in flight uses the buffer.
        unsafe { self.gpu.device.destroy_buffer(self.raw, None) };
        if let Some(allocation) = self.allocation.take() {
            let _ = self.gpu.lock_allocator().free(allocation);
        }
    }
}
