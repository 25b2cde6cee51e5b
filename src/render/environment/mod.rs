//! Image-based light: environments baked on the device.

pub(super) mod bake;
pub(super) mod maps;
mod passes;
mod transfer;
