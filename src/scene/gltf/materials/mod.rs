//! Materials, their extensions, textures and images.

pub mod conductor;
pub mod images;
pub mod material;
pub mod placeholder;
pub mod reader;
pub mod textures;
