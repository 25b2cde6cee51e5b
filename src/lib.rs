//! Specula, a hot-reloading shader playground: it watches a GLSL tree, recompiles it while it runs and rebuilds the pipelines of a
//! glTF PBR viewer in place. One rule stands above all others: **a save never costs the user the picture.**
//!
//! The house, from the ground up; a module imports only from those above it in this list:
//!
//! - [`message`]: escapes and nearest names for messages.
//! - [`interface`]: the contract between Rust and GLSL.
//! - [`settings`]: everything a user can set.
//! - [`shader`]: files to SPIR-V. Knows no device and no scene.
//! - [`events`]: what happened, as JSON lines.
//! - [`gpu`]: Vulkan objects, the only `unsafe`. Knows no files and no glTF.
//! - [`scene`]: CPU data: glTF, tangents, camera, lights.
//! - [`render`]: where shaders, device and scene meet.
//! - [`picture`], [`comparison`], [`headless`]: captures as files; how far two are apart; rendering without a window.
//! - [`app`]: the window.
//!
//! The way of an edit: a file event becomes a settled set of changed paths ([`shader::watch`]), the set becomes dirty stages and new
//! SPIR-V ([`shader::library`]), that becomes a new pipeline set ([`render::Reloader`]), which is swapped in between two frames.
//! An error anywhere before the swap yields diagnostics and changes nothing else.

pub mod app;
pub mod comparison;
pub mod events;
pub mod gpu;
pub mod headless;
pub mod interface;
pub mod message;
pub mod picture;
pub mod render;
pub mod scene;
pub mod settings;
pub mod shader;
