//! The vertices of instances as joints and morph targets have moved them.

use std::borrow::Cow;

use glam::Mat4;

use crate::interface::Vertex;
use crate::scene::model::{Instance, Model, Primitive};
use crate::scene::motion::{Deformation, Pose};

impl Pose {
    /// The joints and the weights of an instance. Both are empty for one that keeps its shape.
    pub fn deformers(&self, instance: &Instance, deformation: &Deformation) -> (&[Mat4], &[f32]) {
        let weights = instance.first_weight.and_then(|first| self.weights.get(first as usize..)).unwrap_or_default();
        let joints = instance.first_joint.and_then(|first| self.joints.get(first as usize..)).unwrap_or_default();
        (joints, &weights[..deformation.targets.len().min(weights.len())])
    }
}

impl Model {
    /// The joints and the weights of an instance. Both are empty for one that keeps its shape.
    pub fn deformers(&self, instance: &Instance) -> (&[Mat4], &[f32]) {
        let deformation = self.primitives[instance.primitive].deformation.as_ref();
        deformation.map_or((&[], &[]), |deformation| self.pose.deformers(instance, deformation))
    }

    /// The vertices of an instance as joints and morph targets have moved them, in the space that `world_from_object` leaves.
    pub fn vertices(&self, instance: &Instance) -> Cow<'_, [Vertex]> {
        let Primitive { vertices, deformation, .. } = &self.primitives[instance.primitive];
        match (deformation, self.deformers(instance)) {
            (None, _) | (Some(_), (&[], &[])) => Cow::Borrowed(vertices),
            (Some(deformation), (joints, weights)) => Cow::Owned(deformation.apply(vertices, joints, weights)),
        }
    }
}
