//! How much memory of the device is in use.

use ash::vk;
use serde::Serialize;

use crate::gpu::Gpu;

/// A heap of the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Heap {
    /// Its size in bytes.
    pub size: u64,
    /// Whether it is memory of the device itself.
    pub is_device: bool,
    /// Bytes that this process has allocated in it, as the driver counts, and its budget (VK_EXT_memory_budget); `None` if the
    /// driver does not report them.
    pub used_of: Option<[u64; 2]>,
}

/// Memory of the device.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MemoryUse {
    /// Bytes that images and buffers take.
    pub used: u64,
    /// Bytes of the blocks that they lie in.
    pub reserved: u64,
    /// The heaps.
    pub heaps: Vec<Heap>,
}

impl Gpu {
    /// How much memory is in use. Takes some microseconds for each image and buffer.
    pub fn memory(&self) -> MemoryUse {
        let report = self.lock_allocator().generate_report();
        let mut budget = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
        let mut properties = vk::PhysicalDeviceMemoryProperties2::default();
        if self.has_memory_budget {
            properties = properties.push_next(&mut budget);
        }
        // SAFETY: the instance is live, and the device belongs to it; the chain is valid for the call.
        unsafe { self.instance.raw.get_physical_device_memory_properties2(self.physical, &mut properties) };
        let heaps = properties.memory_properties;
        let count = heaps.memory_heap_count as usize;
        let heap = |(index, heap): (usize, &vk::MemoryHeap)| Heap {
            size: heap.size,
            is_device: heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL),
            used_of: self.has_memory_budget.then(|| [budget.heap_usage[index], budget.heap_budget[index]]),
        };
        MemoryUse {
            used: report.total_allocated_bytes,
            reserved: report.total_capacity_bytes,
            heaps: heaps.memory_heaps.iter().take(count).enumerate().map(heap).collect(),
        }
    }
}
