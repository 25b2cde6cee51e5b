//! Helpers for topologies: incomplete primitives, triangle lists, flat normals, welding.

use std::sync::Arc;

use glam::Vec3;

use crate::scene::model::{Primitive, Topology, Vertex};

/// The number of indices after the last complete primitive.
pub fn excess(topology: Topology, count: usize) -> usize {
    match topology {
        Topology::Points | Topology::LineStrip | Topology::TriangleStrip | Topology::TriangleFan => 0,
        Topology::Lines => count % 2,
        Topology::Triangles => count % 3,
    }
}

/// The smallest number of indices that draws anything.
pub fn least(topology: Topology) -> usize {
    match topology {
        Topology::Points => 1,
        Topology::Lines | Topology::LineStrip => 2,
        Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan => 3,
    }
}

/// Whether the topology has faces.
pub fn has_faces(topology: Topology) -> bool {
    least(topology) == 3
}

/// The triangles of a list, strip or fan, with glTF's winding; empty for points and lines. Omits triangles that use a vertex
/// twice, as strips do to turn.
pub fn triangles(topology: Topology, indices: &[u32]) -> Vec<[u32; 3]> {
    let all: Vec<[u32; 3]> = match topology {
        Topology::Triangles => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        Topology::TriangleStrip => {
            let turn = |(i, t): (usize, &[u32])| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] };
            indices.windows(3).enumerate().map(turn).collect()
        }
        Topology::TriangleFan => match indices {
            [center, rim @ ..] => rim.windows(2).map(|t| [t[0], t[1], *center]).collect(),
            [] => Vec::new(),
        },
        Topology::Points | Topology::Lines | Topology::LineStrip => Vec::new(),
    };
    if topology == Topology::Triangles {
        return all;
    }
    all.into_iter().filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// Normal of a triangle. Its length is twice the area, so it is zero for a degenerate triangle.
pub fn face_normal(vertices: &[Vertex], triangle: [u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|index| Vec3::from(vertices[index as usize].position));
    (b - a).cross(c - a)
}

/// A mesh as separate corners, each with its former vertex.
pub struct Corners {
    /// Index of the former vertex.
    pub source: Vec<u32>,
    /// The corner.
    pub vertices: Vec<Vertex>,
}

impl Corners {
    /// Splits triangles into corners.
    pub fn new(vertices: &[Vertex], triangles: &[[u32; 3]]) -> Self {
        let source: Vec<u32> = triangles.as_flattened().to_vec();
        let vertices = source.iter().map(|&index| vertices[index as usize]).collect();
        Self { source, vertices }
    }

    /// Gives every triangle its flat normal, or `fallback` if it is degenerate.
    pub fn flatten(&mut self, fallback: Vec3) {
        for corners in self.vertices.chunks_exact_mut(3) {
            // Adding zero turns -0 into 0, so that `weld` joins coplanar neighbors.
            let normal = (face_normal(corners, [0, 1, 2]).normalize_or(fallback) + Vec3::ZERO).to_array();
            corners.iter_mut().for_each(|corner| corner.normal = normal);
        }
    }

    /// Replaces vertices and indices of a primitive by the corners, welded.
    pub fn weld_into(&self, primitive: &mut Primitive) {
        let (vertices, indices, sources) = self.weld();
        let deformation = primitive.deformation.as_ref().map(|deformation| deformation.of_copies(&sources));
        (primitive.vertices, primitive.indices, primitive.topology) = (vertices, indices, Topology::Triangles);
        primitive.deformation = deformation.map(Arc::new);
    }

    /// Merges corners that come from the same vertex and are still equal. Returns vertices, a triangle list, and the former vertex of each
    /// vertex.
    fn weld(&self) -> (Vec<Vertex>, Vec<u32>, Vec<u32>) {
        const NONE: u32 = u32::MAX;
        let sources = self.source.iter().max().map_or(0, |&last| last as usize + 1);
        // Linked lists: `last` has the newest vertex of each source, `previous` the one before it.
        let mut last = vec![NONE; sources];
        let mut previous = Vec::new();
        let mut vertices: Vec<Vertex> = Vec::with_capacity(sources);
        let mut origins = Vec::with_capacity(sources);
        let mut indices = Vec::with_capacity(self.source.len());
        for (&source, corner) in self.source.iter().zip(&self.vertices) {
            let head = &mut last[source as usize];
            let mut at = *head;
            while at != NONE && bytemuck::bytes_of(&vertices[at as usize]) != bytemuck::bytes_of(corner) {
                at = previous[at as usize];
            }
            if at == NONE {
                // The number of corners fits u32, as indices do.
                at = vertices.len() as u32;
                vertices.push(*corner);
                origins.push(source);
                previous.push(*head);
                *head = at;
            }
            indices.push(at);
        }
        (vertices, indices, origins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        assert_eq!(triangles(Topology::TriangleStrip, &[0, 1, 2, 3, 4]), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(triangles(Topology::TriangleFan, &[0, 1, 2, 3]), [[1, 2, 0], [2, 3, 0]]);
        assert_eq!(triangles(Topology::TriangleStrip, &[0, 1, 2, 2, 3, 3, 4, 5]), [[0, 1, 2], [3, 5, 4]]);
        assert!(triangles(Topology::Lines, &[0, 1, 2]).is_empty() && triangles(Topology::TriangleFan, &[]).is_empty());
    }

    #[test]
    fn welding_keeps_what_differs() {
        let vertex = |x: f32| Vertex { position: [x, 0.0, 0.0], ..Vertex::default() };
        let vertices = [vertex(0.0), vertex(1.0), vertex(2.0), vertex(3.0)];
        let mut corners = Corners::new(&vertices, &[[0, 1, 2], [0, 2, 3]]);
        assert_eq!(corners.weld().1, [0, 1, 2, 0, 2, 3]);
        corners.vertices[3].tangent = [1.0; 4];
        let (welded, indices, origins) = corners.weld();
        assert_eq!((welded.len(), indices), (5, vec![0, 1, 2, 3, 2, 4]));
        assert_eq!(origins, [0, 1, 2, 0, 3]);
        assert_eq!(welded[3].tangent, [1.0; 4]);
    }
}
