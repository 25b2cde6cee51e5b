//! What keys, panels and dropped files ask the viewer to do beyond changing a setting.

use std::path::{Path, PathBuf};

use crate::shader::is_specula_tree;

/// A request to the viewer.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Command {
    /// Compile everything again.
    Reload,
    /// Look at the whole model again.
    FrameModel,
    /// Write the picture to a file.
    Screenshot,
    /// Close the window.
    Quit,
    /// Show a message for a few seconds.
    Say(String),
    /// Open a shader tree.
    OpenTree(PathBuf),
    /// Open a model.
    OpenModel(PathBuf),
    /// Open an environment.
    OpenEnvironment(PathBuf),
    /// Open a measured BRDF and show it.
    OpenMeasured(PathBuf),
}

/// The command that opens a file or folder, by its ending and content.
///
/// # Errors
/// Nothing that Specula opens, in words.
pub(super) fn open_as(path: &Path) -> Result<Command, String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let path = path.to_owned();
    match ending.as_str() {
        _ if path.is_dir() && is_specula_tree(&path) => Ok(Command::OpenTree(path)),
        _ if path.is_dir() => Err(format!(
            "{} is no Specula shader tree: it has no interface.glsl. `specula new DIR` writes one",
            path.display()
        )),
        "gltf" | "glb" => Ok(Command::OpenModel(path)),
        "hdr" | "exr" => Ok(Command::OpenEnvironment(path)),
        "binary" | "bin" => Ok(Command::OpenMeasured(path)),
        _ => Err(format!(
            "{}: expected a .gltf or .glb model, an .hdr or .exr environment, a measured .binary or .bin, or a folder with a \
             shader tree",
            path.display()
        )),
    }
}
