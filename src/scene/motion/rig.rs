//! The hierarchy of a model that moves: nodes, skins, and what stands where.

use std::ops::Range;

use glam::{DMat4, DVec3};

use super::transform::Transform;

/// The hierarchy. All indices are in range.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    /// The nodes, parents before children: first those of `Model::nodes`, then joints outside of the scene, and the nodes above them.
    pub nodes: Vec<RigNode>,
    /// The skins that instances have.
    pub skins: Vec<Skin>,
    /// The node or skin that each entry of `Model::instances` follows.
    pub instances: Vec<Placement>,
    /// The node of each entry of `Model::lights`, and the light's index in the file.
    pub lights: Vec<(usize, usize)>,
    /// The node of each entry of `Model::cameras`, and the camera's index in the file.
    pub cameras: Vec<(usize, usize)>,
    /// Taken from all positions, since the model is far from the origin.
    pub shift: DVec3,
}

/// A node.
#[derive(Clone, Debug)]
pub struct RigNode {
    /// Index in the file.
    pub index: usize,
    /// Its parent among the nodes.
    pub parent: Option<usize>,
    /// Its transform in the file.
    pub rest: Transform,
    /// The same as a matrix, which may have shear.
    pub parent_from_node: DMat4,
    /// World from node in the file's own pose; finite.
    pub world_from_node: DMat4,
    /// Whether the file hides it, and so all below it (KHR_node_visibility), until a clip shows it.
    pub is_hidden: bool,
    /// Its morph weights in `Pose::weights`.
    pub weights: Range<usize>,
}

/// A skin.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Name, or empty.
    pub name: String,
    /// Index in the file.
    pub index: usize,
    /// The node of each joint, and joint from mesh at the time of binding; finite.
    pub joints: Vec<(usize, DMat4)>,
}

/// The node or skin that an instance follows.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Its node.
    pub node: usize,
    /// Node from object, if the node shows its mesh many times (EXT_mesh_gpu_instancing).
    pub node_from_object: Option<Box<DMat4>>,
    /// Its skin, which moves it instead of the node.
    pub skin: Option<usize>,
}

impl Rig {
    /// Whether the file hides each node itself.
    pub fn hidden_nodes(&self) -> Vec<bool> {
        self.nodes.iter().map(|node| node.is_hidden).collect()
    }

    /// The lights of the model that are this one of the file.
    pub fn lights_of(&self, index: usize) -> impl Iterator<Item = usize> {
        (0..).zip(&self.lights).filter(move |(_, (_, source))| *source == index).map(|(light, _)| light)
    }

    /// The cameras of the model that are this one of the file.
    pub fn cameras_of(&self, index: usize) -> impl Iterator<Item = usize> {
        (0..).zip(&self.cameras).filter(move |(_, (_, source))| *source == index).map(|(camera, _)| camera)
    }

    /// The first entry of `Pose::joints` of each skin.
    pub fn first_joints(&self) -> impl Iterator<Item = usize> {
        self.skins.iter().scan(0, |next, skin| Some(std::mem::replace(next, *next + skin.joints.len())))
    }
}
