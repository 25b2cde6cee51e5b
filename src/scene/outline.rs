//! The points of a model that decide whether it fits into a picture.

use glam::Vec3;
use rayon::prelude::*;

use super::model::Model;

/// How many directions are asked. More fit closer: with these a sphere's edge is found to 1 %.
const DIRECTIONS: usize = 192;

/// The model's outermost vertices, world space: the farthest one in each of many directions.
pub fn outline(model: &Model) -> Vec<Vec3> {
    let directions: Vec<Vec3> = (0..DIRECTIONS).map(fibonacci).collect();
    let farthest = |instance: &super::model::Instance| -> Vec<Vec3> {
        let vertices = &model.primitives[instance.primitive].vertices;
        let linear = glam::Mat3::from_mat4(instance.world_from_object);
        let support = |direction: &Vec3| {
            // max over vertices of direction . (M v) is max of (M^T direction) . v
            let local = linear.transpose() * *direction;
            let height = |v: &&super::model::Vertex| local.dot(Vec3::from(v.position));
            vertices.iter().max_by(|a, b| height(a).total_cmp(&height(b)))
        };
        let found = directions.iter().filter_map(support);
        found.map(|v| instance.world_from_object.transform_point3(Vec3::from(v.position))).collect()
    };
    let candidates: Vec<Vec3> = model.instances.par_iter().flat_map_iter(farthest).collect();
    let height = |direction: Vec3| move |a: &&Vec3, b: &&Vec3| direction.dot(**a).total_cmp(&direction.dot(**b));
    directions.iter().filter_map(|d| candidates.iter().max_by(height(*d)).copied()).collect()
}

/// Directions spread evenly over the sphere: a Fibonacci lattice (Swinbank and Purser 2006).
fn fibonacci(index: usize) -> Vec3 {
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let y = 1.0 - (2.0 * index as f32 + 1.0) / DIRECTIONS as f32;
    let ring = (1.0 - y * y).sqrt();
    let (sin, cos) = (golden * index as f32).sin_cos();
    Vec3::new(ring * cos, y, ring * sin)
}
