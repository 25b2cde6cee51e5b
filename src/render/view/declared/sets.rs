//! A cache of descriptor sets, by the objects that they point to.

use std::sync::Arc;

use crate::gpu::{DescriptorSet, GpuError};

/// Numbers that identify the objects that a set points to. A set keeps them alive, so no other object gets their numbers.
pub(super) type Key = Vec<usize>;

/// The sets of the last frames.
#[derive(Default)]
pub(super) struct Sets(Vec<(Key, Arc<DescriptorSet>)>);

impl Sets {
    /// The set of `key`, which `make` creates if the cache lacks it. A cache with `most` sets is cleared before that.
    pub(super) fn get(
        &mut self,
        key: Key,
        most: usize,
        make: impl FnOnce() -> Result<Arc<DescriptorSet>, GpuError>,
    ) -> Result<Arc<DescriptorSet>, GpuError> {
        if let Some((_, set)) = self.0.iter().find(|(known, _)| *known == key) {
            return Ok(set.clone());
        }
        let set = make()?;
        if self.0.len() >= most {
            self.0.clear();
        }
        self.0.push((key, set.clone()));
        Ok(set)
    }

    /// Drops all sets, and with them their references to the objects that they point to.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}
