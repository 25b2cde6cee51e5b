//! Completes tangents: from the file, from MikkTSpace, or around the Y axis.

use std::collections::HashMap;

use bevy_mikktspace::{TangentSpace, generate_tangents};
use glam::{Affine2, Vec3, Vec4};
use rayon::prelude::*;

use super::mesh::Geometry;
use super::triangles::{self, Corners};
use crate::interface as contract;
use crate::scene::load_options::Canceled;
use crate::scene::model::{Material, Primitive, Topology, Vertex};

/// Gives every vertex of every primitive a unit tangent, and warns of replaced tangents. Tangents of the file are normalized, but not made
/// orthogonal to the normal. Primitives of equal geometry, as a grid of spheres has, share the work. Stops early if the load is `canceled`.
pub fn complete(geometries: &mut [&mut Geometry], materials: &[Material], canceled: Canceled<'_>) {
    let coordinates: Vec<Option<Coordinates>> =
        geometries.iter().map(|geometry| coordinates(&geometry.primitive, materials)).collect();
    let firsts = firsts_of_equal(geometries, &coordinates);
    let make_first = |(index, geometry): (usize, &mut &mut Geometry)| match coordinates[index] {
        Some(from) if firsts[index] == index && !canceled() => make(&mut geometry.primitive, from),
        _ => false,
    };
    let made: Vec<bool> = geometries.par_iter_mut().enumerate().map(make_first).collect();
    for (index, first) in firsts.iter().enumerate().filter(|(index, first)| index != *first && made[**first]) {
        let Primitive { vertices, indices, topology, .. } = &geometries[*first].primitive;
        let (vertices, indices, topology) = (vertices.clone(), indices.clone(), *topology);
        let primitive = &mut geometries[index].primitive;
        (primitive.vertices, primitive.indices, primitive.topology) = (vertices, indices, topology);
    }
    let rest = geometries.par_iter_mut().enumerate().take_any_while(|_| !canceled());
    rest.for_each(|(index, geometry)| finish(geometry, materials, made[firsts[index]]));
}

/// For each geometry, the index of the first whose vertices, indices and texture coordinates for tangents are equal.
fn firsts_of_equal(geometries: &[&mut Geometry], coordinates: &[Option<Coordinates>]) -> Vec<usize> {
    // Few have as many vertices and indices without being equal, so few are compared whole.
    let mut known: HashMap<(usize, usize, Topology), Vec<usize>> = HashMap::new();
    let first = |index: usize| {
        let primitive = &geometries[index].primitive;
        // Copies of moved vertices would have to be copied, too.
        if coordinates[index].is_none() || primitive.deformation.is_some() {
            return index;
        }
        let key = (primitive.vertices.len(), primitive.indices.len(), primitive.topology);
        let alike = known.entry(key).or_default();
        let is_equal = |other: &&usize| {
            let other_primitive = &geometries[**other].primitive;
            coordinates[**other] == coordinates[index]
                && other_primitive.indices == primitive.indices
                && bytemuck::cast_slice::<_, u8>(&other_primitive.vertices)
                    == bytemuck::cast_slice::<_, u8>(&primitive.vertices)
        };
        alike.iter().find(is_equal).copied().unwrap_or_else(|| {
            // A file of many small meshes of one size would be compared each with each.
            if alike.len() < MOST_ALIKE {
                alike.push(index);
            }
            index
        })
    };
    (0..geometries.len()).map(first).collect()
}

/// Different geometries of equal size with which another one is compared, at most.
const MOST_ALIKE: usize = 8;

/// Warns of tangents that are missing, and repairs those that are no directions. `made`: they are from MikkTSpace.
fn finish(geometry: &mut Geometry, materials: &[Material], made: bool) {
    let primitive = &mut geometry.primitive;
    let from_file = primitive.attributes & contract::ATTRIBUTE_TANGENT != 0;
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

/// Texture coordinates from which tangents are made.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Coordinates {
    /// Of the two sets, the second.
    second: bool,
    uv_from_mesh: Affine2,
}

/// The texture coordinates of the first texture that holds directions, after its KHR_texture_transform: its x and y point along the picture
/// as the surface shows it. `None` if the file has tangents, or no texture coordinates.
fn coordinates(primitive: &Primitive, materials: &[Material]) -> Option<Coordinates> {
    let directions = [contract::TEXTURE_NORMAL, contract::TEXTURE_CLEARCOAT_NORMAL, contract::TEXTURE_ANISOTROPY];
    let directed = |m: &Material| directions.iter().find_map(|texture| m.textures[*texture as usize]);
    let texture = materials_of(primitive).filter_map(|material| materials.get(material)).find_map(directed);
    let (has_uv0, has_uv1) =
        (primitive.attributes & contract::ATTRIBUTE_UV0 != 0, primitive.attributes & contract::ATTRIBUTE_UV1 != 0);
    let second = has_uv1 && (!has_uv0 || texture.is_some_and(|texture| texture.uv_set == 1));
    let from_file = primitive.attributes & contract::ATTRIBUTE_TANGENT != 0;
    let uv_from_mesh = texture.map_or(Affine2::IDENTITY, |texture| texture.uv_from_mesh);
    (!from_file && (has_uv0 || has_uv1)).then_some(Coordinates { second, uv_from_mesh })
}

/// Generates MikkTSpace tangents. Returns `false` without faces.
fn make(primitive: &mut Primitive, from: Coordinates) -> bool {
    let triangles = triangles::triangles(primitive.topology, &primitive.indices);
    if triangles.is_empty() {
        return false;
    }
    let mut mesh = Mesh { corners: Corners::new(&primitive.vertices, &triangles), from };
    if generate_tangents(&mut mesh).is_err() {
        return false;
    }
    mesh.corners.weld_into(primitive);
    true
}

struct Mesh {
    corners: Corners,
    from: Coordinates,
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
        let uv = if self.from.second { corner.uv1 } else { corner.uv0 };
        self.from.uv_from_mesh.transform_point2(uv.into()).to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vertex: usize) {
        // MikkTSpace's bitangent follows +v, which points down in glTF. glTF's bitangent points up, so the sign is
        // negated.
        let [x, y, z, sign] = space.map_or([0.0; 4], |space| space.tangent_encoded());
        self.corners.vertices[face * 3 + vertex].tangent = Vec4::new(x, y, z, -sign).to_array();
    }
}
