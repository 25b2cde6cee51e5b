//! The contract between Rust and GLSL: descriptor sets, bindings, specialization ids and the structs that both sides use.
//!
//! Rust writes this memory, so Rust declares it. [`glsl`] prints the contract as `shaders/interface.glsl`, and
//! `shader::contract` checks every compiled stage against [`BINDINGS`], [`SPECIALIZATION`] and [`blocks()`].
//!
//! All blocks use `scalar` layout, so a Rust `#[repr(C)]` struct of 4-byte fields and its GLSL twin agree byte for byte.
//!
//! Pipeline layouts are fixed by the contract, so a reload never changes one. A shader may use any subset of what is
//! bound for it. A tree whose `interface.glsl` is of another version is refused by name. The test
//! `interface_glsl_is_current` compares the printed file with the committed one.

mod access;
mod binding;
mod bindings;
mod blocks;
mod changes;
mod constants;
mod limits;
mod lists;
mod material;
mod print;
mod specialization;

pub use access::{Resource, StageRole};
pub use binding::{Binding, BindingKind};
pub use bindings::*;
pub use blocks::{
    Before, Block, BvhNode, Deformation, Displacement, Draw, EnvironmentCell, Frame, Influence, Light, LightGrid,
    Member, Task, TracedCorners, TracedMaterial, TracedTriangle, Vertex,
};
pub use changes::{CLOCK, KEYS, MOTION};
pub use constants::*;
pub use limits::*;
pub use lists::{block, blocks, constants};
pub use material::*;
pub use print::glsl;
pub use specialization::*;
