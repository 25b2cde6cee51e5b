//! The integration tests, in one binary: it links the library once, and all tests of the process share two devices, one compiler and the
//! compiled shader tree. Run a part of them by its path: `scripts/test light::baked`.

#![allow(clippy::print_stdout, reason = "tests print what they measure")]

mod architecture;
mod commands;
mod light;
mod passes;
mod picture;
mod scene;
mod shaders;
mod support;
mod window;
