//! Materials, their extensions, textures and images.

pub mod extensions;
pub mod images;
pub mod material;
pub mod placeholder;
pub mod textures;
