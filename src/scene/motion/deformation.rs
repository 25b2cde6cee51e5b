//! What joints and morph targets do to the vertices of a primitive.

/// A joint that moves a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Influence {
    /// Index of the joint in its skin; in range.
    pub joint: u32,
    /// Its weight. Those of a vertex add up to 1.
    pub weight: f32,
}

/// What a morph target with a weight of 1 adds to a vertex. Object space.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Displacement {
    /// Added to the position, meters.
    pub position: [f32; 3],
    /// Added to the normal, before it is normalized.
    pub normal: [f32; 3],
    /// Added to the tangent's direction.
    pub tangent: [f32; 3],
    /// Added to the first texture coordinates.
    pub uv0: [f32; 2],
    /// Added to the second texture coordinates.
    pub uv1: [f32; 2],
    /// Added to the color.
    pub color: [f32; 4],
}

/// What joints and morph targets do to the vertices of a primitive. Morph targets come first, then the skin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformation {
    /// Influences of each vertex: 4, 8, 12 ...; 0 without a skin.
    pub influences_per_vertex: usize,
    /// Those of all vertices, one after the other.
    pub influences: Vec<Influence>,
    /// Morph targets, each with a displacement of every vertex.
    pub targets: Vec<Vec<Displacement>>,
}
