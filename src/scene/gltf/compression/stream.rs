//! A compressed stream of a file: its share of the memory, its failure, and the buffer that it becomes.

use gltf::json;
use json::validation::USize64;

use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;

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

/// The error of a stream that the file requires; a warning otherwise, since the file has uncompressed data as well.
pub fn failed(root: &json::Root, extension: &str, problem: Problem, warnings: &mut Vec<String>) -> Result<(), Problem> {
    match problem {
        Problem::Invalid { place, expected, found } if !root.extensions_required.iter().any(|r| r == extension) => {
            warnings.push(format!("{place}: expected {expected}, found {found}. Its uncompressed data is used."));
            Ok(())
        }
        problem => Err(problem),
    }
}

/// Adds a buffer that holds `bytes`. Returns its index.
pub fn add_buffer(root: &mut json::Root, buffers: &mut Buffers<'_>, bytes: Vec<u8>) -> json::Index<json::Buffer> {
    let byte_length = USize64::from(bytes.len());
    buffers.push(bytes);
    root.push(json::Buffer { byte_length, name: None, uri: None, extensions: None, extras: json::Extras::default() })
}
