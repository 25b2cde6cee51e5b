//! The pipelines of a picture.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Weak};

use crate::frame::{PipelineKey, PipelineRequest};
use crate::gpu::{ComputePipeline, Pipeline, ResourceUsage};
use crate::interface::{BINDING_ENVIRONMENT, CLOCK, KEYS, MOTION};
use crate::pipeline::textures::PassTextures;

/// The pipelines of one [`PipelineRequest`], and the textures of its passes.
pub(crate) struct BoundPipelines {
    pipelines: HashMap<PipelineKey, Arc<Pipeline>>,
    /// Of compute passes and of the stage that moves vertices, by stage.
    computes: HashMap<String, Arc<ComputePipeline>>,
    textures: Arc<PassTextures>,
    /// Whether a stage reads the clock.
    pub(crate) read_clock: bool,
    /// Whether a stage reads keys.
    pub(crate) read_keys: bool,
    /// Whether a stage reads how the camera has moved since the frame before.
    pub(crate) read_motion: bool,
    /// Whether a stage reads the environment's cube map.
    pub(crate) read_cube: bool,
}

impl BoundPipelines {
    pub(super) fn new(
        pipelines: HashMap<PipelineKey, Arc<Pipeline>>,
        computes: HashMap<String, Arc<ComputePipeline>>,
        textures: Arc<PassTextures>,
    ) -> Self {
        let uses =
            pipelines.values().map(|pipeline| &pipeline.usage).chain(computes.values().map(|compute| &compute.usage));
        let uses: Vec<&ResourceUsage> = uses.collect();
        let read = |bytes: &[Range<usize>]| uses.iter().any(|uses| uses.reads_frame(bytes));
        let (read_clock, read_keys, read_motion) = (read(&CLOCK), read(&[KEYS]), read(&[MOTION]));
        let read_cube = uses.iter().any(|uses| uses.frame_bindings.contains(&BINDING_ENVIRONMENT));
        Self { pipelines, computes, textures, read_clock, read_keys, read_motion, read_cube }
    }

    pub(crate) fn get(&self, key: &PipelineKey) -> Option<&Arc<Pipeline>> {
        self.pipelines.get(key)
    }

    /// The pipeline of a compute stage.
    pub(crate) fn compute(&self, stage: &str) -> Option<&Arc<ComputePipeline>> {
        self.computes.get(stage)
    }

    /// The textures that the tree declares.
    pub(crate) fn textures(&self) -> &PassTextures {
        &self.textures
    }

    /// Whether both hold the same objects.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        if std::ptr::eq(self, other) {
            return true;
        }
        let same_compute = |(stage, pipeline): (&String, &Arc<ComputePipeline>)| {
            other.computes.get(stage).is_some_and(|o| Arc::ptr_eq(o, pipeline))
        };
        let same_computes = self.computes.len() == other.computes.len() && self.computes.iter().all(same_compute);
        if !same_computes || !Arc::ptr_eq(&self.textures, &other.textures) {
            return false;
        }
        let same = |(key, pipeline): (&PipelineKey, &Arc<Pipeline>)| {
            other.pipelines.get(key).is_some_and(|o| Arc::ptr_eq(o, pipeline))
        };
        self.pipelines.len() == other.pipelines.len() && self.pipelines.iter().all(same)
    }
}

/// The pipelines of pictures that are drawn. A weak reference, so that none lives longer than its picture.
#[derive(Default)]
pub(super) struct Bound(Vec<(Arc<PipelineRequest>, Weak<BoundPipelines>)>);

impl Bound {
    pub(super) fn of(&self, request: &Arc<PipelineRequest>) -> Option<Arc<BoundPipelines>> {
        let found = self.0.iter().find(|(of, _)| Arc::ptr_eq(of, request));
        found.and_then(|(_, bound)| bound.upgrade())
    }

    pub(super) fn add(&mut self, request: &Arc<PipelineRequest>, bound: &Arc<BoundPipelines>) {
        self.0.retain(|(_, bound)| bound.strong_count() > 0);
        self.0.push((request.clone(), Arc::downgrade(bound)));
    }
}
