//! The formats in which attributes may be stored. Integer positions, normals, tangents and texture coordinates are from
//! KHR_mesh_quantization.

use gltf::json;
use json::accessor::{ComponentType as C, Type};

use super::accessor::{Format, Normalized as N};

/// Vertex positions.
pub const POSITION: Format = Format {
    types: &[Type::Vec3],
    components: &[(C::F32, N::No), (C::I8, N::Either), (C::U8, N::Either), (C::I16, N::Either), (C::U16, N::Either)],
};
/// Vertex normals.
pub const NORMAL: Format =
    Format { types: &[Type::Vec3], components: &[(C::F32, N::No), (C::I8, N::Yes), (C::I16, N::Yes)] };
/// Tangents.
pub const TANGENT: Format = Format { types: &[Type::Vec4], components: NORMAL.components };
/// Texture coordinates.
pub const TEXCOORD: Format = Format { types: &[Type::Vec2], components: POSITION.components };
/// Vertex colors.
pub const COLOR: Format =
    Format { types: &[Type::Vec3, Type::Vec4], components: &[(C::F32, N::No), (C::U8, N::Yes), (C::U16, N::Yes)] };
