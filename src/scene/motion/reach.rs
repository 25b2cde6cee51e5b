//! Bounds of the vertices that joints and morph targets move, without moving them.

use glam::{Mat3, Mat4, Vec3};

use super::deformation::{Deformation, Displacement};
use crate::interface::Vertex;
use crate::scene::bounds::Bounds;

/// Bounds of the vertices of a primitive in every pose. A vertex is at a mean of where its joints move it, so it is within the bounds of all
/// these places.
#[derive(Clone, Debug, Default)]
pub struct Reach {
    /// Bounds of all vertices.
    all: Bounds,
    /// The joints that move vertices, and bounds of the vertices of each.
    of_joints: Vec<(u32, Bounds)>,
    /// The most by which each morph target moves a vertex along the axes, with a weight of 1.
    of_targets: Vec<Vec3>,
}

impl Reach {
    /// Those of these vertices.
    pub fn new(vertices: &[Vertex], deformation: &Deformation) -> Self {
        let mut this = Self::default();
        vertices.iter().for_each(|vertex| this.all.include(vertex.position.into()));
        let mut of_joints: Vec<Option<Bounds>> = Vec::new();
        let of_vertices = deformation.influences.chunks_exact(deformation.influences_per_vertex.max(1));
        for (vertex, influences) in vertices.iter().zip(of_vertices) {
            for influence in influences.iter().filter(|influence| influence.weight != 0.0) {
                let joint = influence.joint as usize;
                of_joints.resize(of_joints.len().max(joint + 1), None);
                of_joints[joint].get_or_insert_default().include(vertex.position.into());
            }
        }
        this.of_joints = (0..).zip(of_joints).filter_map(|(joint, bounds)| Some((joint, bounds?))).collect();
        let most = |target: &Vec<_>| {
            let moved = target.iter().map(|moved: &Displacement| Vec3::from(moved.position).abs());
            moved.fold(Vec3::ZERO, Vec3::max)
        };
        this.of_targets = deformation.targets.iter().map(most).collect();
        this
    }

    /// The bounds in a pose. `joints` and `weights` as for [`Deformation::position`].
    pub fn bounds(&self, joints: &[Mat4], weights: &[f32]) -> Bounds {
        let morphed = self.of_targets.iter().zip(weights).map(|(most, weight)| *most * weight.abs()).sum::<Vec3>();
        let place = |bounds: &Bounds, joint: &Mat4| {
            let (linear, half) = (Mat3::from_mat4(*joint), bounds.max - bounds.center() + morphed);
            let center = joint.transform_point3(bounds.center());
            let reach = linear.x_axis.abs() * half.x + linear.y_axis.abs() * half.y + linear.z_axis.abs() * half.z;
            [center - reach, center + reach]
        };
        if joints.is_empty() || self.of_joints.is_empty() {
            let [min, max] = place(&self.all, &Mat4::IDENTITY);
            return Bounds { min, max };
        }
        let mut found = Bounds::default();
        for (joint, bounds) in &self.of_joints {
            place(bounds, &joints[*joint as usize]).into_iter().for_each(|corner| found.include(corner));
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::super::Influence;
    use super::*;

    /// Numbers from -1 to 1, the same in each run.
    struct Random(u32);

    impl Random {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) as f32 / (1 << 23) as f32 - 1.0
        }

        fn vector(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }

        fn joint(&mut self) -> Mat4 {
            let rotation = Quat::from_axis_angle(self.vector().normalize_or(Vec3::X), 4.0 * self.next());
            Mat4::from_scale_rotation_translation(2.0 * self.vector(), rotation, 5.0 * self.vector())
        }
    }

    #[test]
    fn vertices_are_within_the_bounds_of_every_pose() {
        const JOINTS: u32 = 6;
        let mut random = Random(3);
        let vertices: Vec<Vertex> =
            (0..60).map(|_| Vertex { position: random.vector().to_array(), ..Vertex::default() }).collect();
        let influences = (0..60).flat_map(|vertex| {
            let weights = [0.5, 0.3, 0.2, 0.0];
            (0..4).map(move |k| Influence {
                joint: (vertex / 10 + k * (vertex % 3)) % JOINTS,
                weight: weights[k as usize],
            })
        });
        let influences: Vec<Influence> = influences.collect();
        let mut target = || -> Vec<Displacement> {
            (0..60).map(|_| Displacement { position: random.vector().to_array(), ..Displacement::default() }).collect()
        };
        let targets = vec![target(), target()];
        for (per_vertex, influences) in [(4, influences), (0, Vec::new())] {
            let deformation = Deformation { influences_per_vertex: per_vertex, influences, targets: targets.clone() };
            let reach = Reach::new(&vertices, &deformation);
            for pose in 0..50 {
                let joints: Vec<Mat4> = (0..if per_vertex > 0 { JOINTS } else { 0 }).map(|_| random.joint()).collect();
                let weights = if pose % 2 == 0 { vec![random.next(), random.next()] } else { vec![] };
                let bounds = reach.bounds(&joints, &weights);
                let mut exact = Bounds::default();
                for (index, vertex) in vertices.iter().enumerate() {
                    let place = deformation.position(index, vertex, &joints, &weights);
                    assert!(place.cmpge(bounds.min - 1e-4).all() && place.cmple(bounds.max + 1e-4).all(), "{place}");
                    exact.include(place);
                }
                let [found, least] = [bounds, exact].map(|bounds| (bounds.max - bounds.min).length());
                assert!(found < 6.0 * least, "{found} of {least}");
            }
        }
    }
}
