//! Reads and rewrites SPIR-V modules: reflection for the contract check; specialization and bounded loops before the driver
//! sees a module.

mod conditions;
mod declared;
mod hash;
pub mod loops;
mod opcode;
pub mod reflect;
mod specialize;

pub use hash::behavior_hash;
pub use specialize::specialize;
