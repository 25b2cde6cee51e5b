//! Reads primitives: attributes, indices, flat normals.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use gltf::json;
use json::mesh::{Mode, Semantic};
use json::validation::Checked;

use super::accessor::Reader;
use super::deformation;
use super::formats::{COLOR, NORMAL, POSITION, TANGENT, TEXCOORD};
use super::source::Source;
use super::triangles::{self, Corners};
use crate::interface as contract;
use crate::scene::error::Problem;
use crate::scene::gltf::left_out::{LeftOut, Part};
use crate::scene::gltf::motion::raw::RawMesh;
use crate::scene::gltf::place::{LARGEST_COORDINATE, get, place};
use crate::scene::gltf::variants;
use crate::scene::model::{Bounds, Material, Primitive, Topology, Vertex};

/// A primitive and its warnings.
pub struct Geometry {
    /// The primitive; `tangents::complete` finishes it.
    pub primitive: Primitive,
    /// One sentence each.
    pub warnings: Vec<String>,
}

/// Maximum number of indices of a primitive. As lists, strips and fans become three times as long, and each corner may become
/// a vertex.
const MAX_INDICES: usize = 1 << 30;

/// Reads the drawable primitives of a mesh, and what it leaves out. `joints`: how many the skins have with which it is shown.
pub fn read(
    reader: Reader<'_>,
    index: usize,
    materials: &[Material],
    variants: usize,
    (raw, joints): (&RawMesh, Option<usize>),
) -> (Vec<Geometry>, LeftOut) {
    let mut left_out = LeftOut::default();
    let mesh = &reader.root.meshes[index];
    let mesh_place = place("meshes", index, mesh.name.as_deref());
    let mut geometries = Vec::with_capacity(mesh.primitives.len());
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let place = format!("{mesh_place}.primitives[{number}]");
        let title = mesh.name.as_deref().filter(|name| !name.is_empty());
        let name = format!("{} #{number}", title.map_or_else(|| format!("mesh {index}"), str::to_owned));
        let source = Source { reader, primitive, targets: raw.targets(number), joints, place: &place };
        let read = source.read(name, &mut left_out);
        let Some(mut geometry) = left_out.unless(Part::PRIMITIVE, &place, read) else { continue };
        let material = primitive.material.and_then(|material| {
            let known = get(&reader.root.materials, material, &place, "materials");
            // Index 0 is the default material.
            left_out.unless(Part::MATERIAL, &place, known).map(|_| material.value() + 1)
        });
        let material = material.unwrap_or_default();
        debug_assert!(material < materials.len());
        let mapping = variants::mapping(primitive, variants, reader.root.materials.len(), &place);
        let mapping = left_out.unless(Part::MAPPING, &place, mapping).unwrap_or_default();
        let in_variants = mapping.into_iter().map(|(of, material)| (of, material + 1)).collect();
        let of_geometry = &mut geometry.primitive;
        (of_geometry.material, of_geometry.default_material) = (material, material);
        of_geometry.variant_materials = in_variants;
        geometries.push(geometry);
    }
    (geometries, left_out)
}

impl Source<'_> {
    /// The primitive, with the default material.
    fn read(&self, name: String, left_out: &mut LeftOut) -> Result<Geometry, Problem> {
        let mut warnings = Vec::new();
        let Some(positions) = self.attribute::<3>(Semantic::Positions, "POSITION", &POSITION, None)? else {
            return Err(Problem::invalid(self.place, "the attribute POSITION", "none"));
        };
        self.check_positions(&positions)?;
        let count = positions.len();
        let (topology, indices) = self.indices(count, &mut warnings)?;
        // Without normals or tangents, each corner may become a vertex.
        self.reader.memory.take_of::<Vertex>(count.saturating_add(indices.len()), self.place)?;
        let mut attributes = 0;
        let mut vertices: Vec<Vertex> = positions
            .into_iter()
            .map(|position| Vertex { position, normal: [0.0, 0.0, 1.0], color: [1.0; 4], ..Vertex::default() })
            .collect();
        if let Some(normals) = self.attribute::<3>(Semantic::Normals, "NORMAL", &NORMAL, Some(count))? {
            attributes |= contract::ATTRIBUTE_NORMAL;
            vertices.iter_mut().zip(normals).for_each(|(vertex, normal)| vertex.normal = normal);
            let bad = repair_normals(&mut vertices, topology, &indices);
            self.note(bad, "normals are zero or not finite: those of their faces are used", &mut warnings);
        }
        // Without normals, tangents must be ignored as well (glTF 2.0, section 3.7.2.1).
        if attributes & contract::ATTRIBUTE_NORMAL != 0
            && let Some(tangents) = self.attribute::<4>(Semantic::Tangents, "TANGENT", &TANGENT, Some(count))?
        {
            attributes |= contract::ATTRIBUTE_TANGENT;
            vertices.iter_mut().zip(tangents).for_each(|(vertex, tangent)| vertex.tangent = tangent);
        }
        attributes |= self.read_uvs_and_colors(&mut vertices, &mut warnings)?;
        let deformation = deformation::read(self, count, attributes, left_out, &mut warnings).map(Arc::new);
        let mut primitive = Primitive {
            name,
            vertices,
            indices,
            topology,
            material: 0,
            default_material: 0,
            variant_materials: Vec::new(),
            attributes,
            bounds: Bounds::default(),
            deformation,
        };
        if attributes & contract::ATTRIBUTE_NORMAL == 0 && triangles::has_faces(topology) {
            make_flat(&mut primitive);
        }
        for &index in &primitive.indices {
            primitive.bounds.include(Vec3::from(primitive.vertices[index as usize].position));
        }
        Ok(Geometry { primitive, warnings })
    }

    fn check_positions(&self, positions: &[[f32; 3]]) -> Result<(), Problem> {
        // The comparison is also false for NaN.
        let bad = positions.iter().position(|position| !position.iter().all(|x| x.abs() <= LARGEST_COORDINATE));
        match bad {
            None => Ok(()),
            Some(vertex) => {
                let place = format!("{}.POSITION", self.place);
                let found = format!("{:?} at vertex {vertex}", positions[vertex]);
                Err(Problem::invalid(place, format!("finite coordinates up to {LARGEST_COORDINATE:e}"), found))
            }
        }
    }

    /// The topology and its indices: in range, without incomplete primitives, enough to draw, and with loops as strips.
    fn indices(&self, vertices: usize, warnings: &mut Vec<String>) -> Result<(Topology, Vec<u32>), Problem> {
        let place = format!("{}.indices", self.place);
        let mut indices = match self.primitive.indices {
            Some(accessor) => self.reader.indices(accessor, &place)?,
            None => match u32::try_from(vertices) {
                Ok(count) => (0..count).collect(),
                Err(_) => return Err(Problem::invalid(place, "fewer than 2^32 vertices", vertices.to_string())),
            },
        };
        if let Some(&index) = indices.iter().find(|&&index| index as usize >= vertices) {
            return Err(Problem::invalid(
                place,
                format!("indices below the vertex count of {vertices}"),
                index.to_string(),
            ));
        }
        let topology = match self.primitive.mode {
            Checked::Valid(Mode::Points) => Topology::Points,
            Checked::Valid(Mode::Lines) => Topology::Lines,
            Checked::Valid(Mode::LineLoop) => {
                indices.extend(indices.first().copied());
                Topology::LineStrip
            }
            Checked::Valid(Mode::LineStrip) => Topology::LineStrip,
            Checked::Valid(Mode::Triangles) => Topology::Triangles,
            Checked::Valid(Mode::TriangleStrip) => Topology::TriangleStrip,
            Checked::Valid(Mode::TriangleFan) => Topology::TriangleFan,
            Checked::Invalid => {
                return Err(Problem::invalid(format!("{}.mode", self.place), "a mode of 0 to 6", "another"));
            }
        };
        if indices.len() > MAX_INDICES {
            return Err(Problem::invalid(place, format!("at most {MAX_INDICES} indices"), indices.len().to_string()));
        }
        let least = triangles::least(topology);
        if indices.len() < least {
            let expected = format!("at least {least} indices or vertices for {topology:?}");
            return Err(Problem::invalid(place, expected, indices.len().to_string()));
        }
        let excess = triangles::excess(topology, indices.len());
        if excess > 0 {
            warnings.push(format!("{place} ends in an incomplete primitive: the last {excess} are left out."));
            indices.truncate(indices.len() - excess);
        }
        Ok((topology, indices))
    }

    fn read_uvs_and_colors(&self, vertices: &mut [Vertex], warnings: &mut Vec<String>) -> Result<u32, Problem> {
        let count = Some(vertices.len());
        let mut attributes = 0;
        let mut bad = 0;
        let mut checked = |uv: [f32; 2]| {
            let valid = Vec2::from(uv).is_finite();
            bad += usize::from(!valid);
            if valid { uv } else { [0.0; 2] }
        };
        if let Some(uvs) = self.attribute::<2>(Semantic::TexCoords(0), "TEXCOORD_0", &TEXCOORD, count)? {
            attributes |= contract::ATTRIBUTE_UV0;
            vertices.iter_mut().zip(uvs).for_each(|(vertex, uv)| vertex.uv0 = checked(uv));
        }
        vertices.iter_mut().for_each(|vertex| vertex.uv1 = vertex.uv0);
        if let Some(uvs) = self.attribute::<2>(Semantic::TexCoords(1), "TEXCOORD_1", &TEXCOORD, count)? {
            attributes |= contract::ATTRIBUTE_UV1;
            vertices.iter_mut().zip(uvs).for_each(|(vertex, uv)| vertex.uv1 = checked(uv));
        }
        self.note(bad, "texture coordinates are not finite: 0 is used", warnings);
        if let Some(colors) = self.attribute::<4>(Semantic::Colors(0), "COLOR_0", &COLOR, count)? {
            attributes |= contract::ATTRIBUTE_COLOR;
            let bad = colors.iter().filter(|color| !Vec4::from(**color).is_finite()).count();
            let beyond = |color: &[f32; 4]| color.iter().any(|c| c.is_finite() && !(0.0..=1.0).contains(c));
            let clamped = colors.iter().filter(|color| beyond(color)).count();
            let usable = |color: [f32; 4]| match Vec4::from(color).is_finite() {
                true => color.map(|c| c.clamp(0.0, 1.0)),
                false => [1.0; 4],
            };
            vertices.iter_mut().zip(colors).for_each(|(vertex, color)| vertex.color = usable(color));
            self.note(bad, "vertex colors are not finite: white is used", warnings);
            self.note(clamped, "vertex colors are not within 0..1: the nearest that is, is used", warnings);
        }
        Ok(attributes)
    }
}

/// Normalizes all normals. A zero or non-finite normal becomes that of the faces around it, or +Z. Returns their number.
fn repair_normals(vertices: &mut [Vertex], topology: Topology, indices: &[u32]) -> usize {
    let mut broken = Vec::new();
    for (index, vertex) in vertices.iter_mut().enumerate() {
        match Vec3::from(vertex.normal).try_normalize() {
            Some(normal) => vertex.normal = normal.to_array(),
            None => {
                vertex.normal = [0.0; 3];
                broken.push(index);
            }
        }
    }
    if broken.is_empty() {
        return 0;
    }
    let mut sums = vec![Vec3::ZERO; vertices.len()];
    for triangle in triangles::triangles(topology, indices) {
        let normal = triangles::face_normal(vertices, triangle);
        triangle.iter().for_each(|&index| sums[index as usize] += normal);
    }
    for &index in &broken {
        vertices[index].normal = sums[index].normalize_or(Vec3::Z).to_array();
    }
    broken.len()
}

/// Gives every triangle a flat normal. It then shares vertices only with coplanar neighbors.
fn make_flat(primitive: &mut Primitive) {
    let triangles = triangles::triangles(primitive.topology, &primitive.indices);
    if triangles.is_empty() {
        return;
    }
    let mut corners = Corners::new(&primitive.vertices, &triangles);
    corners.flatten(Vec3::Z);
    match primitive.deformation.clone().filter(|deformation| !deformation.targets.is_empty()) {
        None => corners.weld_into(primitive),
        // Coplanar neighbors may not be so in a target, so that no corners are joined.
        Some(deformation) => {
            let mut deformation = deformation.of_copies(&corners.source);
            deformation.targets.iter_mut().for_each(|target| deformation::flatten(&corners.vertices, target));
            primitive.deformation = Some(Arc::new(deformation));
            // The number of corners fits u32, as indices do.
            primitive.indices = (0..corners.vertices.len() as u32).collect();
            primitive.vertices = corners.vertices;
            primitive.topology = Topology::Triangles;
        }
    }
}
