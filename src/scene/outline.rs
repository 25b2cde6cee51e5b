//! The points of a model that decide whether it fits into a picture.

use glam::Vec3;
use rayon::prelude::*;

use super::model::{Instance, Model, Primitive};

/// Number of directions in which the outermost point is searched. More directions fit closer; this many find the edge of a sphere
/// to 1 %.
const DIRECTIONS: usize = 192;
/// In a model with more instances than this, the corners of its bounds stand for each primitive. A box that is too
/// large for its primitive hardly matters among so many.
pub const MOST_INSTANCES: usize = 2000;
/// If the instances have more points than this in total, each primitive is searched once in its own space, and its
/// instances place only the points found there. These are still vertices of the model, but the fit is less close
/// around instances that are stretched or rotated.
const MOST_POINTS: usize = 1 << 21;
/// Points that one task searches.
const POINTS_A_TASK: usize = 4096;
/// Points whose box is looked at before they are.
const POINTS_A_BOX: usize = 64;

/// The model's hull points, world space: the farthest point in each of many directions. They are vertices that some index refers
/// to, as in the model's bounds. The work grows with the number of points and never faster than the number of instances.
pub fn outline(model: &Model) -> Vec<Vec3> {
    let directions = Directions::new();
    let mut points: Vec<Vec<Vec3>> = if model.instances.len() > MOST_INSTANCES {
        model.primitives.iter().map(|primitive| primitive.bounds.corners().to_vec()).collect()
    } else {
        model.primitives.par_iter().map(referred).collect()
    };
    let total: usize = model.instances.iter().map(|instance| points[instance.primitive].len()).sum();
    if total > MOST_POINTS {
        // A point for each direction: fewer points are fewer as they are.
        let many = points.par_iter_mut().filter(|points| points.len() > DIRECTIONS);
        many.for_each(|points| *points = directions.farthest(points));
    }
    let placed = |instance: &Instance| {
        let world_from_object = instance.world_from_object;
        points[instance.primitive].iter().map(move |point| world_from_object.transform_point3(*point))
    };
    let points_ws: Vec<Vec3> = model.instances.par_iter().flat_map_iter(placed).collect();
    directions.farthest(&points_ws)
}

/// The farthest point in each of many directions.
pub fn hull(points: &[Vec3]) -> Vec<Vec3> {
    Directions::new().farthest(points)
}

/// The vertices that indices refer to, in their order.
pub fn used_vertices(primitive: &Primitive) -> impl Iterator<Item = u32> + use<> {
    let mut is_used = vec![false; primitive.vertices.len()];
    primitive.indices.iter().for_each(|&index| is_used[index as usize] = true);
    (0..).zip(is_used).filter(|(_, is_used)| *is_used).map(|(index, _)| index)
}

/// The positions that indices refer to, in the order of the vertices.
fn referred(primitive: &Primitive) -> Vec<Vec3> {
    used_vertices(primitive).map(|index| Vec3::from(primitive.vertices[index as usize].position)).collect()
}

/// Unit vectors spread evenly over the sphere. Each component has an array of its own, so that the compiler compares
/// one point with several directions at a time.
struct Directions {
    x: [f32; DIRECTIONS],
    y: [f32; DIRECTIONS],
    z: [f32; DIRECTIONS],
}

/// For each direction a distance that some point has reached along it, and the index of the last such point so far, or [`NOWHERE`].
#[derive(Clone, Copy)]
struct Farthest {
    distance: [f32; DIRECTIONS],
    point: [u32; DIRECTIONS],
}

impl Directions {
    fn new() -> Self {
        let all: [Vec3; DIRECTIONS] = std::array::from_fn(fibonacci);
        Self { x: all.map(|d| d.x), y: all.map(|d| d.y), z: all.map(|d| d.z) }
    }

    /// For each direction the point that lies farthest along it; of several the last. Empty without points.
    fn farthest(&self, points: &[Vec3]) -> Vec<Vec3> {
        // A few of the points say which others need not be looked at.
        let some: Vec<Vec3> = points.iter().step_by(POINTS_A_BOX).copied().collect();
        let reached = self.search(&some, 0, &NOTHING).distance;
        let search = |(task, points): (usize, &[Vec3])| {
            // Points that are as far are found again, and the last of them counts.
            let known = Farthest { distance: reached, ..NOTHING };
            let boxes = points.chunks(POINTS_A_BOX).enumerate();
            boxes.fold(known, |known, (number, points)| match self.may_reach(points, &known) {
                true => self.search(points, task * POINTS_A_TASK + number * POINTS_A_BOX, &known),
                false => known,
            })
        };
        let found = points.par_chunks(POINTS_A_TASK).enumerate().map(search).reduce_with(Farthest::or_later);
        found.iter().flat_map(|found| found.point).filter_map(|index| points.get(index as usize)).copied().collect()
    }

    /// Searches points whose first one has the index `first` among all, and that come after the known ones.
    fn search(&self, points: &[Vec3], first: usize, known: &Farthest) -> Farthest {
        let mut found = *known;
        for (index, point) in (first as u32..).zip(points) {
            for k in 0..DIRECTIONS {
                let distance = self.x[k] * point.x + self.y[k] * point.y + self.z[k] * point.z;
                let is_farther = distance >= found.distance[k];
                found.distance[k] = if is_farther { distance } else { found.distance[k] };
                found.point[k] = if is_farther { index } else { found.point[k] };
            }
        }
        found
    }

    /// Whether one of the points may lie as far as the known ones in some direction: their box does.
    fn may_reach(&self, points: &[Vec3], known: &Farthest) -> bool {
        let (min, max) = points
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), point| (min.min(*point), max.max(*point)));
        let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
        // More than what rounding may take from the distance of a corner.
        let slack = 1e-5 * min.abs().max(max.abs()).element_sum();
        (0..DIRECTIONS).any(|k| {
            let [x, y, z] = [self.x[k], self.y[k], self.z[k]];
            let middle = x * center.x + y * center.y + z * center.z;
            middle + (x.abs() * half.x + y.abs() * half.y + z.abs() * half.z) + slack >= known.distance[k]
        })
    }
}

/// No point has been found.
const NOWHERE: u32 = u32::MAX;
const NOTHING: Farthest = Farthest { distance: [f32::NEG_INFINITY; DIRECTIONS], point: [NOWHERE; DIRECTIONS] };

impl Farthest {
    /// For each direction the farther point; if both lie equally far, that of `later`.
    fn or_later(mut self, later: Self) -> Self {
        for k in 0..DIRECTIONS {
            if later.point[k] != NOWHERE && later.distance[k] >= self.distance[k] {
                (self.distance[k], self.point[k]) = (later.distance[k], later.point[k]);
            }
        }
        self
    }
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
            deformation: None,
        }
    }

    fn row(primitive: Primitive, count: usize) -> Model {
        let at = |x: usize| Mat4::from_translation(Vec3::X * x as f32);
        let place = |x| Instance {
            primitive: 0,
            world_from_object: at(x),
            node: x,
            node_name: "".into(),
            first_joint: None,
            first_weight: None,
        };
        Model { primitives: vec![primitive].into(), instances: (0..count).map(place).collect(), ..Model::default() }
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
    fn boxes_leave_out_no_point() {
        // A Lissajous curve with a point of every distance twice, in an order whose boxes overlap; the last of equal points counts.
        let at = |index: usize| {
            let t = (index % 9_001) as f32 * 0.013;
            Vec3::new((3.0 * t).sin(), (5.0 * t + 1.0).sin() * 2.0, (7.0 * t).cos() * (0.1 * t).sin()) * 40.0
        };
        let points: Vec<Vec3> = (0..18_002).map(at).chain([Vec3::splat(1.0); 70]).collect();
        let directions = Directions::new();
        let each = directions.search(&points, 0, &NOTHING).point;
        assert_eq!(directions.farthest(&points), each.map(|index| points[index as usize]));
        for points in points.chunks(POINTS_A_BOX) {
            let own = directions.search(points, 0, &NOTHING);
            assert!(directions.may_reach(points, &own), "a box does not reach its own points");
            let beyond = Farthest { distance: own.distance.map(|distance| distance + 1000.0), ..own };
            assert!(!directions.may_reach(points, &beyond), "a box reaches everything");
        }
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
