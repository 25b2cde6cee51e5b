//! Device memory for images and buffers.

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use crate::gpu::{Gpu, GpuError, fault};

/// The resource that memory is allocated for.
pub(in crate::gpu) struct Resource<'a> {
    /// Its name, for the allocator's reports.
    pub(in crate::gpu) name: &'a str,
    /// The caller's action, as "creating the image `depth`".
    pub(in crate::gpu) action: &'a str,
    /// Size, alignment and memory types that Vulkan requires for it.
    pub(in crate::gpu) requirements: vk::MemoryRequirements,
    /// The side that reads and writes it.
    pub(in crate::gpu) location: MemoryLocation,
    /// False for images with optimal tiling.
    pub(in crate::gpu) linear: bool,
    /// The injected fault that limits its size in bytes, see [`fault`].
    pub(in crate::gpu) limit: &'static str,
}

/// Allocates memory for a resource. The caller binds it once, and frees it after the resource.
pub(in crate::gpu) fn allocate(gpu: &Gpu, resource: &Resource<'_>) -> Result<Allocation, GpuError> {
    let mib = resource.requirements.size as f64 / f64::from(1 << 20);
    let action = format!("{}, which needs {mib:.1} MiB", resource.action);
    if fault::value(resource.limit).is_some_and(|most| resource.requirements.size > most) {
        return Err(GpuError::OutOfMemory(action));
    }
    gpu.lock_allocator()
        .allocate(&AllocationCreateDesc {
            name: resource.name,
            requirements: resource.requirements,
            location: resource.location,
            linear: resource.linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })
        .map_err(|error| GpuError::allocation(&error, &action))
}
