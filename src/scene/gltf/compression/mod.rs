//! Decodes compressed geometry into plain buffer views and accessors, before anything else reads them.

mod draco;
mod meshopt;
mod stream;

use gltf::json;

use super::file::buffers::Buffers;
use crate::scene::error::Problem;
use crate::scene::load_options::Canceled;

/// The extensions that this module decodes.
pub const EXTENSIONS: [&str; 3] = [draco::EXTENSION, meshopt::KHR, meshopt::EXT];

/// Decodes all streams. If a stream that the file does not require cannot be decoded, the uncompressed data remains, with a warning.
///
/// # Errors
/// A required stream is damaged or decodes to too much data, or the load was canceled.
pub fn decode(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    canceled: Canceled<'_>,
) -> Result<Vec<String>, Problem> {
    let mut budget = stream::MAX_DECODED_BYTES;
    let mut warnings = Vec::new();
    meshopt::decode(root, buffers, &mut budget, &mut warnings, canceled)?;
    draco::decode(root, buffers, &mut budget, &mut warnings, canceled)?;
    Ok(warnings)
}
