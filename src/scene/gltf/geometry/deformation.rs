//! Reads what joints (JOINTS_n, WEIGHTS_n) and morph targets do to vertices.

use glam::Vec3;
use gltf::json;
use json::accessor::{ComponentType as C, Type};
use json::mesh::Semantic;

use super::accessor::{Format, Normalized as N};
use super::formats::{NORMAL, POSITION, TEXCOORD};
use super::source::Source;
use super::triangles::face_normal;
use crate::interface as contract;
use crate::scene::error::Problem;
use crate::scene::gltf::left_out::{LeftOut, Part};
use crate::scene::gltf::place::LARGEST_COORDINATE;
use crate::scene::gltf::values;
use crate::scene::model::Vertex;
use crate::scene::motion::{Deformation, Displacement, Influence};

const JOINTS: Format = Format { types: &[Type::Vec4], components: &[(C::U8, N::No), (C::U16, N::No)] };
const WEIGHTS: Format =
    Format { types: &[Type::Vec4], components: &[(C::F32, N::No), (C::U8, N::Yes), (C::U16, N::Yes)] };
const COLOR: Format = Format {
    types: &[Type::Vec3, Type::Vec4],
    components: &[(C::F32, N::No), (C::I8, N::Yes), (C::U8, N::Yes), (C::I16, N::Yes), (C::U16, N::Yes)],
};

/// Maximum number of displacements of a primitive, which take 68 bytes each.
const MOST_DISPLACEMENTS: usize = 1 << 23;

/// Reads the deformation of a primitive with `count` vertices and these attributes; `None` if it keeps its shape. Leaves out joints and
/// targets that are invalid.
pub fn read(
    source: &Source<'_>,
    count: usize,
    attributes: u32,
    left_out: &mut LeftOut,
    warnings: &mut Vec<String>,
) -> Option<Deformation> {
    let mut deformation = Deformation::default();
    if let Some(joints) = source.joints {
        let read = left_out.unless(Part::SKIN, source.place, influences(source, count, joints));
        (deformation.influences_per_vertex, deformation.influences) = read.unwrap_or_default();
    }
    // Weights count targets, so that one that is left out keeps its place.
    let most = MOST_DISPLACEMENTS / count.max(1);
    for number in 0..source.targets.len().min(most) {
        let read = target(source, number, count, attributes, warnings);
        let target = left_out.unless(Part::TARGET, source.place, read);
        deformation.targets.push(target.unwrap_or_else(|| vec![Displacement::default(); count]));
    }
    if source.targets.len() > most {
        let expected = format!("at most {MOST_DISPLACEMENTS} vertices of morph targets");
        let found = format!("{} targets of {count} vertices", source.targets.len());
        let place = format!("{}.targets", source.place);
        left_out.add(Part::TARGET, &place, Problem::invalid(&place, expected, found));
    }
    let is_still = deformation.influences_per_vertex == 0 && deformation.targets.is_empty();
    (!is_still).then_some(deformation)
}

/// The influences of all vertices, and how many each vertex has: 4 for each pair of JOINTS_n and WEIGHTS_n.
fn influences(source: &Source<'_>, count: usize, joints: usize) -> Result<(usize, Vec<Influence>), Problem> {
    let mut sets = Vec::new();
    for number in 0.. {
        let name = |kind: &str| format!("{kind}_{number}");
        let (index, weight) = (Semantic::Joints(number), Semantic::Weights(number));
        let index = source.attribute::<4>(index, &name("JOINTS"), &JOINTS, Some(count))?;
        let weight = source.attribute::<4>(weight, &name("WEIGHTS"), &WEIGHTS, Some(count))?;
        match (index, weight) {
            (Some(index), Some(weight)) => sets.push((index, weight)),
            (None, None) => break,
            (has_joints, _) => {
                let (expected, found) =
                    if has_joints.is_some() { ("WEIGHTS", "JOINTS") } else { ("JOINTS", "WEIGHTS") };
                return Err(Problem::invalid(source.place, name(expected), format!("{} alone", name(found))));
            }
        }
    }
    let per_vertex = 4 * sets.len();
    let mut influences = Vec::with_capacity(per_vertex * count);
    for vertex in 0..count {
        let first = influences.len();
        for (index, weight) in &sets {
            for (joint, weight) in index[vertex].iter().zip(weight[vertex]) {
                let weight = if weight.is_finite() { weight.max(0.0) } else { 0.0 };
                // An index of 16 bits is exact.
                let joint = if weight > 0.0 { *joint as u32 } else { 0 };
                if joint as usize >= joints {
                    let place = format!("{}.JOINTS at vertex {vertex}", source.place);
                    return Err(Problem::invalid(place, format!("a joint of 0 to {}", joints - 1), joint.to_string()));
                }
                influences.push(Influence { joint, weight });
            }
        }
        let of_vertex = &mut influences[first..];
        let sum: f32 = of_vertex.iter().map(|influence| influence.weight).sum();
        match of_vertex.first_mut() {
            Some(first) if sum <= 0.0 => first.weight = 1.0,
            _ => of_vertex.iter_mut().for_each(|influence| influence.weight /= sum),
        }
    }
    Ok((per_vertex, influences))
}

fn target(
    source: &Source<'_>,
    number: usize,
    count: usize,
    attributes: u32,
    warnings: &mut Vec<String>,
) -> Result<Vec<Displacement>, Problem> {
    let mut target = vec![Displacement::default(); count];
    let place = |name: &str| format!("{}.targets[{number}].{name}", source.place);
    let mut bad = 0;
    let finite = |number: &mut f32, bad: &mut usize| {
        if !number.is_finite() {
            (*number, *bad) = (0.0, *bad + 1);
        }
    };
    if let Some(positions) = displacements::<3>(source, number, "POSITION", &POSITION, count)? {
        for (vertex, position) in positions.iter().enumerate() {
            if !position.iter().all(|x| x.abs() <= LARGEST_COORDINATE) {
                let expected = format!("finite coordinates up to {LARGEST_COORDINATE:e}");
                return Err(Problem::invalid(place("POSITION"), expected, format!("{position:?} at vertex {vertex}")));
            }
        }
        target.iter_mut().zip(positions).for_each(|(to, position)| to.position = position);
    }
    // Without normals in the mesh, those of its faces are used in all targets, and tangents are ignored.
    if attributes & contract::ATTRIBUTE_NORMAL != 0 {
        let normals = displacements::<3>(source, number, "NORMAL", &NORMAL, count)?;
        let tangents = displacements::<3>(source, number, "TANGENT", &NORMAL, count)?;
        target.iter_mut().zip(normals.into_iter().flatten()).for_each(|(to, normal)| to.normal = normal);
        target.iter_mut().zip(tangents.into_iter().flatten()).for_each(|(to, tangent)| to.tangent = tangent);
    }
    let uv0 = displacements::<2>(source, number, "TEXCOORD_0", &TEXCOORD, count)?;
    target.iter_mut().zip(uv0.into_iter().flatten()).for_each(|(to, uv)| (to.uv0, to.uv1) = (uv, uv));
    if attributes & contract::ATTRIBUTE_UV1 != 0 {
        let uv1 = displacements::<2>(source, number, "TEXCOORD_1", &TEXCOORD, count)?;
        let uv1 = uv1.unwrap_or_else(|| vec![[0.0; 2]; count]);
        target.iter_mut().zip(uv1).for_each(|(to, uv)| to.uv1 = uv);
    }
    let colors = displacements::<4>(source, number, "COLOR_0", &COLOR, count)?;
    target.iter_mut().zip(colors.into_iter().flatten()).for_each(|(to, color)| to.color = color);
    for to in &mut target {
        let directions = to.normal.iter_mut().chain(&mut to.tangent);
        directions.chain(&mut to.uv0).chain(&mut to.uv1).chain(&mut to.color).for_each(|x| finite(x, &mut bad));
    }
    source.note(bad, "numbers of morph targets are not finite: 0 is used", warnings);
    Ok(target)
}

/// The displacements of an attribute in a target, if present.
fn displacements<const K: usize>(
    source: &Source<'_>,
    number: usize,
    name: &str,
    format: &Format,
    count: usize,
) -> Result<Option<Vec<[f32; K]>>, Problem> {
    let Some(value) = source.targets[number].get(name) else { return Ok(None) };
    let place = format!("{}.targets[{number}].{name}", source.place);
    let accessor = json::Index::new(values::index(Some(value), &place, "accessors")? as u32);
    source.elements(accessor, &place, format, 0.0, Some(count)).map(Some)
}

/// Gives the corners of triangles the displacements that lead from the normals of the faces to those in the target.
pub fn flatten(corners: &[Vertex], target: &mut [Displacement]) {
    for (corners, target) in corners.chunks_exact(3).zip(target.chunks_exact_mut(3)) {
        let mut moved = [corners[0], corners[1], corners[2]];
        for (corner, added) in moved.iter_mut().zip(&*target) {
            corner.position = (Vec3::from(corner.position) + Vec3::from(added.position)).to_array();
        }
        let normal = Vec3::from(corners[0].normal);
        let added = face_normal(&moved, [0, 1, 2]).normalize_or(normal) - normal;
        target.iter_mut().for_each(|to| to.normal = added.to_array());
    }
}
