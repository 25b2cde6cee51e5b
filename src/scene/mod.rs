//! CPU data: models, lights, camera. This module uses no Vulkan; `render` uploads its data.
//!
//! [`load`] turns a glTF file into a [`Model`] and checks all indices and numbers, so that later code may index and divide
//! without checks. An error in the file becomes a [`LoadError`] or a warning of the model.

pub mod background;
mod bounds;
mod built_in;
mod bvh;
mod camera;
pub mod environment;
mod error;
mod extensions;
mod features;
mod gltf;
mod images;
mod lacking;
mod light_grid;
mod lights;
mod load_options;
mod material;
mod measured;
mod members;
pub mod mips;
mod model;
mod motion;
mod objects;
mod outline;
mod pack;
mod pick;
mod pictures;
mod placed;
mod posing;
mod replace;
mod texture_source;
mod together;
mod visibility;

use std::path::{Path, PathBuf};

pub use built_in::{BUILT_IN, built_in};
pub use bvh::Bvh;
pub use camera::{CameraController, CameraView, FlyCamera, OrbitCamera, Parallel, view_of};
pub use environment::{Environment, EnvironmentError, EnvironmentFile, Sun, has_exact_sun, separates_suns};
pub use error::{LoadError, Problem};
pub use extensions::MaterialFactor;
pub use features::{features, packs_occlusion};
pub use gltf::{find_model, triangles};
pub use images::{Basis, TexelForm, TexelForms, Texels};
pub use light_grid::LightGrid;
pub use lights::{light_count, light_direction, light_names, lights, rectangle_corners, view_of_light};
pub use load_options::{Caller, Canceled, LoadOptions};
pub use measured::{MeasuredBrdf, MeasuredError, MeasuredKind, MeasuredProblem};
pub use members::{Member, Places};
pub use model::*;
pub use motion::{Clip, Curve, Deformation, Displacement, Influence, Motion, Playing, Pose, Reach, Skin, Target};
pub use pack::pack_material;
pub use pick::{Hit, Sides, near_pixel, pick, ray};
pub use pictures::{BuiltInPictures, PICTURE_SIZE, built_in_pictures};
pub use posing::{held_entry, moved_environment, moved_materials};
pub use replace::{material_factors, override_material, replace_channels, replace_factors};
pub use texture_source::{TextureSource, slot_name, texture_sources};

/// Loads a file, or else the built-in model of that name. Without a path, loads the first built-in model. Those that `options` add stand
/// beside it.
///
/// # Errors
/// As [`load`].
pub fn open(path: Option<&Path>, options: &LoadOptions) -> Result<Model, LoadError> {
    open_for(path, options, Caller::until(&|| false))
}

/// As [`open`], until the caller cancels it. One model alone is given to the caller early, if it wants that.
///
/// # Errors
/// As [`load`], or [`Problem::Canceled`].
pub fn open_for(path: Option<&Path>, options: &LoadOptions, caller: Caller<'_>) -> Result<Model, LoadError> {
    if options.added.is_empty() {
        return open_one(path, options, caller);
    }
    let caller = Caller::until(caller.canceled);
    let first = open_one(path, options, caller)?;
    let own = LoadOptions { scene: None, ..options.clone() };
    let mut models = vec![(String::new(), first)];
    for file in &options.added {
        let loaded = open_one(Some(Path::new(file)), &own, caller);
        let tried = || models.iter().flat_map(|(_, model)| model.files.iter().cloned());
        let model = loaded.map_err(|error| LoadError { files: tried().chain(error.files).collect(), ..error })?;
        models.push((file.clone(), model));
    }
    Ok(together::side_by_side(models))
}

fn open_one(path: Option<&Path>, options: &LoadOptions, caller: Caller<'_>) -> Result<Model, LoadError> {
    let name = path.map_or(Some(BUILT_IN[0]), |path| if path.exists() { None } else { path.to_str() });
    match (name.and_then(built_in), path) {
        (Some(model), _) => model,
        (None, path) => load_for(path.unwrap_or(Path::new("")), options, caller),
    }
}

/// Loads a `.gltf` or `.glb` file; the content decides which of the two it is. From a folder or a `.zip` archive, loads the model in it: the
/// only one, or the only one that is nearest to its root. `a.zip/b.glb` is a model in an archive.
///
/// # Errors
/// Fails if the file or a file that it names cannot be read or is invalid, or requires an unsupported extension. Never
/// panics, whatever the content.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Model, LoadError> {
    load_for(path, options, Caller::until(&|| false))
}

fn load_for(path: &Path, options: &LoadOptions, caller: Caller<'_>) -> Result<Model, LoadError> {
    let mut files = Vec::new();
    let loaded = gltf::load_file(path, options, caller, &mut files);
    loaded.map_err(|problem| LoadError { file: path.to_owned(), problem: Box::new(problem), files })
}

/// Loads a self-contained model from memory: a `.glb`, or JSON with data URIs. `name` becomes the model's name.
///
/// # Errors
/// As [`load`]; external files are refused.
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Model, LoadError> {
    let file = PathBuf::from(name);
    let loaded = gltf::load_memory(name, bytes);
    loaded.map_err(|problem| LoadError { file, problem: Box::new(problem), files: Vec::new() })
}
