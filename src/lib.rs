//! Specula, a hot-reloading shader playground: it watches a GLSL tree, recompiles it while it runs and rebuilds the pipelines of
//! a glTF PBR viewer in place. One rule stands above all others: **a save never costs the user the picture.**
//!
//! The modules, from the ground up; each imports only from those above it in this list:
//!
//! - [`message`]: escapes and nearest names for messages.
//! - [`interface`]: the contract between Rust and GLSL.
//! - [`settings`]: everything a user can set.
//! - [`shader`]: files to SPIR-V. Knows no device and no scene.
//! - [`gpu`]: Vulkan objects, the only `unsafe`. Knows no files and no glTF.
//! - [`scene`]: CPU data: glTF, tangents, camera, lights.
//! - [`render`]: where shaders, device and scene meet: frame states, resources, views.
//! - [`events`]: what happens, as JSON lines.
//! - [`session`]: what the user works on; it survives the device.
//! - [`picture`], [`comparison`], [`headless`], [`measure`]: captures as files; how far two are apart; rendering, and measuring the
//!   BRDF, without a window.
//! - [`app`]: the window.
//!
//! An edit becomes a settled set of changed paths ([`shader::watch`]), then dirty stages and new SPIR-V ([`shader::library`]), then
//! a new pipeline set ([`render::Reloader`]), which the next frame uses as a whole. An error anywhere before that yields
//! diagnostics and changes nothing else.

pub mod app;
pub mod comparison;
mod disk_cache;
pub mod events;
pub mod file_kind;
pub mod gpu;
pub mod headless;
pub mod interface;
pub mod measure;
pub mod message;
pub mod picture;
pub mod render;
pub mod scene;
pub mod session;
pub mod settings;
pub mod shader;
