//! CPU data only: models, lights, camera. Knows no Vulkan; what it makes, `render` uploads.
//!
//! [`load`] turns a glTF file into a [`Model`] whose indices and numbers can be trusted: everything behind it may
//! index and divide without checks of its own. All that a file can get wrong ends in a [`LoadError`] or a warning of
//! the model.

mod built_in;
mod camera;
mod camera_controller;
mod camera_motion;
pub mod environment;
mod error;
mod features;
mod gltf;
mod lights;
mod material;
mod measured;
pub mod mips;
mod model;
mod outline;
mod pack;
mod pick;
mod texture_source;

use std::path::{Path, PathBuf};

pub use built_in::{BUILT_IN, built_in};
pub use camera::{CameraView, frame};
pub use camera_controller::CameraController;
pub use camera_motion::{FlyCamera, OrbitCamera};
pub use environment::{Environment, EnvironmentError, EnvironmentFile};
pub use error::{LoadError, Problem};
pub use features::{features, packs_occlusion};
pub use lights::{light_count, lights};
pub use measured::{Measured, MeasuredError, MeasuredKind, MeasuredProblem};
pub use model::*;
pub use pack::pack_material;
pub use pick::near_pixel;
pub use texture_source::{TextureSource, texture_sources};

/// What a load may do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Read files that the model names by absolute paths or outside of its own folder (`--allow-outside`).
    pub allow_outside: bool,
}

/// Loads what the user named: a file, or else a built-in model of that name; without a name the first of those.
///
/// # Errors
/// As [`load`].
pub fn open(path: Option<&Path>, options: &LoadOptions) -> Result<Model, LoadError> {
    let name = path.map_or(Some(BUILT_IN[0]), |path| if path.exists() { None } else { path.to_str() });
    match (name.and_then(built_in), path) {
        (Some(model), _) => model,
        (None, path) => load(path.unwrap_or(Path::new("")), options),
    }
}

/// Loads a `.gltf` or `.glb` file, told apart by content.
///
/// # Errors
/// When the file or one that it names cannot be read, is invalid, or needs what Specula lacks. Never panics on any
/// content.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Model, LoadError> {
    let mut files = Vec::new();
    let loaded = gltf::load_file(path, options, &mut files);
    loaded.map_err(|problem| LoadError { file: path.to_owned(), problem: Box::new(problem), files })
}

/// Loads a self-contained model from memory: a `.glb`, or JSON with data URIs. `name` is for messages and the model.
///
/// # Errors
/// As [`load`]; external files are refused.
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Model, LoadError> {
    let file = PathBuf::from(name);
    let loaded = gltf::load_memory(name, bytes);
    loaded.map_err(|problem| LoadError { file, problem: Box::new(problem), files: Vec::new() })
}
