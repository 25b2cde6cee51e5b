//! Images of a model: their texels as the file has them, and the form that they take on a device.
//!
//! A loader knows no device. So an image keeps the form of its file, and the upload chooses the form on the device once, at
//! [`Image::settle`]: the same form where the device samples it, else RGBA8, or half floats for HDR.

mod basis;
mod convert;
mod decode;
mod form;
mod image;
mod texels;

pub use basis::Basis;
pub(super) use decode::rgba8 as rgba8_of_blocks;
pub use form::{TexelForm, TexelForms};
pub use image::Image;
pub use texels::Texels;
