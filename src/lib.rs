//! Specula, a hot-reloading shader playground: it watches a GLSL tree, recompiles it while it runs and rebuilds the pipelines of
//! a glTF PBR viewer in place. The first rule of its design: **a save never costs the user the picture.**
//!
//! Each module imports only from modules above it in this list:
//!
//! - [`cpu_clock`]: CPU time of a thread.
//! - [`process_end`]: ends the process while its threads run.
//! - [`statistics`]: how certain the difference of two times is.
//! - `distribution`: names packages of the user's Linux distribution.
//! - [`message`]: escapes text for the terminal, and suggests the nearest valid name.
//! - [`report`]: pages of HTML about a result.
//! - [`interface`]: the contract between Rust and GLSL.
//! - [`settings`]: all settings of the user.
//! - [`shader`]: compiles files to SPIR-V. Has no device and no scene.
//! - [`gpu`]: Vulkan objects, the only `unsafe` code. Reads no files and no glTF.
//! - [`scene`]: CPU data: glTF, tangents, camera, lights.
//! - [`frame`]: a picture as a value: the frame state, a pure function of settings, shaders and scene.
//! - [`pipeline`]: pipelines of a shader generation, and the reload that makes the next.
//! - [`render`]: draws frame states on a device: resources, views.
//! - [`control`]: commands from outside, as JSON lines on stdin or on a local socket.
//! - [`events`]: events as JSON lines.
//! - [`session`]: what the user works on; it survives the loss of the device.
//! - [`recovery`]: what a window hands to the process that takes its place after a loss.
//! - [`headless`], [`measure`]: render, and measure the BRDF, without a window.
//! - [`picture`], [`picture_difference`]: write captured frames to files, and compare pictures.
//! - [`learn`]: exercises, and the measurements that check them.
//! - [`lsp`]: a language server for editors.
//! - [`mcp`]: a server for agents.
//! - [`write_back`]: writes changed values into the files of a shader tree.
//! - [`capture`]: contact sheets and animations of many pictures.
//! - `threads`: what a window does in the background: compiles, loads, bakes.
//! - [`app`]: the window.
//!
//! An edit passes three steps. [`shader::watch`] collects the changed paths, [`shader::library`] compiles the dirty stages, and
//! [`pipeline::Reloader`] builds a new pipeline set, which the next frame uses as a whole. An error in any step yields diagnostics
//! and changes nothing else.

pub mod app;
mod astc;
mod cancel;
pub mod capture;
pub mod control;
pub mod cpu_clock;
#[cfg(test)]
mod damaged;
mod disk_cache;
mod distribution;
pub mod events;
pub mod file_kind;
pub mod frame;
#[cfg(any(test, fuzzing))]
pub mod fuzz;
pub mod gpu;
pub mod headless;
mod identity;
pub mod interface;
pub mod learn;
pub mod lsp;
pub mod mcp;
pub mod measure;
pub mod message;
pub mod picture;
pub mod picture_difference;
pub mod pipeline;
pub mod process_end;
pub mod recovery;
mod regular_file;
pub mod render;
pub mod report;
pub mod scene;
pub mod session;
pub mod settings;
pub mod shader;
mod state_folder;
pub mod statistics;
mod threads;
pub mod write_back;
