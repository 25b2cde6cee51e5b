//! Vulkan objects, and the only `unsafe` in the crate. Knows no files and no glTF.
//!
//! Every wrapper owns one object and an `Arc<Gpu>`, and frees it in `Drop`. A frame slot holds `Arc`s of all that its commands
//! use and lets them go once its fence has signaled: deferred destruction without a queue and without a counter.

mod blank;
mod blit;
mod buffer;
mod compute;
mod descriptor;
mod device;
mod encoder;
mod error;
mod frames;
mod heap;
mod image;
mod pipeline;
mod surface;
mod ui;
mod validation;

pub use buffer::{Buffer, Memory};
pub use descriptor::{DescriptorSet, SetLayouts, SetWriter};
pub use device::{AdapterInfo, Gpu, GpuOptions, adapters};
pub use encoder::{Attachments, Encoder, Rect, Use};
pub use error::GpuError;
pub use frames::{Frames, Submission, one_shot};
pub use heap::return_freed_memory;
pub use image::{Image, ImageDesc, Sampler, SamplerDesc};
pub use pipeline::{ComputePipeline, Pipeline, PipelineDesc, PrimitiveClass, Raster, ShaderModule, Specialization};
pub use surface::{Acquired, Surface, Swapchain};
pub use ui::UiRenderer;

/// Vulkan's enums, for formats, usages and topologies in the signatures here.
pub use ash::vk;
