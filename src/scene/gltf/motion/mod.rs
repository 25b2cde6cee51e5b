//! Reads what moves: skins, morph weights, animations.

pub mod animations;
mod pointers;
pub mod raw;
pub mod skins;

pub use pointers::EXTENSION as ANIMATION_POINTER;
