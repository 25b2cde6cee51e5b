//! `KHR_draco_mesh_compression`: compressed primitives.

use std::collections::BTreeMap;

use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use gltf::json;
use json::accessor::{Accessor, ComponentType as C, GenericComponentType, Type};
use json::buffer::View;
use json::mesh::{Mode, Semantic};
use json::validation::{Checked, USize64};
use rayon::prelude::*;
use serde::Deserialize;

use super::stream::{add_buffer, failed};
use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;
use crate::scene::gltf::left_out::LeftOut;
use crate::scene::gltf::memory::{self, Memory};
use crate::scene::gltf::place::place;
use crate::scene::load_options::Canceled;

pub const EXTENSION: &str = "KHR_draco_mesh_compression";

/// The extension's object in a primitive.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compressed {
    buffer_view: json::Index<View>,
    /// The unique id in the stream of each attribute.
    attributes: BTreeMap<String, u32>,
}

/// A compressed primitive: the index of its mesh, its own, and its place in messages.
struct Stream {
    mesh: usize,
    primitive: usize,
    place: String,
}

/// A decoded primitive.
struct Decoded {
    /// Of triangles.
    indices: Vec<u32>,
    /// The data of each attribute, tightly packed in its accessor's format.
    attributes: Vec<(Checked<Semantic>, Vec<u8>)>,
    vertices: usize,
}

/// Decodes all compressed primitives, each into a buffer and accessors of its own.
pub fn decode(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    memory: &Memory,
    left_out: &mut LeftOut,
    canceled: Canceled<'_>,
) {
    let decode = |(stream, compressed): (Stream, Result<Compressed, Problem>)| {
        let decoded = match compressed {
            _ if canceled() => Err(Problem::Canceled),
            Ok(compressed) => stream.decode(&compressed, root, buffers),
            Err(problem) => Err(problem),
        };
        (stream, decoded)
    };
    let decoded: Vec<_> = streams(root, memory).into_par_iter().map(decode).collect();
    for (stream, decoded) in decoded {
        match decoded {
            Ok(decoded) => stream.replace(decoded, root, buffers),
            Err(problem) => {
                if let Some(problem) = failed(root, EXTENSION, &stream.place, problem, left_out) {
                    stream.lose(problem, root, buffers);
                }
            }
        }
    }
}

fn streams(root: &json::Root, memory: &Memory) -> Vec<(Stream, Result<Compressed, Problem>)> {
    let mut streams = Vec::new();
    for (mesh_index, mesh) in root.meshes.iter().enumerate() {
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let extension = primitive.extensions.as_ref().and_then(|extensions| extensions.others.get(EXTENSION));
            let Some(value) = extension else { continue };
            let mesh = place("meshes", mesh_index, mesh.name.as_deref());
            let place = format!("{mesh}.primitives[{index}].extensions.{EXTENSION}");
            let accessors = primitive.attributes.values().chain(&primitive.indices);
            let bytes = accessors.filter_map(|accessor| root.accessors.get(accessor.value())).map(claimed_bytes);
            let compressed = json::deserialize::from_value(value.clone())
                .map_err(|error| Problem::invalid(&place, "a compressed primitive", error.to_string()))
                .and_then(|compressed: Compressed| memory.take(bytes.sum(), &place).map(|()| compressed));
            streams.push((Stream { mesh: mesh_index, primitive: index, place }, compressed));
        }
    }
    streams
}

/// Bytes of an accessor's elements, tightly packed; `None` if they do not fit 64 bits.
fn claimed_bytes(accessor: &Accessor) -> Option<u64> {
    accessor
        .count
        .0
        .checked_mul(format(accessor).map_or(4, |(kind, component)| kind.multiplicity() * component.size()) as u64)
}

/// The type and component type of an accessor, if glTF defines them.
fn format(accessor: &Accessor) -> Option<(Type, C)> {
    match (accessor.type_, accessor.component_type) {
        (Checked::Valid(kind), Checked::Valid(component)) => Some((kind, component.0)),
        _ => None,
    }
}

impl Stream {
    fn decode(&self, compressed: &Compressed, root: &json::Root, buffers: &Buffers<'_>) -> Result<Decoded, Problem> {
        let primitive = &root.meshes[self.mesh].primitives[self.primitive];
        let source = buffers.view(root, compressed.buffer_view, &self.place)?;
        let limits = DecodeLimits::default().with_max_decoded_bytes(memory::BASE).with_max_faces(memory::BASE / 12);
        let mut mesh = Mesh::new();
        MeshDecoder::new()
            .decode(&mut DecoderBuffer::new(source).with_limits(limits), &mut mesh)
            .map_err(|error| Problem::invalid(&self.place, "a valid stream", error.to_string()))?;
        let vertices = mesh.num_points();
        let mut attributes = Vec::new();
        for (semantic, accessor) in &primitive.attributes {
            let name = semantic.to_string();
            let Some(&id) = compressed.attributes.get(&name) else { continue };
            let stored = mesh.attribute_by_unique_id(id).ok_or_else(|| {
                Problem::invalid(&self.place, format!("an attribute {id} in the stream ({name})"), "none")
            })?;
            let accessor = root.accessors.get(accessor.value()).and_then(format);
            let (kind, component) =
                accessor.ok_or_else(|| Problem::invalid(&self.place, format!("an accessor of {name}"), "none"))?;
            attributes.push((semantic.clone(), values(stored, vertices, kind.multiplicity(), component)));
        }
        let indices = mesh.faces().iter().flatten().map(|point| point.0).collect();
        Ok(Decoded { indices, attributes, vertices })
    }

    /// Points the primitive to accessors that hold the decoded data.
    fn replace(&self, decoded: Decoded, root: &mut json::Root, buffers: &mut Buffers<'_>) {
        for (semantic, bytes) in decoded.attributes {
            let old = root.meshes[self.mesh].primitives[self.primitive].attributes[&semantic];
            let accessor = Accessor { count: USize64::from(decoded.vertices), ..root.accessors[old.value()].clone() };
            let new = add(root, buffers, Ok(bytes), accessor);
            root.meshes[self.mesh].primitives[self.primitive].attributes.insert(semantic, new);
        }
        let bytes = decoded.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = add(root, buffers, Ok(bytes), plain(Type::Scalar, C::U32, decoded.indices.len()));
        let primitive = &mut root.meshes[self.mesh].primitives[self.primitive];
        // A stream holds triangles, whatever the mode says.
        (primitive.indices, primitive.mode) = (Some(indices), Checked::Valid(Mode::Triangles));
    }

    /// Points the primitive to positions that cannot be read. Its own accessors have no data, and would be read as zeros.
    fn lose(&self, problem: Problem, root: &mut json::Root, buffers: &mut Buffers<'_>) {
        let positions = add(root, buffers, Err(problem), plain(Type::Vec3, C::F32, 1));
        let primitive = &mut root.meshes[self.mesh].primitives[self.primitive];
        primitive.attributes = [(Checked::Valid(Semantic::Positions), positions)].into();
        primitive.indices = None;
    }
}

/// Adds an accessor whose data are these bytes. Returns its index.
fn add(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    bytes: Result<Vec<u8>, Problem>,
    accessor: Accessor,
) -> json::Index<Accessor> {
    let byte_length = USize64::from(bytes.as_ref().map_or(0, Vec::len));
    let buffer = add_buffer(root, buffers, bytes);
    let view = root.push(View {
        buffer,
        byte_length,
        byte_offset: None,
        byte_stride: None,
        name: None,
        target: None,
        extensions: None,
        extras: json::Extras::default(),
    });
    root.push(Accessor { buffer_view: Some(view), byte_offset: None, ..accessor })
}

/// An accessor of tightly packed elements.
fn plain(kind: Type, component: C, count: usize) -> Accessor {
    Accessor {
        buffer_view: None,
        byte_offset: None,
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component)),
        extensions: None,
        extras: json::Extras::default(),
        type_: Checked::Valid(kind),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
    }
}

/// The values of an attribute for each vertex, converted to `component`; 0 where the stream has none.
fn values(attribute: &PointAttribute, vertices: usize, components: usize, component: C) -> Vec<u8> {
    let stored = attribute.data_type();
    let (width, stride) = (stored.byte_length(), attribute.byte_stride().max(0) as usize);
    let data = attribute.buffer().data();
    let present = components.min(usize::from(attribute.num_components()));
    let mut out = vec![0; vertices * components * component.size()];
    for (vertex, out) in out.chunks_exact_mut(components * component.size()).enumerate() {
        // The number of vertices fits u32, as the stream's own indices do.
        let value = attribute.mapped_index(PointIndex(vertex as u32)).0 as usize;
        let start = value.saturating_mul(stride);
        let Some(from) = data.get(start..).and_then(|data| data.get(..present * width)) else { continue };
        for (from, to) in from.chunks_exact(width.max(1)).zip(out.chunks_exact_mut(component.size())) {
            convert(stored, from, component, to);
        }
    }
    out
}

/// Converts a number. All that glTF can store fits a double.
fn convert(stored: DataType, from: &[u8], component: C, to: &mut [u8]) {
    macro_rules! number {
        ($kind:ty) => {
            from.try_into().map_or(0.0, |bytes| <$kind>::from_le_bytes(bytes) as f64)
        };
    }
    let value = match stored {
        DataType::Int8 => number!(i8),
        DataType::Uint8 | DataType::Bool => number!(u8),
        DataType::Int16 => number!(i16),
        DataType::Uint16 => number!(u16),
        DataType::Int32 => number!(i32),
        DataType::Uint32 => number!(u32),
        DataType::Int64 => number!(i64),
        DataType::Uint64 => number!(u64),
        DataType::Float32 => number!(f32),
        DataType::Float64 => number!(f64),
        _ => 0.0,
    };
    match component {
        C::I8 => to.copy_from_slice(&(value as i8).to_le_bytes()),
        C::U8 => to.copy_from_slice(&(value as u8).to_le_bytes()),
        C::I16 => to.copy_from_slice(&(value as i16).to_le_bytes()),
        C::U16 => to.copy_from_slice(&(value as u16).to_le_bytes()),
        C::U32 => to.copy_from_slice(&(value as u32).to_le_bytes()),
        C::F32 => to.copy_from_slice(&(value as f32).to_le_bytes()),
    }
}
