//! Buffers.

use std::sync::{Arc, Mutex, PoisonError};

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
    /// Held by the thread that accesses the mapped memory.
    access: Mutex<()>,
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
        let mut buffer = Self { gpu: gpu.clone(), raw, allocation: None, size, access: Mutex::default() };
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
    /// fence of the last submission that reads the buffer, or the device reads a mixture.
    pub fn write(&self, offset: u64, bytes: &[u8]) {
        self.fill(offset, bytes.len(), |target| target.copy_from_slice(&bytes[..target.len()]));
    }

    /// Lets `fill` write `length` bytes at `offset`, clipped to the buffer's end, and nothing if the CPU cannot see the buffer. Otherwise as
    /// [`Buffer::write`]. `fill` cannot rely on what the bytes were before.
    pub fn fill(&self, offset: u64, length: usize, fill: impl FnOnce(&mut [u8])) {
        let Some(mapped) = self.allocation.as_ref().and_then(Allocation::mapped_ptr) else { return };
        let Some(room) = self.size.checked_sub(offset) else { return };
        let _access = self.access.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: `offset` and `length` lie within the mapping, whose bytes have no invalid values. The lock keeps other threads from
        // them, and no shader writes a buffer while the CPU writes it.
        fill(unsafe {
            let target = mapped.as_ptr().cast::<u8>().add(offset as usize);
            std::slice::from_raw_parts_mut(target, length.min(room as usize))
        });
    }

    /// Copies the content out; empty where the CPU cannot see it. For [`Memory::Readback`]. The caller must have waited for the fence of
    /// the submission that writes the buffer, or gets a mixture.
    pub fn read(&self) -> Vec<u8> {
        self.read_part(0, self.size)
    }

    /// The part of [`Buffer::read`] from `offset`, of at most `length` bytes.
    pub fn read_part(&self, offset: u64, length: u64) -> Vec<u8> {
        let Some(mapped) = self.allocation.as_ref().and_then(Allocation::mapped_ptr) else { return Vec::new() };
        let offset = offset.min(self.size);
        let length = length.min(self.size - offset) as usize;
        let mut content = Vec::with_capacity(length);
        let _access = self.access.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the mapping has `length` bytes from `offset`, and the vector has room for them; they do not overlap. The lock keeps
        // other threads from the mapping. No reference to it exists, since the device may write it, and every byte that it writes is
        // a valid one.
        unsafe {
            let from = mapped.as_ptr().cast::<u8>().add(offset as usize);
            std::ptr::copy_nonoverlapping(from, content.as_mut_ptr(), length);
            content.set_len(length);
        }
        content
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuOptions;

    fn buffer(size: u64) -> Arc<Buffer> {
        let gpu = Gpu::new(&GpuOptions::default()).unwrap();
        Buffer::new(&gpu, "test", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload).unwrap()
    }

    #[test]
    fn a_reader_sees_all_of_a_write_or_nothing_of_it() {
        let size = 1 << 20;
        let buffer = buffer(size as u64);
        buffer.write(0, &vec![0; size]);
        std::thread::scope(|scope| {
            scope.spawn(|| (0..100).for_each(|number| buffer.write(0, &vec![number; size])));
            for _ in 0..100 {
                let read = buffer.read();
                assert!(read.iter().all(|byte| *byte == read[0]), "bytes of two writes");
            }
        });
    }

    #[test]
    fn a_write_beyond_the_end_is_clipped() {
        let buffer = buffer(4);
        buffer.write(0, &[1; 9]);
        buffer.write(3, &[2; 2]);
        buffer.write(4, &[3]);
        buffer.write(u64::MAX, &[4; 4]);
        assert_eq!(buffer.read(), [1, 1, 1, 2]);
    }
}
