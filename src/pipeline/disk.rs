//! The driver's pipelines on disk.

use crate::disk_cache::{key, read, store_in};
use crate::gpu::PipelineStore;

const FOLDER: &str = "pipelines";
/// A session of some hundred edits collects more, which are not stored, bytes.
const MOST_BYTES: usize = 32 << 20;

/// Stores a driver's pipelines as one entry for each driver.
pub struct DiskPipelines;

impl PipelineStore for DiskPipelines {
    fn load(&self, driver: &[u8]) -> Option<Vec<u8>> {
        read(FOLDER, &key(&[driver]))
    }

    fn store(&self, driver: &[u8], data: &[u8]) {
        if data.len() <= MOST_BYTES {
            store_in(FOLDER, &key(&[driver]), data);
        }
    }
}
