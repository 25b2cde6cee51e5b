//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: compressed buffer views.

use gltf::json;
use json::validation::USize64;
use meshoptimizer_rs::{Limits, Workspace, codec};
use rayon::prelude::*;
use serde::Deserialize;

use super::stream::{add_buffer, failed};
use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;
use crate::scene::gltf::left_out::LeftOut;
use crate::scene::gltf::memory::{self, Memory};
use crate::scene::gltf::place::place;
use crate::scene::load_options::Canceled;

pub const KHR: &str = "KHR_meshopt_compression";
pub const EXT: &str = "EXT_meshopt_compression";

/// The extension's object in a buffer view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compressed {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: u64,
    count: u64,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

/// A compressed view: its index, the extension that describes it, the place in messages, what the extension says.
struct Stream {
    view: usize,
    extension: &'static str,
    place: String,
    compressed: Result<Compressed, Problem>,
}

/// Decodes all compressed buffer views, each into a buffer of its own.
pub fn decode(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    memory: &Memory,
    left_out: &mut LeftOut,
    canceled: Canceled<'_>,
) {
    let decode = |Stream { view, extension, place, compressed }: Stream| {
        let decoded = match compressed {
            _ if canceled() => Err(Problem::Canceled),
            Ok(compressed) => {
                let is_vertices = matches!(compressed.mode, Mode::Attributes);
                let stride = is_vertices.then_some(json::buffer::Stride(compressed.byte_stride as usize));
                compressed.decode(root, buffers, &place).map(|bytes| (bytes, stride))
            }
            Err(problem) => Err(problem),
        };
        (view, extension, place, decoded)
    };
    let decoded: Vec<_> = streams(root, memory).into_par_iter().map(decode).collect();
    for (view, extension, place, decoded) in decoded {
        let (bytes, stride) = match decoded {
            Ok((bytes, stride)) => (Ok(bytes), stride),
            Err(problem) => match failed(root, extension, &place, problem, left_out) {
                Some(problem) => (Err(problem), None),
                None => continue,
            },
        };
        let byte_length = USize64::from(bytes.as_ref().map_or(0, Vec::len));
        let buffer = add_buffer(root, buffers, bytes);
        let view = &mut root.buffer_views[view];
        (view.buffer, view.byte_offset, view.byte_length) = (buffer, None, byte_length);
        view.byte_stride = stride.or(view.byte_stride);
    }
}

fn streams(root: &json::Root, memory: &Memory) -> Vec<Stream> {
    let mut streams = Vec::new();
    for (index, view) in root.buffer_views.iter().enumerate() {
        let others = view.extensions.as_ref().map(|extensions| &extensions.others);
        let named = others.and_then(|others| [KHR, EXT].into_iter().find_map(|name| Some((name, others.get(name)?))));
        let Some((extension, value)) = named else { continue };
        let place = format!("{}.extensions.{extension}", place("bufferViews", index, view.name.as_deref()));
        let compressed = json::deserialize::from_value(value.clone())
            .map_err(|error| Problem::invalid(&place, "a compressed buffer view", error.to_string()))
            .and_then(|compressed: Compressed| {
                memory.take(compressed.count.checked_mul(compressed.byte_stride), &place).map(|()| compressed)
            });
        streams.push(Stream { view: index, extension, place, compressed });
    }
    streams
}

impl Compressed {
    fn decode(self, root: &json::Root, buffers: &Buffers<'_>, place: &str) -> Result<Vec<u8>, Problem> {
        let Self { buffer, byte_offset, byte_length, byte_stride, count, mode, filter } = self;
        let source = buffers.range(root, buffer, byte_offset, byte_length, place)?;
        // The product fits: memory was taken for it.
        let (count, stride) = (count as usize, byte_stride as usize);
        let mut workspace = Workspace::new(Limits { max_bytes: memory::BASE as usize, ..Limits::default() });
        let damaged = |error: meshoptimizer_rs::Error| Problem::invalid(place, "a valid stream", error.to_string());
        let mut bytes = match mode {
            Mode::Attributes => codec::decode_vertex_buffer(count, stride, source, &mut workspace),
            Mode::Triangles => codec::decode_index_buffer(count, stride, source, &mut workspace),
            Mode::Indices => codec::decode_index_sequence(count, stride, source, &mut workspace),
        }
        .map_err(damaged)?;
        let apply = match filter {
            Filter::None => return Ok(bytes),
            Filter::Octahedral => codec::decode_filter_oct,
            Filter::Quaternion => codec::decode_filter_quat,
            Filter::Exponential => codec::decode_filter_exp,
            Filter::Color => codec::decode_filter_color,
        };
        apply(&mut bytes, count, stride, &mut workspace).map_err(damaged)?;
        Ok(bytes)
    }
}
