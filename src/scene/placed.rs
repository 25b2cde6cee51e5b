//! A model that stands elsewhere than in its file.

use glam::{Mat4, Vec3};

use super::model::{Bounds, Lens, Model};

impl Model {
    /// The model moved by `transform`, which preserves angles, with its lights and cameras. It shares the geometry.
    #[must_use]
    pub fn placed(&self, transform: Mat4) -> Self {
        let mut model = self.clone();
        for instance in &mut model.instances {
            instance.world_from_object = transform * instance.world_from_object;
        }
        model.bounds = model.instance_bounds();
        // The hull points remain the hull points.
        let place = |point: &mut Vec3| *point = transform.transform_point3(*point);
        model.outline.iter_mut().for_each(place);
        let turn = |direction: Vec3| transform.transform_vector3(direction).normalize_or(direction);
        for light in &mut model.lights {
            place(&mut light.position);
            light.direction = turn(light.direction);
        }
        for camera in &mut model.cameras {
            place(&mut camera.eye);
            (camera.forward, camera.up) = (turn(camera.forward), turn(camera.up));
            if let Lens::Orthographic { height } = &mut camera.lens {
                *height *= transform.x_axis.length();
            }
        }
        model
    }

    /// World bounds of all instances.
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
