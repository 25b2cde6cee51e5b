//! Specializes a module before the driver sees it: sets the constants, takes the branches that they decide, and drops
//! functions that nothing calls anymore.
//!
//! A driver does the same, but most inline every function first. In a shader whose debug modes and material extensions
//! all depend on constants, that is four times the code that a pipeline keeps. See the SPIR-V specification, section
//! 2.11, for the rules of structured control flow, and section 3.52 for the opcodes.

mod several;
mod single;

pub use several::specialize_several;
pub use single::specialize;
