//! Opening a device: instance, physical device, logical device, queue and allocator.

pub(in crate::gpu) mod adapter;
pub(in crate::gpu) mod debug;
pub(in crate::gpu) mod gpu;
pub(in crate::gpu) mod instance;
pub(in crate::gpu) mod memory_use;
pub(in crate::gpu) mod optional;
pub(in crate::gpu) mod pipeline_cache;
pub(in crate::gpu) mod validation;
