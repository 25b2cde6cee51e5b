//! Draws a scene with shaders on a device. No other module knows all three.
//!
//! [`Resources`] holds all device objects, and binds a [`FrameState`](crate::frame::FrameState) to them once none is missing. A
//! [`View`] draws the resulting [`BoundFrame`].

mod bound_frame;
mod brdf;
pub(crate) mod compute;
mod environment;
mod paths;
mod resources;
mod scene;
mod texels;
pub(crate) mod tools;
mod view;

pub use bound_frame::BoundFrame;
pub(crate) use brdf::measured::measured_buffer;
pub use brdf::tables::{Tables, wrong_values};
pub use environment::bake::{BakeControl, BakeError};
pub use environment::maps::{BakeReport, GpuEnvironment};
pub use paths::{PathTracing, PathTracingError, PathTracingKey, PathTracingRequest};
pub use resources::{Missing, ProvideError, Resources};
pub use scene::{GpuModel, UploadError, texel_forms};
pub use texels::{Texel, TexelPlace, TexelReadback, read_texels, texel_places};
pub use view::{
    Capture, NotFinitePixels, Output, PixelAt, PixelModes, RangeSample, Readback, Redraw, Thumbnails, View,
    beyond_memory,
};
pub(crate) use view::{SharedImages, Sources, Uniforms};
