//! The textures that a tree declares: image files, read as bytes.

use std::sync::Arc;

use super::Input;
use crate::shader::annotation::pass::{TextureNote, Wrap};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};

/// An image file of the tree that passes sample.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    /// Name in GLSL.
    pub name: String,
    /// Path in the tree.
    pub path: String,
    /// Whether its colors are sRGB-encoded.
    pub srgb: bool,
    /// Addressing mode.
    pub wrap: Wrap,
    /// Whether it has mip levels.
    pub mips: bool,
    /// The content of the file.
    pub bytes: Arc<[u8]>,
    /// The parsed `//@texture`.
    pub note: TextureNote,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Texture").field("name", &self.name).field("path", &self.path).finish_non_exhaustive()
    }
}

/// The name of the texture that an input reads.
pub(super) fn texture_name(input: &Input) -> Option<&str> {
    match input {
        Input::Texture(name) => Some(name),
        _ => None,
    }
}

/// Reads the file of a texture.
///
/// # Errors
/// The file does not exist, cannot be read, or lies outside of the tree: at the line of the annotation.
pub(super) fn read_texture(note: &TextureNote, snapshot: &Snapshot<'_>) -> Result<Texture, Box<Diagnostic>> {
    let source = snapshot.source();
    let beside = TreePath::from(note.declared_in.as_str()).sibling(&note.image);
    let mut candidates: Vec<TreePath> = beside.into_iter().chain(TreePath::parse(&note.image)).collect();
    candidates.dedup();
    let refuse = |message: String| Err(Box::new(note.place.error(message)));
    if candidates.is_empty() {
        return refuse(format!("\"{}\" leaves the shader tree; images must stay inside its root", note.image));
    }
    for path in &candidates {
        match source.read_bytes(path) {
            Ok(bytes) => {
                let TextureNote { name, srgb, wrap, mips, .. } = note.clone();
                return Ok(Texture {
                    name,
                    path: path.to_string(),
                    srgb,
                    wrap,
                    mips,
                    bytes: bytes.into(),
                    note: note.clone(),
                });
            }
            Err(SourceError::Missing) => {}
            Err(error) => return refuse(format!("{} {error}", snapshot.display_path(path))),
        }
    }
    let looked: Vec<String> = candidates.iter().map(|path| snapshot.display_path(path)).collect();
    refuse(format!("\"{}\" not found; looked for {}", note.image, looked.join(" and ")))
}
