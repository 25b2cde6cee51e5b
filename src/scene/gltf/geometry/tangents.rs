//! Completes tangents: from the file, from MikkTSpace, or around the Y axis.

use bevy_mikktspace::{TangentSpace, generate_tangents};
use glam::{Affine2, Vec3, Vec4};

use super::mesh::Geometry;
use super::triangles::{self, Corners};
use crate::interface as contract;
use crate::scene::model::{Material, Primitive, Vertex};

/// Gives every vertex a unit tangent, and warns of replaced tangents. Tangents of the file are normalized, but not made
/// orthogonal to the normal.
pub fn complete(geometry: &mut Geometry, materials: &[Material]) {
    let primitive = &mut geometry.primitive;
    let from_file = primitive.attributes & contract::ATTRIBUTE_TANGENT != 0;
    let made = !from_file && make(primitive, materials);
    if from_file || made {
        primitive.attributes |= contract::ATTRIBUTE_TANGENT_FRAME;
    }
    let anisotropic = |material: usize| materials.get(material).is_some_and(|m| m.numbers.anisotropy_strength > 0.0);
    if !(from_file || made) && materials_of(primitive).any(anisotropic) {
        geometry.warnings.push(format!(
            "{}: its material is anisotropic, but there are no tangents or texture coordinates to say along which \
             direction: its highlights are drawn out around the object's Y axis.",
            primitive.name
        ));
    }
    let replaced = primitive.vertices.iter_mut().filter_map(repair).count();
    // A few generated tangents fail where texture coordinates meet in a point. Warn only if there are enough to be visible.
    let shows = replaced * 100 > primitive.vertices.len();
    if replaced > 0 && (from_file || (made && shows)) {
        let (name, total) = (&primitive.name, primitive.vertices.len());
        geometry.warnings.push(format!(
            "{name}: {replaced} of {total} tangents are zero or not finite: the direction around \
             the object's Y axis is used there."
        ));
    }
}

/// Normalizes a tangent and its sign. Returns `Some` if the tangent had to be replaced.
fn repair(vertex: &mut Vertex) -> Option<()> {
    let [x, y, z, w] = vertex.tangent;
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    let valid = Vec3::new(x, y, z).try_normalize();
    // Around the Y axis, as if brushed on a lathe. At the poles any direction.
    let normal = Vec3::from(vertex.normal);
    let around_y = Vec3::Y.cross(normal).try_normalize();
    let tangent = valid.or(around_y).unwrap_or_else(|| normal.any_orthonormal_vector());
    vertex.tangent = tangent.extend(sign).to_array();
    if valid.is_none() { Some(()) } else { None }
}

/// The material of a primitive, and those of its variants.
fn materials_of(primitive: &Primitive) -> impl Iterator<Item = usize> {
    let others = primitive.variant_materials.iter().map(|(_, material)| *material);
    std::iter::once(primitive.default_material).chain(others)
}

/// Generates MikkTSpace tangents from the texture coordinates of the first texture that holds directions, after its
/// KHR_texture_transform: its x and y point along the picture as the surface shows it. Returns `false` without faces or texture coordinates.
fn make(primitive: &mut Primitive, materials: &[Material]) -> bool {
    let directions = [contract::TEXTURE_NORMAL, contract::TEXTURE_CLEARCOAT_NORMAL, contract::TEXTURE_ANISOTROPY];
    let directed = |m: &Material| directions.iter().find_map(|texture| m.textures[*texture as usize]);
    let texture = materials_of(primitive).filter_map(|material| materials.get(material)).find_map(directed);
    let (has_uv0, has_uv1) =
        (primitive.attributes & contract::ATTRIBUTE_UV0 != 0, primitive.attributes & contract::ATTRIBUTE_UV1 != 0);
    let second = has_uv1 && (!has_uv0 || texture.is_some_and(|texture| texture.uv_set == 1));
    let triangles = triangles::triangles(primitive.topology, &primitive.indices);
    if triangles.is_empty() || !(has_uv0 || has_uv1) {
        return false;
    }
    let uv_from_mesh = texture.map_or(Affine2::IDENTITY, |texture| texture.uv_from_mesh);
    let mut mesh = Mesh { corners: Corners::new(&primitive.vertices, &triangles), second, uv_from_mesh };
    if generate_tangents(&mut mesh).is_err() {
        return false;
    }
    mesh.corners.weld_into(primitive);
    true
}

struct Mesh {
    corners: Corners,
    second: bool,
    uv_from_mesh: Affine2,
}

impl Mesh {
    fn corner(&self, face: usize, vertex: usize) -> &Vertex {
        &self.corners.vertices[face * 3 + vertex]
    }
}

impl bevy_mikktspace::Geometry for Mesh {
    fn num_faces(&self) -> usize {
        self.corners.vertices.len() / 3
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.corner(face, vertex).position
    }

    fn normal(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.corner(face, vertex).normal
    }

    fn tex_coord(&self, face: usize, vertex: usize) -> [f32; 2] {
        let corner = self.corner(face, vertex);
        let uv = if self.second { corner.uv1 } else { corner.uv0 };
        self.uv_from_mesh.transform_point2(uv.into()).to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vertex: usize) {
        // MikkTSpace's bitangent follows +v, which points down in glTF. glTF's bitangent points up, so the sign is
        // negated.
        let [x, y, z, sign] = space.map_or([0.0; 4], |space| space.tangent_encoded());
        self.corners.vertices[face * 3 + vertex].tangent = Vec4::new(x, y, z, -sign).to_array();
    }
}
