//! Reads what moves: skins, morph weights, animations.

pub mod animations;
pub mod pointers;
pub mod raw;
pub mod skins;
