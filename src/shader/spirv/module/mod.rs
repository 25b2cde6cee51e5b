//! A SPIR-V module that can be read and rewritten. All passes over modules work on this type.
//!
//! The words of all instructions stand in one arena. An [`Instruction`] is a range of it, so lists of instructions are cheap to copy,
//! and an instruction can be changed in its place. New instructions are appended to the arena. What no list names is not written.

mod declare;
mod function;
mod instruction;
mod query;
mod types;
mod words;

pub use instruction::{Block, Function, Id, Instruction};
pub use types::Type;
pub use words::Module;

#[cfg(test)]
mod tests;
