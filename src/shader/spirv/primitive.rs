//! The primitives that stages before the rasterizer take and give, which their modules declare as execution modes (SPIR-V
//! specification, section 3.6).

use serde::Serialize;

use super::enums::model::{CONTROL, EVALUATION, GEOMETRY, MESH};

/// A kind of primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Primitive {
    /// Points.
    Points,
    /// Lines.
    Lines,
    /// Triangles.
    Triangles,
    /// Lines or triangles with the vertices of their neighbors. Nothing gives these.
    WithNeighbors,
}

impl Primitive {
    /// The name in GLSL, of the `in` layout of a geometry stage.
    pub fn glsl(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Lines => "lines",
            Self::Triangles => "triangles",
            Self::WithNeighbors => "triangles_adjacency",
        }
    }
}

/// The primitives that a geometry stage takes.
pub(super) fn taken(model: u32, modes: &[u32]) -> Option<Primitive> {
    let found = modes.iter().find_map(|mode| match mode {
        19 => Some(Primitive::Points),
        20 => Some(Primitive::Lines),
        22 => Some(Primitive::Triangles),
        21 | 23 => Some(Primitive::WithNeighbors),
        _ => None,
    });
    found.filter(|_| model == GEOMETRY)
}

/// The primitives that a tessellation evaluation, a geometry or a mesh stage gives.
pub(super) fn given(model: u32, modes: &[u32]) -> Option<Primitive> {
    const POINT_MODE: u32 = 10;
    let of = |mode: &u32| match (model, mode) {
        (GEOMETRY | MESH, 27) => Some(Primitive::Points),
        (EVALUATION, 25) | (GEOMETRY, 28) | (MESH, 5269) => Some(Primitive::Lines),
        (EVALUATION, 22 | 24) | (GEOMETRY, 29) | (MESH, 5298) => Some(Primitive::Triangles),
        _ => None,
    };
    match model {
        EVALUATION if modes.contains(&POINT_MODE) => Some(Primitive::Points),
        _ => modes.iter().find_map(of),
    }
}

/// Whether a stage's inputs have an element for each vertex.
pub(super) fn has_arrays_of_inputs(model: u32) -> bool {
    matches!(model, CONTROL | EVALUATION | GEOMETRY)
}

/// Whether a stage's outputs have an element for each vertex, or for each primitive.
pub(super) fn has_arrays_of_outputs(model: u32) -> bool {
    matches!(model, CONTROL | MESH)
}
