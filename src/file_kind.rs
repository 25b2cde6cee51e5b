//! Tells what a file or folder is, by its ending and content, so that a wrong one is answered with what to do with it.

use std::path::Path;

use crate::shader::is_specula_tree;

/// Most files of a folder that are listed.
const MOST_LISTED: usize = 5000;

/// The use that Specula has for a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// glTF: `.gltf`, `.glb`, or a `.zip` with one.
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
    /// Whether it is a folder.
    pub fn is_folder(self) -> bool {
        matches!(self, Self::ShaderTree | Self::Folder)
    }

    /// The kind of `path`. Only folders are read.
    pub fn of(path: &Path) -> Self {
        if path.is_dir() {
            return if is_specula_tree(path) { Self::ShaderTree } else { Self::Folder };
        }
        match path.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
            "gltf" | "glb" | "zip" => Self::Model,
            "hdr" | "exr" => Self::Environment,
            "binary" | "bin" => Self::Measured,
            "toml" | "png" => Self::Look,
            "glsl" | "vert" | "tesc" | "tese" | "geom" | "task" | "mesh" | "frag" | "fs" | "comp" => Self::Shader,
            _ => Self::Other,
        }
    }
}

/// Paths of the models in a folder, sorted; none where it cannot be read.
pub fn models_in(folder: &Path) -> Vec<String> {
    let place = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let names = std::fs::read_dir(place).into_iter().flatten().flatten().map(|entry| folder.join(entry.file_name()));
    let is_model =
        |path: &Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb") || e.eq_ignore_ascii_case("gltf"));
    let mut models: Vec<String> = names.filter(|path| is_model(path)).map(|path| path.display().to_string()).collect();
    models.sort();
    models
}

/// A file or folder in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Listed {
    pub(crate) name: String,
    pub(crate) kind: FileKind,
}

/// The folders in a folder, then its files, by their names. `may_be`: whether a file with the ending of a kind may be of it; others are
/// [`FileKind::Other`].
///
/// # Errors
/// A message: it cannot be read.
pub(crate) fn list(folder: &Path, may_be: impl Fn(FileKind, &Path) -> bool) -> Result<Vec<Listed>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let listed = |entry: std::fs::DirEntry| {
        let path = entry.path();
        let kind = Some(FileKind::of(&path)).filter(|kind| may_be(*kind, &path)).unwrap_or(FileKind::Other);
        Some(Listed { kind, name: entry.file_name().into_string().ok()? })
    };
    let mut files: Vec<Listed> = entries.flatten().take(MOST_LISTED).filter_map(listed).collect();
    files.sort_by_key(|file| (!file.kind.is_folder(), file.name.to_lowercase()));
    Ok(files)
}
