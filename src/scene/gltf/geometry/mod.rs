//! From accessors to vertices and triangles with tangents.

pub mod accessor;
mod deformation;
mod formats;
pub mod mesh;
mod source;
pub mod tangents;
pub mod triangles;
