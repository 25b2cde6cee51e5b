//! Reads and rewrites SPIR-V modules: reflection for the contract check; specialization and bounded loops before the driver
//! sees a module.

pub mod bindings;
mod conditions;
mod declared;
mod hash;
mod hits;
pub mod hooks;
pub mod link;
pub mod loops;
mod opcode;
mod operands;
mod optimize;
pub mod primitive;
pub mod reach;
pub mod reflect;
mod specialize;
mod types;
pub mod uses;

pub use hash::behavior_hash;
pub use hits::separate_hits;
pub use optimize::optimize;
pub use specialize::{specialize, specialize_several};
