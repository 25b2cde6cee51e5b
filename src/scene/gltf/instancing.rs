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

/// Memory for the instances of a scene, MiB.
const MOST_MIB: usize = 1024;
/// Memory that an instance of a primitive takes at most while the model is loaded and shown, bytes: its matrices in doubles and floats, its
/// place in the hierarchy and in a pose, its draw, its records on the device.
const BYTES_EACH: usize = 1024;
/// Maximum number of instances of primitives.
const MOST: usize = (MOST_MIB << 20) / BYTES_EACH;

const VECTOR: Format = Format { types: &[Type::Vec3], components: &[(C::F32, N::No)] };
const ROTATION: Format =
    Format { types: &[Type::Vec4], components: &[(C::F32, N::No), (C::I8, N::Yes), (C::I16, N::Yes)] };

/// Replaces each mesh of an instancing node by its instances.
pub fn expand(
    reader: Reader<'_>,
    meshes: Vec<PlacedMesh>,
    left_out: &mut LeftOut,
    warnings: &mut Vec<String>,
) -> Vec<PlacedMesh> {
    let mut out = Vec::with_capacity(meshes.len());
    let (mut room, mut beyond) = (MOST, 0);
    for mesh in meshes {
        let node = &reader.root.nodes[mesh.node];
        let extension = node.extensions.as_ref().and_then(|extensions| extensions.others.get(EXTENSION));
        let Some(extension) = extension else {
            out.push(mesh);
            continue;
        };
        let place = format!("{}.extensions.{EXTENSION}", place("nodes", mesh.node, node.name.as_deref()));
        let instances = transforms(reader, &extension["attributes"], &place);
        let Some(instances) = left_out.unless(Part::INSTANCES, &place, instances) else {
            out.push(mesh);
            continue;
        };
        let primitives = reader.root.meshes[mesh.mesh].primitives.len().max(1);
        let shown = instances.len().min(room / primitives);
        room -= shown * primitives;
        beyond += instances.len() - shown;
        out.extend(instances[..shown].iter().map(|instance| PlacedMesh {
            name: mesh.name.clone(),
            world_from_object: mesh.world_from_object * *instance,
            node_from_object: Some(*instance),
            ..mesh
        }));
    }
    if beyond > 0 {
        let full = format!("{MOST} instances of primitives take the {MOST_MIB} MiB that there are for them");
        warnings.push(format!("{EXTENSION}: {full}; {beyond} more are left out. Export fewer of them."));
    }
    out
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
