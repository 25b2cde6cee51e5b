//! Objects that commands use: buffers, images, samplers, descriptor sets and pipelines.

pub(in crate::gpu) mod blank;
pub(in crate::gpu) mod buffer;
pub(in crate::gpu) mod compute_pipeline;
pub(in crate::gpu) mod descriptor;
pub(in crate::gpu) mod image;
pub(in crate::gpu) mod memory;
pub(in crate::gpu) mod pass_layout;
pub(in crate::gpu) mod pipeline;
pub(in crate::gpu) mod resource_usage;
pub(in crate::gpu) mod sampler;
pub(in crate::gpu) mod set_layouts;
pub(in crate::gpu) mod statistics;
