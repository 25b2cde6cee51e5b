//! Reads and rewrites SPIR-V modules: reflection for the contract check, and specialization before the driver sees a
//! module.

mod conditions;
mod declared;
mod opcode;
pub mod reflect;
mod specialize;

pub use specialize::specialize;
