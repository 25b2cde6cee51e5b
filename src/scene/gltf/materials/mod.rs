//! Materials, their extensions, textures and images.

pub mod conductor;
pub mod images;
mod ktx2;
pub mod material;
pub mod placeholder;
pub mod reader;
pub mod textures;
