//! The points of a model that decide whether it fits into a picture.

use glam::{Mat3, Vec3};
use rayon::prelude::*;

use super::model::{Instance, Model, Primitive};

/// How many directions are asked. More fit closer: with these a sphere's edge is found to 1 %.
const DIRECTIONS: usize = 192;
/// With more instances than this, the corners of their boxes stand for them: among so many, a loose one counts little.
const MOST_INSTANCES: usize = 2000;
/// With more points than this over all instances, each primitive is searched once in its own space, and its instances
/// place what was found: still vertices, a little less close around what is stretched or turned.
const MOST_POINTS: usize = 1 << 21;

/// The model's outermost points, world space: the farthest one in each of many directions. They are vertices that some
/// index refers to, as in its bounds.
pub fn outline(model: &Model) -> Vec<Vec3> {
    let directions: Vec<Vec3> = (0..DIRECTIONS).map(fibonacci).collect();
    let mut points: Vec<Vec<Vec3>> = if model.instances.len() > MOST_INSTANCES {
        model.primitives.iter().map(|primitive| primitive.bounds.corners().to_vec()).collect()
    } else {
        model.primitives.par_iter().map(referred).collect()
    };
    let total: usize = model.instances.iter().map(|instance| points[instance.primitive].len()).sum();
    if total > MOST_POINTS {
        points.par_iter_mut().for_each(|points| *points = farthest(points, &directions));
    }
    let placed = |instance: &Instance| {
        // max over points of direction . (M p) is max of (M^T direction) . p
        let local_from_world = Mat3::from_mat4(instance.world_from_object).transpose();
        let local: Vec<Vec3> = directions.iter().map(|direction| local_from_world * *direction).collect();
        let found = farthest(&points[instance.primitive], &local);
        found.into_iter().map(|point| instance.world_from_object.transform_point3(point)).collect::<Vec<_>>()
    };
    let candidates: Vec<Vec3> = model.instances.par_iter().flat_map_iter(placed).collect();
    farthest(&candidates, &directions)
}

/// The positions that indices refer to, in the order of the vertices.
fn referred(primitive: &Primitive) -> Vec<Vec3> {
    let mut is_used = vec![false; primitive.vertices.len()];
    primitive.indices.iter().for_each(|&index| is_used[index as usize] = true);
    let used = primitive.vertices.iter().zip(is_used).filter(|(_, is_used)| *is_used);
    used.map(|(vertex, _)| Vec3::from(vertex.position)).collect()
}

/// For each direction the point that lies farthest along it.
fn farthest(points: &[Vec3], directions: &[Vec3]) -> Vec<Vec3> {
    let support =
        |direction: &Vec3| points.iter().max_by(|a, b| direction.dot(**a).total_cmp(&direction.dot(**b))).copied();
    directions.par_iter().filter_map(support).collect()
}

/// Directions spread evenly over the sphere: a Fibonacci lattice (Swinbank and Purser 2006).
fn fibonacci(index: usize) -> Vec3 {
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let y = 1.0 - (2.0 * index as f32 + 1.0) / DIRECTIONS as f32;
    let ring = (1.0 - y * y).sqrt();
    let (sin, cos) = (golden * index as f32).sin_cos();
    Vec3::new(ring * cos, y, ring * sin)
}

#[cfg(test)]
mod tests {
    use glam::Mat4;

    use super::*;
    use crate::scene::model::{Bounds, Topology, Vertex};

    /// A sphere of `count` points of radius 1, and one vertex far away that nothing refers to.
    fn sphere(count: usize) -> Primitive {
        let mut positions: Vec<Vec3> = (0..count).map(|index| fibonacci(index * DIRECTIONS / count)).collect();
        let mut bounds = Bounds::default();
        positions.iter().for_each(|point| bounds.include(*point));
        positions.push(Vec3::splat(100.0));
        Primitive {
            name: String::new(),
            vertices: positions.iter().map(|p| Vertex { position: p.to_array(), ..Vertex::default() }).collect(),
            indices: (0..count as u32).collect(),
            topology: Topology::Points,
            material: 0,
            default_material: 0,
            variant_materials: Vec::new(),
            attributes: 0,
            bounds,
        }
    }

    fn row(primitive: Primitive, count: usize) -> Model {
        let at = |x: usize| Mat4::from_translation(Vec3::X * x as f32);
        let place = |x| Instance { primitive: 0, world_from_object: at(x), node: x, node_name: String::new() };
        Model { primitives: vec![primitive], instances: (0..count).map(place).collect(), ..Model::default() }
    }

    fn extent(points: &[Vec3]) -> (Vec3, Vec3) {
        (points.iter().fold(Vec3::INFINITY, |a, b| a.min(*b)), points.iter().fold(Vec3::NEG_INFINITY, |a, b| a.max(*b)))
    }

    #[test]
    fn what_no_index_refers_to_is_left_out() {
        let (min, max) = extent(&outline(&row(sphere(DIRECTIONS), 1)));
        assert!(min.min_element() >= -1.001 && max.max_element() <= 1.001, "{min} {max}");
        assert!(max.distance(Vec3::ONE) < 0.05, "{max}");
    }

    #[test]
    fn many_points_and_many_instances_are_still_held() {
        // 40 million points to look at in each direction, were it not for the limits.
        for (points, instances) in [(20_000, MOST_INSTANCES), (20_000, 30_000)] {
            let (min, max) = extent(&outline(&row(sphere(points), instances)));
            let end = instances as f32;
            assert!(
                min.distance(Vec3::splat(-1.0)) < 0.1 && max.distance(Vec3::new(end, 1.0, 1.0)) < 0.1,
                "{min} {max}"
            );
        }
    }
}
