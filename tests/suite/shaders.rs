//! Shaders from text to pipeline: reloads, hooks, kinds of stages, loops, control flow, modes.

mod control_flow;
mod expressions;
mod hooks;
mod interface;
mod loops;
mod modes;
mod random_programs;
mod reload;
mod spirv;
mod stages;
mod thumbnails;
