//! Models on their way to the device, and what a look changes of them.

mod beside;
mod blending;
mod cameras;
mod deform;
mod draws;
mod gpu;
mod look;
mod materials;
mod textures;
mod upload;
mod visibility;
