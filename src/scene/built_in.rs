//! The models that are part of the program, so that it shows something from any directory.

use super::{LoadError, Model, load_bytes};

/// Names of the built-in models; the first is the default.
pub const BUILT_IN: [&str; 2] = ["shader-ball", "sphere-grid"];

/// A built-in model by its name.
///
/// # Errors
/// As [`load_bytes`]; `None` for a name that is not in [`BUILT_IN`].
pub fn built_in(name: &str) -> Option<Result<Model, LoadError>> {
    let bytes: &[u8] = match name {
        "shader-ball" => include_bytes!("../../assets/shader-ball.glb"),
        "sphere-grid" => include_bytes!("../../assets/sphere-grid.glb"),
        _ => return None,
    };
    Some(load_bytes(name, bytes))
}
