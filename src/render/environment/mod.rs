//! Image-based light: environments baked on the device.

pub(super) mod bake;
mod passes;
