//! Specula.
pub mod interface;
pub mod settings;
pub mod gpu;
