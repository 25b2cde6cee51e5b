//! Tells what a file or folder is, by its ending and content, so that a wrong one is answered with what to do with it.

use std::path::Path;

use crate::shader::is_specula_tree;

/// The use that Specula has for a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// glTF: `.gltf`, `.glb`.
    Model,
    /// `.hdr`, `.exr`.
    Environment,
    /// Measured BRDF: `.binary` (MERL), `.bin` (UTIA).
    Measured,
    /// Settings: `.toml`, or a `.png` that Specula has written.
    Look,
    /// A single file of a shader tree.
    Shader,
    /// A folder with a shader tree.
    ShaderTree,
    /// A folder that is not a shader tree.
    Folder,
    /// Anything else.
    Other,
}

impl FileKind {
    /// The kind of `path`. Only folders are read.
    pub fn of(path: &Path) -> Self {
        if path.is_dir() {
            return if is_specula_tree(path) { Self::ShaderTree } else { Self::Folder };
        }
        match path.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
            "gltf" | "glb" => Self::Model,
            "hdr" | "exr" => Self::Environment,
            "binary" | "bin" => Self::Measured,
            "toml" | "png" => Self::Look,
            "glsl" | "vert" | "tesc" | "tese" | "geom" | "task" | "mesh" | "frag" | "fs" | "comp" => Self::Shader,
            _ => Self::Other,
        }
    }
}
