//! Reads and rewrites SPIR-V modules: reflection for the contract check; specialization and bounded loops before the driver
//! sees a module.

pub mod bindings;
pub mod checks;
mod conditions;
pub mod cost;
mod declared;
mod draw_index;
mod enums;
mod evaluate;
mod finish;
mod fold;
mod hash;
mod hits;
pub mod hooks;
mod initial;
pub mod link;
pub mod loops;
mod module;
mod op;
mod optimize;
pub mod primitive;
pub mod reach;
pub mod reflect;
mod specialize;
pub mod trace;
pub mod uses;
mod validate;

pub use bindings::rename_functions;
pub use draw_index::can_index_draws;
pub use finish::{Finished, finish};
pub use hash::behavior_hash;
pub use module::Module;
pub use optimize::optimize;
pub use specialize::{specialize, specialize_several};
pub use validate::validate;
