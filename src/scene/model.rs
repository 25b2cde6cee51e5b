//! The model as plain data, which a loader fills and `render` uploads. No Vulkan, no file handles.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Mat4, Vec3};

pub use super::bounds::Bounds;
use super::environment::ModelEnvironment;
pub use super::images::Image;
pub use super::material::*;
use super::members::Member;
use super::motion::{Deformation, Motion, Pose};
pub use super::objects::*;
pub use crate::interface::Vertex;
use crate::message::did_you_mean;

/// A loaded model. All indices into its vectors are in range; otherwise the loader returns an error.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// File stem, or the built-in name.
    pub name: Arc<str>,
    /// Geometry, each primitive once. A model in another pose shares it, as it shares all that does not move.
    pub primitives: Arc<Vec<Primitive>>,
    /// Materials; index 0 is glTF's default material.
    pub materials: Arc<Vec<Material>>,
    /// Images paired with samplers.
    pub textures: Arc<Vec<Texture>>,
    /// Images, in the form of their files until the upload.
    pub images: Arc<Vec<Image>>,
    /// Names of the variants (KHR_materials_variants).
    pub variants: Arc<Vec<String>>,
    /// The nodes of the scene. A parent comes before its children, and all below a node follow it.
    pub nodes: Arc<Vec<Node>>,
    /// Primitives placed in the world: the draws.
    pub instances: Vec<Instance>,
    /// KHR_lights_punctual, placed in the world.
    pub lights: Vec<Light>,
    /// Cameras, placed in the world.
    pub cameras: Vec<Camera>,
    /// The environment that the scene names (EXT_lights_image_based).
    pub environment: Option<Arc<ModelEnvironment>>,
    /// The models that are shown together; empty for a single one.
    pub members: Arc<Vec<Member>>,
    /// How the model can move.
    pub motion: Arc<Motion>,
    /// Where everything is: the instances, lights and cameras above, and the joints and morph weights of deformed instances.
    pub pose: Arc<Pose>,
    /// Contents of the file beside the scene.
    pub contents: Arc<Contents>,
    /// World bounds of all instances, during the whole of the clips that play.
    pub bounds: Bounds,
    /// The outermost vertices in world space (hull points), for framing. If empty, framing uses the corners of `bounds`.
    pub outline: Arc<[Vec3]>,
    /// Absolute paths of all files that were read. The window watches them.
    pub files: Arc<Vec<PathBuf>>,
    /// Warnings, one sentence for each part that the loader ignored or replaced: unknown extensions, images that cannot be
    /// decoded, repaired tangents.
    pub warnings: Arc<Vec<String>>,
    /// Whether placeholders stand for its images, which are still being decoded. All else is that of the whole model.
    pub awaits_textures: bool,
    /// Loading times.
    pub timing: LoadTiming,
}

/// Milliseconds spent on each part of a load.
#[derive(Clone, Copy, Debug, Default, serde::Serialize)]
pub struct LoadTiming {
    /// Reading and parsing the file and its buffers.
    pub parse_ms: f64,
    /// Decoding images in parallel (wall time).
    pub decode_ms: f64,
    /// Generating tangents, in parallel with decoding (wall time).
    pub tangents_ms: f64,
}

/// Contents of a file, shown or not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Contents {
    /// Names of the scenes; empty for one without a name.
    pub scenes: Vec<String>,
    /// Which of them the model is.
    pub scene: usize,
    /// Meshes.
    pub meshes: usize,
    /// Names of the animations; empty for one without a name.
    pub animations: Vec<String>,
    /// Skins.
    pub skins: usize,
    /// Extensions that it uses.
    pub extensions: Vec<String>,
}

/// How indices form primitives. The loader turns a line loop into a strip. It turns a triangle strip or fan into a list if
/// it generates flat normals or tangents, since these split vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topology {
    /// Points.
    Points,
    /// Lines.
    Lines,
    /// Line strip.
    LineStrip,
    /// Triangles.
    Triangles,
    /// Triangle strip.
    TriangleStrip,
    /// Triangle fan.
    TriangleFan,
}

/// Geometry with one material.
#[derive(Clone, Debug)]
pub struct Primitive {
    /// Mesh name and primitive number, for messages.
    pub name: String,
    /// Vertices, object space.
    pub vertices: Vec<Vertex>,
    /// Indices into `vertices`; never empty.
    pub indices: Vec<u32>,
    /// Topology of the indices.
    pub topology: Topology,
    /// Index into `Model::materials`: the material in the selected variant.
    pub material: usize,
    /// Index into `Model::materials`: the material without a variant.
    pub default_material: usize,
    /// KHR_materials_variants: indices into `Model::variants` and `Model::materials`. Each variant occurs at most once.
    pub variant_materials: Vec<(usize, usize)>,
    /// `interface::ATTRIBUTE_*` bits.
    pub attributes: u32,
    /// Object-space bounds.
    pub bounds: Bounds,
    /// Joints and morph targets that move the vertices; `None` if they keep their shape.
    pub deformation: Option<Arc<Deformation>>,
}

impl Primitive {
    /// The primitive's material in a variant, or its default material if the file names no other.
    pub fn material_in(&self, variant: Option<usize>) -> usize {
        let named = self.variant_materials.iter().find(|(of, _)| Some(*of) == variant);
        named.map_or(self.default_material, |(_, material)| *material)
    }
}

impl Model {
    /// The first `most` warnings, and a sentence that counts the others.
    pub fn first_warnings(&self, most: usize) -> Vec<String> {
        let mut shown: Vec<String> = self.warnings.iter().take(most).cloned().collect();
        match self.warnings.len().saturating_sub(most) {
            0 => {}
            1 => shown.push("1 more warning is in the panel Model.".into()),
            more => shown.push(format!("{more} more warnings are in the panel Model.")),
        }
        shown
    }

    /// Index of the variant with this name; `None` for the empty name, which stands for the default materials.
    ///
    /// # Errors
    /// The model has no such variant. The message lists its variants.
    pub fn variant(&self, name: &str) -> Result<Option<usize>, String> {
        if name.is_empty() {
            return Ok(None);
        }
        self.variants.iter().position(|known| known == name).map(Some).ok_or_else(|| {
            let known = match self.variants.as_slice() {
                [] => "it has none".to_owned(),
                names => format!("it has {}", names.join(", ")),
            };
            let hint = did_you_mean(name, self.variants.iter().map(String::as_str));
            format!("the model has no variant '{name}': {known}.{hint} An empty name is the model in its own materials")
        })
    }
}

/// A node of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Node {
    /// Index in the file.
    pub index: usize,
    /// Name, or empty.
    pub name: String,
    /// Index of its parent in `Model::nodes`.
    pub parent: Option<usize>,
    /// Name of its mesh, which may be empty; `None` without a mesh.
    pub mesh: Option<String>,
    /// Index of its light in `Model::lights`.
    pub light: Option<usize>,
    /// Index of its camera in `Model::cameras`.
    pub camera: Option<usize>,
    /// Whether its meshes and lights are left out, since the file hides it or a node above it, and no clip shows it.
    pub is_hidden: bool,
}

/// A primitive placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Index into `Model::primitives`.
    pub primitive: usize,
    /// Object to world. Finite; a negative determinant flips the winding. With joints, the space to which they bring the vertices to world.
    pub world_from_object: Mat4,
    /// Index of the glTF node.
    pub node: usize,
    /// Name of the node, or empty.
    pub node_name: Arc<str>,
    /// Index of its skin's first joint in `Pose::joints`.
    pub first_joint: Option<u32>,
    /// Index of the weight of its first morph target in `Pose::weights`.
    pub first_weight: Option<u32>,
}
