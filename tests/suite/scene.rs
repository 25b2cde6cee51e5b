//! Models on their way to the device, and what a look changes of them.

mod beside;
mod cameras;
mod deform;
mod gpu;
mod look;
mod materials;
mod upload;
