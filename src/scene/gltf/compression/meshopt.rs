//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: compressed buffer views.

use gltf::json;
use json::validation::USize64;
use meshoptimizer_rs::{Limits, Workspace, codec};
use rayon::prelude::*;
use serde::Deserialize;

use super::stream::{MAX_DECODED_BYTES, add_buffer, failed, spend};
use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;
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

/// A compressed view: its index, the extension that describes it, the place in messages.
struct Stream {
    view: usize,
    extension: &'static str,
    place: String,
    compressed: Compressed,
}

/// Decodes all compressed buffer views, each into a buffer of its own.
pub fn decode(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    budget: &mut u64,
    warnings: &mut Vec<String>,
    canceled: Canceled<'_>,
) -> Result<(), Problem> {
    let streams = streams(root, budget)?;
    let decoded: Vec<_> = streams
        .par_iter()
        .map(|stream| if canceled() { Err(Problem::Canceled) } else { stream.decode(root, buffers) })
        .collect();
    for (stream, decoded) in streams.iter().zip(decoded) {
        let bytes = match decoded {
            Ok(bytes) => bytes,
            Err(problem) => {
                failed(root, stream.extension, problem, warnings)?;
                continue;
            }
        };
        let byte_length = USize64::from(bytes.len());
        let buffer = add_buffer(root, buffers, bytes);
        let view = &mut root.buffer_views[stream.view];
        (view.buffer, view.byte_offset, view.byte_length) = (buffer, None, byte_length);
        if matches!(stream.compressed.mode, Mode::Attributes) {
            view.byte_stride = Some(json::buffer::Stride(stream.compressed.byte_stride as usize));
        }
    }
    Ok(())
}

fn streams(root: &json::Root, budget: &mut u64) -> Result<Vec<Stream>, Problem> {
    let mut streams = Vec::new();
    for (index, view) in root.buffer_views.iter().enumerate() {
        let others = view.extensions.as_ref().map(|extensions| &extensions.others);
        let named = others.and_then(|others| [KHR, EXT].into_iter().find_map(|name| Some((name, others.get(name)?))));
        let Some((extension, value)) = named else { continue };
        let place = format!("{}.extensions.{extension}", place("bufferViews", index, view.name.as_deref()));
        let compressed: Compressed = json::deserialize::from_value(value.clone())
            .map_err(|error| Problem::invalid(&place, "a compressed buffer view", error.to_string()))?;
        spend(budget, compressed.count.checked_mul(compressed.byte_stride), &place)?;
        streams.push(Stream { view: index, extension, place, compressed });
    }
    Ok(streams)
}

impl Stream {
    fn decode(&self, root: &json::Root, buffers: &Buffers<'_>) -> Result<Vec<u8>, Problem> {
        let Compressed { buffer, byte_offset, byte_length, byte_stride, count, mode, filter } = self.compressed;
        let source = buffers.range(root, buffer, byte_offset, byte_length, &self.place)?;
        // `spend` has limited the product.
        let (count, stride) = (count as usize, byte_stride as usize);
        let mut workspace = Workspace::new(Limits { max_bytes: MAX_DECODED_BYTES as usize, ..Limits::default() });
        let damaged =
            |error: meshoptimizer_rs::Error| Problem::invalid(&self.place, "a valid stream", error.to_string());
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
