//! All blocks and constants of the contract.

use super::blocks::{Block, FRAME_BLOCKS, OTHER_BLOCKS};
use super::constants::{MODE_CONSTANTS, OTHER_CONSTANTS};
use super::material::{MATERIAL_BLOCKS, MATERIAL_CONSTANTS};

/// Every struct of the contract, in the order in which GLSL needs them.
pub fn blocks() -> impl Iterator<Item = &'static Block> {
    FRAME_BLOCKS.iter().chain(MATERIAL_BLOCKS).chain(OTHER_BLOCKS)
}

/// The struct of this name.
pub fn block(name: &str) -> Option<&'static Block> {
    blocks().find(|block| block.name == name)
}

/// Name and value of every constant that GLSL compares with.
pub fn constants() -> impl Iterator<Item = (&'static str, u32)> {
    MODE_CONSTANTS.iter().chain(MATERIAL_CONSTANTS).chain(OTHER_CONSTANTS).copied()
}
