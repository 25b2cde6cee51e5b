//! `EXT_mesh_gpu_instancing`: a node that shows its mesh many times.

use glam::{DMat4, Quat, Vec3, Vec4};
use gltf::json;
use json::accessor::{ComponentType as C, Type};

use super::geometry::accessor::{Format, Normalized as N, Reader};
use super::left_out::{LeftOut, Part};
use super::nodes::PlacedMesh;
use super::place::place;
use super::values;
use crate::scene::error::Problem;

/// The extension's name.
pub const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// Memory that an instance of a primitive takes at most while the model is loaded and shown, bytes: its matrices in doubles and floats, its
/// place in the hierarchy and in a pose, its draw, its records on the device.
const BYTES_EACH: u64 = 1024;

const VECTOR: Format = Format { types: &[Type::Vec3], components: &[(C::F32, N::No)] };
const ROTATION: Format =
    Format { types: &[Type::Vec4], components: &[(C::F32, N::No), (C::I8, N::Yes), (C::I16, N::Yes)] };

/// Replaces each mesh of an instancing node by its instances. Leaves out meshes and instances for which the file has no memory left.
///
/// # Errors
/// There is memory for none.
pub fn expand(
    reader: Reader<'_>,
    meshes: Vec<PlacedMesh>,
    left_out: &mut LeftOut,
    warnings: &mut Vec<String>,
) -> Result<Vec<PlacedMesh>, Problem> {
    let mut out = Vec::with_capacity(meshes.len());
    let (mut beyond, mut lacking) = (0, 0_u64);
    for mesh in meshes {
        let node = &reader.root.nodes[mesh.node];
        let extension = node.extensions.as_ref().and_then(|extensions| extensions.others.get(EXTENSION));
        let instances = extension.and_then(|extension| {
            let place = format!("{}.extensions.{EXTENSION}", place("nodes", mesh.node, node.name.as_deref()));
            left_out.unless(Part::INSTANCES, &place, transforms(reader, &extension["attributes"], &place))
        });
        let count = instances.as_ref().map_or(1, Vec::len) as u64;
        let primitives = reader.root.meshes[mesh.mesh].primitives.len() as u64;
        let each = BYTES_EACH * primitives.max(1);
        let shown = reader.memory.take_most(count, each);
        beyond += count - shown;
        lacking = lacking.saturating_add((count - shown).saturating_mul(each));
        match instances {
            None if shown == 0 => {}
            None => out.push(mesh),
            // It fits: it is not above the length.
            Some(instances) => out.extend(instances[..shown as usize].iter().map(|instance| PlacedMesh {
                name: mesh.name.clone(),
                world_from_object: mesh.world_from_object * *instance,
                node_from_object: Some(*instance),
                ..mesh
            })),
        }
    }
    if beyond > 0 {
        if out.is_empty() {
            reader.memory.take(Some(lacking), "nodes")?;
        }
        warnings.push(format!(
            "its instances of meshes would take {} MiB more than there are for so small a file; {beyond} of them are left out. \
             Export fewer of them.",
            (lacking >> 20) + 1
        ));
    }
    Ok(out)
}

/// The transform of each instance, relative to its node.
fn transforms(reader: Reader<'_>, attributes: &json::Value, place: &str) -> Result<Vec<DMat4>, Problem> {
    let index = |name: &str| {
        let place = format!("{place}.attributes.{name}");
        let index = attributes.get(name).map(|value| values::index(Some(value), &place, "accessors")).transpose()?;
        Ok(index.map(|index| (json::Index::new(index as u32), place)))
    };
    fn read<const K: usize>(
        reader: Reader<'_>,
        accessor: Option<(json::Index<json::Accessor>, String)>,
        format: &Format,
    ) -> Result<Option<Vec<[f32; K]>>, Problem> {
        accessor.map(|(index, place)| reader.floats(index, format, 0.0, &place)).transpose()
    }
    let translations = read::<3>(reader, index("TRANSLATION")?, &VECTOR)?;
    let rotations = read::<4>(reader, index("ROTATION")?, &ROTATION)?;
    let scales = read::<3>(reader, index("SCALE")?, &VECTOR)?;
    let counts = [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    let mut present = counts.into_iter().flatten();
    let Some(count) = present.next() else {
        return Err(Problem::invalid(place, "TRANSLATION, ROTATION or SCALE", "none of them"));
    };
    if let Some(other) = present.find(|other| *other != count) {
        return Err(Problem::invalid(place, "attributes of equal count", format!("{count} and {other}")));
    }
    let transform = |at: usize| {
        let translation = translations.as_ref().map_or(Vec3::ZERO, |all| all[at].into());
        let rotation = rotations.as_ref().map_or(Vec4::W, |all| all[at].into());
        let rotation = Quat::from_vec4(rotation.try_normalize().unwrap_or(Vec4::W));
        let scale = scales.as_ref().map_or(Vec3::ONE, |all| all[at].into());
        let transform =
            DMat4::from_scale_rotation_translation(scale.as_dvec3(), rotation.as_dquat(), translation.as_dvec3());
        match transform.is_finite() {
            true => Ok(transform),
            false => Err(Problem::invalid(place, "finite transforms", format!("another at instance {at}"))),
        }
    };
    (0..count).map(transform).collect()
}
