//! Vulkan objects, and the only `unsafe` code in the crate. This layer knows no files and no glTF.
//!
//! Every wrapper owns one object and an `Arc<Gpu>`, and frees the object in `Drop`. A frame slot holds an `Arc` of every resource
//! that its commands use, and releases them once its fence has signaled. So the last `Arc` destroys an object at the right time,
//! without a deletion queue.

mod adapter;
mod blank;
mod blit;
mod buffer;
mod compute;
mod copy;
mod debug;
mod descriptor;
mod device;
mod encoder;
mod error;
pub mod fault;
mod frames;
mod heap;
mod image;
mod instance;
mod memory;
mod pass;
mod pipeline;
mod sampler;
mod slot;
mod surface;
mod swapchain;
mod ui;
mod validation;

pub use adapter::{AdapterInfo, adapters};
pub use buffer::{Buffer, Memory};
pub use descriptor::{DescriptorSet, SetLayouts, SetWriter};
pub use device::{Gpu, GpuOptions};
pub use encoder::{Attachments, Encoder, Rect, Use};
pub use error::GpuError;
pub use frames::{Frames, one_shot};
pub use heap::return_freed_memory;
pub use image::{Image, ImageDesc};
pub use pass::PassTime;
pub use pipeline::{ComputePipeline, Pipeline, PipelineDesc, PrimitiveClass, Raster, ShaderModule, Specialization};
pub use sampler::{Sampler, SamplerDesc};
pub use slot::Submission;
pub use surface::Surface;
pub use swapchain::{Acquired, Swapchain};
pub use ui::UiRenderer;

/// Vulkan's enums, for formats, usages and topologies in the signatures of this module.
pub use ash::vk;
