//! A compressed stream of a file: its share of the memory, its failure, and the buffer that it becomes.

use gltf::json;
use json::validation::USize64;

use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;
use crate::scene::gltf::left_out::{LeftOut, Part};

/// Maximum number of bytes that the compressed streams of a file may decode to.
pub const MAX_DECODED_BYTES: u64 = 1 << 30;

/// Takes `bytes` from what a file may still decode to.
pub fn spend(budget: &mut u64, bytes: Option<u64>, place: &str) -> Result<(), Problem> {
    match bytes.and_then(|bytes| budget.checked_sub(bytes)) {
        Some(left) => *budget = left,
        None => {
            let found = bytes.map_or("more".into(), |bytes| format!("{bytes} more bytes"));
            let expected = format!("compressed data of at most {} MiB in all when decoded", MAX_DECODED_BYTES >> 20);
            return Err(Problem::invalid(place, expected, found));
        }
    }
    Ok(())
}

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
