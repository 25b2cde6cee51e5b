//! Decodes compressed geometry into plain buffer views and accessors, before anything else reads them.

mod draco;
mod meshopt;
mod stream;

use gltf::json;

use super::file::buffers::Buffers;
use super::left_out::LeftOut;
use super::memory::Memory;
use crate::scene::error::Problem;
use crate::scene::load_options::Canceled;

/// The extensions that this module decodes.
pub const EXTENSIONS: [&str; 3] = [draco::EXTENSION, meshopt::KHR, meshopt::EXT];

/// Decodes all streams. One that is damaged or decodes to too much data costs the parts that lie in it, unless the file has them
/// uncompressed as well.
///
/// # Errors
/// The load was canceled.
pub fn decode(
    root: &mut json::Root,
    buffers: &mut Buffers<'_>,
    memory: &Memory,
    left_out: &mut LeftOut,
    canceled: Canceled<'_>,
) -> Result<(), Problem> {
    meshopt::decode(root, buffers, memory, left_out, canceled);
    draco::decode(root, buffers, memory, left_out, canceled);
    if canceled() { Err(Problem::Canceled) } else { Ok(()) }
}
