//! Reads and rewrites SPIR-V modules: declarations for the contract, and specialization before the driver sees a module.

mod conditions;
mod declared;
mod opcode;
pub mod reflect;
mod specialize;

pub use specialize::specialize;
