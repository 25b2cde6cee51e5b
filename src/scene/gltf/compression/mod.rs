//! Decodes compressed geometry into plain buffer views and accessors, before anything else reads them.

mod draco;
mod meshopt;

use gltf::json;
use json::validation::USize64;

use super::file::buffers::Buffers;
use crate::scene::error::Problem;
use crate::scene::load_options::Canceled;

/// The extensions that this module decodes.
pub const EXTENSIONS: [&str; 3] = [draco::EXTENSION, meshopt::KHR, meshopt::EXT];

/// Maximum number of bytes that the compressed streams of a file may decode to.
const MAX_DECODED_BYTES: u64 = 1 << 30;

/// Decodes all streams. If a stream that the file does not require cannot be decoded, the uncompressed data remains, with a warning.
///
/// # Errors
/// A required stream is damaged or decodes to too much data, or the load was canceled.
pub fn decode(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    canceled: Canceled<'_>,
) -> Result<Vec<String>, Problem> {
    let mut budget = MAX_DECODED_BYTES;
    let mut warnings = Vec::new();
    meshopt::decode(root, buffers, &mut budget, &mut warnings, canceled)?;
    draco::decode(root, buffers, &mut budget, &mut warnings, canceled)?;
    Ok(warnings)
}

/// Takes `bytes` from what a file may still decode to.
fn spend(budget: &mut u64, bytes: Option<u64>, place: &str) -> Result<(), Problem> {
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
fn failed(root: &json::Root, extension: &str, problem: Problem, warnings: &mut Vec<String>) -> Result<(), Problem> {
    match problem {
        Problem::Invalid { place, expected, found } if !root.extensions_required.iter().any(|r| r == extension) => {
            warnings.push(format!("{place}: expected {expected}, found {found}. Its uncompressed data is used."));
            Ok(())
        }
        problem => Err(problem),
    }
}

/// Adds a buffer that holds `bytes`. Returns its index.
fn add_buffer(root: &mut json::Root, buffers: &mut Buffers<'_>, bytes: Vec<u8>) -> json::Index<json::Buffer> {
    let byte_length = USize64::from(bytes.len());
    buffers.push(bytes);
    root.push(json::Buffer { byte_length, name: None, uri: None, extensions: None, extras: json::Extras::default() })
}
