//! Where everything of a model is at one moment.

use glam::Mat4;

use super::clip::Clip;
use super::hidden::Hidden;
use super::property::Values;
use super::rig::Rig;
use crate::scene::objects::{Camera, Light};

/// How a model can move. The default cannot.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The animations of the file, in its order.
    pub clips: Vec<Clip>,
    /// The hierarchy that they move. Without clips and skins it is empty.
    pub rig: Rig,
    /// The properties of materials, lights and cameras that clips move, as they are in the file.
    pub values: Vec<Values>,
    /// Names of the morph targets of each entry of `Pose::weights`; empty for one without a name.
    pub target_names: Vec<String>,
}

/// A clip that plays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playing {
    /// Index into `Motion::clips`.
    pub clip: usize,
    /// How far it replaces the pose without it, 0..1.
    pub weight: f32,
    /// Time in the clip, seconds.
    pub time_s: f64,
}

/// Where the parts of a model are at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Object to world of each entry of `Model::instances`. For an instance with joints the identity, since these bring its vertices to the
    /// world themselves; or a mirror if they mirror, which `joints` then undo, so that the winding follows from it as for all others.
    pub instances: Vec<Mat4>,
    /// World from the object space of the mesh, for each joint of each skin, one skin after the other: the joint's world transform
    /// times its inverse bind matrix. `Instance::first_joint` points here.
    pub joints: Vec<Mat4>,
    /// Weights of the morph targets of each node with such a mesh, one node after the other. `Instance::first_weight` points here.
    pub weights: Vec<f32>,
    /// `Model::lights`.
    pub lights: Vec<Light>,
    /// `Model::cameras`.
    pub cameras: Vec<Camera>,
    /// `Motion::values`, as they are at the moment.
    pub values: Vec<Values>,
    /// The parts that are not shown.
    pub hidden: Hidden,
}

impl Pose {
    /// Whether both have the same materials.
    pub fn has_same_materials(&self, other: &Self) -> bool {
        fn of_materials(pose: &Pose) -> impl Iterator<Item = &Values> {
            pose.values.iter().filter(|values| values.property.material().is_some())
        }
        of_materials(self).eq(of_materials(other))
    }

    /// Whether joints or morph targets move vertices.
    pub fn deforms(&self) -> bool {
        !self.joints.is_empty() || !self.weights.is_empty()
    }
}
