//! A model, its lights and its cameras elsewhere than in the file.

use glam::{DMat4, Mat4, Vec3};

use super::model::{Bounds, Camera, Lens, Light, Model};

impl Light {
    /// The light of a node.
    #[must_use]
    pub fn at(&self, world_from_node: &DMat4) -> Self {
        let world = world_from_node.as_mat4();
        // Lights shine along -Z of their node.
        let direction = world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
        Self { position: world.w_axis.truncate(), direction, ..self.clone() }
    }

    /// The light moved by a transform that preserves angles.
    #[must_use]
    pub fn placed(&self, transform: Mat4) -> Self {
        let direction = turned(transform, self.direction);
        Self { position: transform.transform_point3(self.position), direction, ..self.clone() }
    }
}

impl Camera {
    /// The camera of a node.
    #[must_use]
    pub fn at(&self, world_from_node: &DMat4) -> Self {
        let world = world_from_node.as_mat4();
        let forward = world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
        let up = world.transform_vector3(Vec3::Y).reject_from_normalized(forward);
        let up = up.normalize_or(forward.any_orthonormal_vector());
        Self { eye: world.w_axis.truncate(), forward, up, ..self.clone() }
    }

    /// The camera moved by a transform that preserves angles.
    #[must_use]
    pub fn placed(&self, transform: Mat4) -> Self {
        let [forward, up] = [self.forward, self.up].map(|direction| turned(transform, direction));
        Self { eye: transform.transform_point3(self.eye), forward, up, ..self.clone() }.scaled(transform)
    }

    /// The same place with a visible area that grows as the model does.
    #[must_use]
    pub fn scaled(mut self, transform: Mat4) -> Self {
        if let Lens::Orthographic { height } = &mut self.lens {
            *height *= transform.x_axis.length();
        }
        self
    }
}

fn turned(transform: Mat4, direction: Vec3) -> Vec3 {
    transform.transform_vector3(direction).normalize_or(direction)
}

impl Model {
    /// The model in its own pose moved by `transform`, which preserves angles, with its lights and cameras. It shares the geometry.
    #[must_use]
    pub fn placed(&self, transform: Mat4) -> Self {
        let mut model = self.at(&[], &[], &Some(transform).into());
        let pose = &model.pose;
        if pose.joints.is_empty() && pose.weights.is_empty() && pose.hidden.is_empty() {
            model.bounds = model.instance_bounds();
        }
        model
    }

    /// World bounds of all instances, as they are without joints and morph targets.
    pub fn instance_bounds(&self) -> Bounds {
        let mut bounds = Bounds::default();
        for instance in &self.instances {
            for corner in self.primitives[instance.primitive].bounds.corners() {
                bounds.include(instance.world_from_object.transform_point3(corner));
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests {
    use super::super::built_in;
    use super::*;

    #[test]
    fn all_of_a_model_moves() {
        let model = built_in("many-lights").unwrap().unwrap();
        let transform = Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0)) * Mat4::from_scale(Vec3::splat(2.0));
        let placed = model.placed(transform);
        let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-4, "{a} {b}");
        near(placed.bounds.min, transform.transform_point3(model.bounds.min));
        near(placed.bounds.max, transform.transform_point3(model.bounds.max));
        for (now, before) in placed.lights.iter().zip(&model.lights) {
            near(now.position, transform.transform_point3(before.position));
            near(now.direction, before.direction);
        }
        assert!(std::sync::Arc::ptr_eq(&model.primitives, &placed.primitives), "the geometry is copied");
        assert_eq!(model.placed(Mat4::IDENTITY).bounds, model.bounds);
    }
}
