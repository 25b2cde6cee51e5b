//! Where everything of a model is at one moment.

use glam::Mat4;

use crate::scene::Model;

/// Where the parts of a model are at one moment. [`Model::posed`] turns it into a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Object to world of each entry of `Model::instances`. The identity for an instance with joints, which bring its vertices to the
    /// world themselves.
    pub instances: Vec<Mat4>,
    /// World from the object space of the mesh, for each joint of each node with a skin, one node after the other: the joint's world
    /// transform times its inverse bind matrix. `Instance::first_joint` points here.
    pub joints: Vec<Mat4>,
    /// Weights of the morph targets of each node with such a mesh, one node after the other. `Instance::first_weight` points here.
    pub weights: Vec<f32>,
}

impl Model {
    /// The pose of the file, without animations.
    pub fn rest_pose(&self) -> Pose {
        let instances = self.instances.iter().map(|instance| instance.world_from_object).collect();
        Pose { instances, ..Pose::default() }
    }
}
