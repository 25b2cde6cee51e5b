//! From accessors to vertices and triangles with tangents.

pub mod accessor;
pub mod mesh;
pub mod tangents;
pub mod triangles;
