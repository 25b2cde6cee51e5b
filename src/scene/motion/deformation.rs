//! Moving the vertices of a primitive by joints and morph targets.

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use crate::interface::Vertex;

pub use crate::interface::{Displacement, Influence};

/// The joints and morph targets that move the vertices of a primitive. Morph targets come first, then the skin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformation {
    /// Influences of each vertex: 4, 8, 12 ...; 0 without a skin.
    pub influences_per_vertex: usize,
    /// Those of all vertices, one after the other.
    pub influences: Vec<Influence>,
    /// Morph targets, each with a displacement of every vertex.
    pub targets: Vec<Vec<Displacement>>,
}

/// Vertices that one task deforms.
const VERTICES_A_TASK: usize = 1 << 12;

impl Deformation {
    /// The deformation of vertices that are copies of these, by their indices.
    #[must_use]
    pub fn of_copies(&self, sources: &[u32]) -> Self {
        let per_vertex = self.influences_per_vertex;
        let of_vertex = |source: &u32| &self.influences[*source as usize * per_vertex..][..per_vertex];
        let copied = |target: &Vec<Displacement>| sources.iter().map(|source| target[*source as usize]).collect();
        Self {
            influences_per_vertex: per_vertex,
            influences: sources.iter().flat_map(of_vertex).copied().collect(),
            targets: self.targets.iter().map(copied).collect(),
        }
    }

    /// The deformed position of a vertex. `joints` are those of the instance's skin, and empty for one without a skin; `weights` those of
    /// its morph targets.
    pub fn position(&self, index: usize, vertex: &Vertex, joints: &[Mat4], weights: &[f32]) -> Vec3 {
        let mut position = Vec3::from(vertex.position);
        for (target, weight) in self.active(weights) {
            position += weight * Vec3::from(target[index].position);
        }
        if joints.is_empty() { position } else { self.skin(index, joints).transform_point3(position) }
    }

    /// The deformed vertices, as the device computes them. `joints` and `weights` as for [`Deformation::position`].
    pub fn apply(&self, vertices: &[Vertex], joints: &[Mat4], weights: &[f32]) -> Vec<Vertex> {
        let deformed = |(index, vertex): (usize, &Vertex)| self.vertex(index, vertex, joints, weights);
        vertices.par_iter().enumerate().with_min_len(VERTICES_A_TASK).map(deformed).collect()
    }

    fn vertex(&self, index: usize, vertex: &Vertex, joints: &[Mat4], weights: &[f32]) -> Vertex {
        let [mut position, mut normal] = [vertex.position, vertex.normal].map(Vec3::from);
        let (mut tangent, sign) = (Vec4::from(vertex.tangent).truncate(), vertex.tangent[3]);
        let ([mut uv0, mut uv1], mut color) = ([vertex.uv0, vertex.uv1].map(Vec2::from), Vec4::from(vertex.color));
        for (target, weight) in self.active(weights) {
            let added = &target[index];
            position += weight * Vec3::from(added.position);
            normal += weight * Vec3::from(added.normal);
            tangent += weight * Vec3::from(added.tangent);
            uv0 += weight * Vec2::from(added.uv0);
            uv1 += weight * Vec2::from(added.uv1);
            color += weight * Vec4::from(added.color);
        }
        if !joints.is_empty() && self.influences_per_vertex > 0 {
            let skin = self.skin(index, joints);
            position = skin.transform_point3(position);
            normal = normals_from(Mat3::from_mat4(skin)) * normal;
            tangent = skin.transform_vector3(tangent);
        }
        let normal = normal.normalize_or(vertex.normal.into());
        Vertex {
            position: position.to_array(),
            normal: normal.to_array(),
            tangent: tangent
                .normalize_or(vertex.tangent[..3].try_into().map_or(Vec3::X, Vec3::from_array))
                .extend(sign)
                .to_array(),
            uv0: uv0.to_array(),
            uv1: uv1.to_array(),
            color: color.clamp(Vec4::ZERO, Vec4::ONE).to_array(),
        }
    }

    /// The targets that change anything, with their weights.
    fn active<'a>(&'a self, weights: &'a [f32]) -> impl Iterator<Item = (&'a Vec<Displacement>, f32)> {
        self.targets.iter().zip(weights.iter().copied()).filter(|(_, weight)| *weight != 0.0)
    }

    /// The sum of the matrices of a vertex's joints by their weights; the identity for a primitive without influences.
    fn skin(&self, index: usize, joints: &[Mat4]) -> Mat4 {
        if self.influences_per_vertex == 0 {
            return Mat4::IDENTITY;
        }
        let of_vertex = &self.influences[index * self.influences_per_vertex..][..self.influences_per_vertex];
        let weighted = |influence: &Influence| joints[influence.joint as usize] * influence.weight;
        of_vertex.iter().filter(|influence| influence.weight != 0.0).map(weighted).fold(Mat4::ZERO, |sum, m| sum + m)
    }
}

/// The matrix for normals: the inverse transpose times the absolute determinant, which exists for every matrix.
fn normals_from(linear: Mat3) -> Mat3 {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}
