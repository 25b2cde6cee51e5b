//! Vulkan objects, and the only `unsafe` code in the crate. This layer knows no files and no glTF.
//!
//! Every wrapper owns one object and an `Arc<Gpu>`, and frees the object in `Drop`. A frame slot holds an `Arc` of every resource
//! that its commands use, and releases them once its fence has signaled. So the last `Arc` destroys an object at the right time,
//! without a deletion queue.
//!
//! Replacing a pipeline set, a model or a target is thus an assignment. Pixels leave the CPU once they are uploaded,
//! and `heap.rs` returns their memory to the system. Each wait has a `SYNC:` line, each `unsafe` block a `SAFETY:`
//! line. Out of memory is an error value: the window reports it, keeps the previous frame and tries again. `fault.rs`
//! lets tests inject faults through `SPECULA_FAULT`. There is one queue, so a long upload and a frame take turns.
//!
//! Workarounds for Mesa's lavapipe 22.3: it writes which uniforms of a stage's fourth uniform block branches depend on
//! over its own counters, which ends the process, so `BINDING_UNUSED` is the fourth block, and nothing reads it. It
//! crashes when a surface gets a debug name, and at a compute loop with barriers that no branch precedes.

mod commands;
mod device;
mod error;
pub mod fault;
mod heap;
mod resources;
pub mod watchdog;
mod window;

pub use commands::counts::DrawCounts;
pub use commands::encoder::{Attachments, Encoder, Rect};
pub use commands::frames::{Frames, one_shot};
pub use commands::image_use::Use;
pub use commands::pass_timer::PassTime;
pub use commands::slot::Submission;
pub use commands::upload::upload_images;
pub use device::adapter::{AdapterInfo, adapters, texture_formats};
pub use device::gpu::{Gpu, GpuOptions, OptionalStages};
pub use device::memory_use::{Heap, MemoryUse};
pub use device::optional::MeshLimits;
pub use device::pipeline_cache::PipelineStore;
pub use error::GpuError;
pub use heap::{return_freed_memory, return_large_blocks};
pub use resources::buffer::{Buffer, Memory};
pub use resources::compute_pipeline::ComputePipeline;
pub use resources::descriptor::{DescriptorSet, SetLayouts, SetWriter};
pub use resources::image::{Image, ImageDesc};
pub use resources::pass_layout::{PassBinding, PassBindings, PassLayout, PassResource};
pub use resources::pipeline::{Pipeline, PipelineDesc, PrimitiveClass, Raster, ShaderModule, Specialization};
pub use resources::resource_usage::ResourceUsage;
pub use resources::sampler::{Sampler, SamplerDesc};
pub use resources::statistics::{CompileInfo, Executable, PipelineStage, Statistic};
pub use window::surface::Surface;
pub use window::swapchain::{Acquired, NextImage, Swapchain};
pub use window::ui::{UiImage, UiRenderer};

/// Vulkan's enums, for formats, usages and topologies in the signatures of this module.
pub use ash::vk;
