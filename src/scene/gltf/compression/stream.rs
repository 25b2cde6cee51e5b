//! A compressed stream of a file: its failure, and the buffer that it becomes.

use gltf::json;
use json::validation::USize64;

use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;
use crate::scene::gltf::left_out::{LeftOut, Part};

/// Leaves out a damaged stream: its uncompressed data is used if the file does not require the extension, since it then has such data.
/// Otherwise returns the problem, which is one of all that lies in the stream.
pub fn failed(
    root: &json::Root,
    extension: &str,
    place: &str,
    problem: Problem,
    left_out: &mut LeftOut,
) -> Option<Problem> {
    if root.extensions_required.iter().any(|required| required == extension) {
        return Some(problem);
    }
    left_out.add(Part::STREAM, place, problem);
    None
}

/// Adds a buffer that holds `bytes`, or cannot be read. Returns its index.
pub fn add_buffer(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    bytes: Result<Vec<u8>, Problem>,
) -> json::Index<json::Buffer> {
    let byte_length = USize64::from(bytes.as_ref().map_or(0, Vec::len));
    buffers.push(bytes);
    root.push(json::Buffer { byte_length, name: None, uri: None, extensions: None, extras: json::Extras::default() })
}
