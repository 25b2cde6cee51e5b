//! The parts of the JSON about motion that the parser refuses or drops: channels without a node, displacements of texture coordinates and
//! colors, names of morph targets.

use std::collections::BTreeMap;

use gltf::json;
use serde::Deserialize;

/// A morph target: the accessor of each attribute.
pub type RawTarget = BTreeMap<String, json::Value>;

/// The file, as far as it is about motion.
#[derive(Default, Deserialize)]
pub struct Raw {
    /// Animations.
    #[serde(default)]
    pub animations: Vec<json::Value>,
    #[serde(default)]
    meshes: Vec<RawMesh>,
}

/// A mesh.
#[derive(Default, Deserialize)]
pub struct RawMesh {
    extras: Option<json::Value>,
    #[serde(default)]
    primitives: Vec<RawPrimitive>,
}

#[derive(Deserialize)]
struct RawPrimitive {
    targets: Option<Vec<RawTarget>>,
}

impl Raw {
    /// Reads the JSON, which the parser has accepted, again if it has such parts.
    pub fn parse(text: &[u8]) -> Self {
        let text = std::str::from_utf8(text).unwrap_or_default();
        let has_some = ["\"animations\"", "\"targets\""].iter().any(|name| text.contains(name));
        if has_some { json::deserialize::from_str(text).unwrap_or_default() } else { Self::default() }
    }

    /// A mesh.
    pub fn mesh(&self, index: usize) -> &RawMesh {
        static NONE: RawMesh = RawMesh { extras: None, primitives: Vec::new() };
        self.meshes.get(index).unwrap_or(&NONE)
    }
}

impl RawMesh {
    /// The morph targets of a primitive.
    pub fn targets(&self, primitive: usize) -> &[RawTarget] {
        self.primitives.get(primitive).and_then(|primitive| primitive.targets.as_deref()).unwrap_or_default()
    }

    /// How many morph targets it has.
    pub fn target_count(&self) -> usize {
        (0..self.primitives.len()).map(|primitive| self.targets(primitive).len()).max().unwrap_or_default()
    }

    /// The name of a morph target, or empty.
    pub fn target_name(&self, target: usize) -> &str {
        let names = self.extras.as_ref().and_then(|extras| extras.get("targetNames"));
        names.and_then(|names| names.get(target)?.as_str()).unwrap_or_default()
    }
}
