//! A cache of descriptor sets, by the objects that they point to.

use std::collections::HashMap;
use std::sync::Arc;

use crate::gpu::{DescriptorSet, Encoder, GpuError, Pipeline};

/// Numbers that identify the objects that a set points to. A set keeps them alive, so no other object gets their numbers.
pub(super) type SetKey = Vec<usize>;

/// The sets of the last frames.
#[derive(Default)]
pub(super) struct Sets(Vec<(SetKey, Arc<DescriptorSet>)>);

impl Sets {
    /// The set of `key`, which `make` creates if the cache lacks it. A cache with `most` sets is cleared before that.
    pub(super) fn get(
        &mut self,
        key: SetKey,
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

/// The sets of what pipelines read by name, by pipeline.
#[derive(Default)]
pub(in crate::render::view) struct PassSets(HashMap<usize, Arc<DescriptorSet>>);

impl PassSets {
    /// Adds the set of a pipeline, if it has one.
    pub(super) fn insert(&mut self, pipeline: &Arc<Pipeline>, set: Option<Arc<DescriptorSet>>) {
        self.0.extend(set.map(|set| (Arc::as_ptr(pipeline) as usize, set)));
    }

    /// Binds a pipeline, and the set of what it reads by name.
    pub(in crate::render::view) fn bind(&self, encoder: &mut Encoder, pipeline: &Arc<Pipeline>) {
        encoder.bind_pipeline(pipeline);
        if let Some(set) = self.0.get(&(Arc::as_ptr(pipeline) as usize)) {
            encoder.bind_pass_set(&pipeline.layout, set);
        }
    }
}
