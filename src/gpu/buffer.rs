//! Buffers.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::device::Gpu;
use super::error::{Context, GpuError};

/// Where a buffer's memory lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// Device only.
    Device,
    /// Written by the CPU, read by the device.
    Upload,
    /// Written by the device, read by the CPU.
    Readback,
}

/// A buffer with its memory.
pub struct Buffer {
    gpu: Arc<Gpu>,
    pub(super) raw: vk::Buffer,
    allocation: Option<Allocation>,
    size: u64,
}

impl Buffer {
    /// Makes a buffer of `size` bytes (at least 1).
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        memory: Memory,
    ) -> Result<Arc<Self>, GpuError> {
        let size = size.max(1);
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the device is live.
        let raw = unsafe { gpu.device.create_buffer(&info, None) }.context("creating a buffer")?;
        let mut buffer = Self { gpu: gpu.clone(), raw, allocation: None, size };
        // SAFETY: `raw` belongs to this device.
        let requirements = unsafe { gpu.device.get_buffer_memory_requirements(raw) };
        let allocation = gpu
            .lock_allocator()
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location: match memory {
                    Memory::Device => MemoryLocation::GpuOnly,
                    Memory::Upload => MemoryLocation::CpuToGpu,
                    Memory::Readback => MemoryLocation::GpuToCpu,
                },
                linear: true,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|e| GpuError::Allocation { what: name.into(), message: e.to_string() })?;
        // SAFETY: the memory was allocated for these requirements and is bound once.
        let bound = unsafe { gpu.device.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) };
        buffer.allocation = Some(allocation);
        bound.context("binding buffer memory")?;
        Ok(Arc::new(buffer))
    }

    /// Bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Address for `buffer_reference`; the usage must include `SHADER_DEVICE_ADDRESS`.
    pub fn address(&self) -> u64 {
        // SAFETY: the buffer is live and bound.
        unsafe { self.gpu.device.get_buffer_device_address(&vk::BufferDeviceAddressInfo::default().buffer(self.raw)) }
    }

    /// Copies `bytes` to `offset`, clipped to the buffer's end. For `Memory::Upload`; the caller's frame slot has seen its fence,
    /// so the device does not read meanwhile.
    pub fn write(&self, offset: u64, bytes: &[u8]) {
        let Some(mapped) = self.allocation.as_ref().and_then(Allocation::mapped_ptr) else { return };
        let length = bytes.len().min(self.size.saturating_sub(offset) as usize);
        // SAFETY: the mapping is `size` bytes long and `offset + length` stays within; source and target cannot overlap.
        unsafe {
            let target = mapped.as_ptr().cast::<u8>().add(offset as usize);
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), target, length);
        }
    }

    /// Copies the content out. For `Memory::Readback`, after the writing submission's fence.
    pub fn read(&self) -> Vec<u8> {
        self.content().to_vec()
    }

    /// The content itself; empty where the CPU cannot see it. For `Memory::Readback`, after the writing submission's
    /// fence.
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
