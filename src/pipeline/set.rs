//! The pipelines of one shader generation. Each frame uses exactly one set, so no frame mixes two generations.

use std::collections::{HashMap, HashSet};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use crate::frame::{Pass, PipelineKey, PipelineRequest};
use crate::gpu::{
    ComputePipeline, Gpu, GpuError, Pipeline, PipelineDesc, PrimitiveClass, Raster, SetLayouts, ShaderModule,
    Specialization,
};
use crate::pipeline::bounds::shader_module;
use crate::shader::{ShaderSet, Stage};

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The pipelines of one [`PipelineRequest`].
#[derive(Clone)]
pub(crate) struct BoundPipelines {
    pipelines: HashMap<PipelineKey, Arc<Pipeline>>,
}

impl BoundPipelines {
    pub(crate) fn get(&self, key: &PipelineKey) -> Option<&Arc<Pipeline>> {
        self.pipelines.get(key)
    }

    /// Whether both hold the same objects.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let same = |(key, pipeline): (&PipelineKey, &Arc<Pipeline>)| {
            other.pipelines.get(key).is_some_and(|o| Arc::ptr_eq(o, pipeline))
        };
        self.pipelines.len() == other.pipelines.len() && self.pipelines.iter().all(same)
    }
}

/// Objects by key, each with the number of the last request that used it.
struct Recent<K, T> {
    entries: HashMap<K, (Arc<T>, u64)>,
}

impl<K: std::hash::Hash + Eq, T> Recent<K, T> {
    fn get(&self, key: &K) -> Option<&Arc<T>> {
        self.entries.get(key).map(|(object, _)| object)
    }

    /// Marks an entry as used by a request. Returns whether the entry exists.
    fn touch(&mut self, key: &K, request: u64) -> bool {
        self.entries.get_mut(key).map(|entry| entry.1 = request).is_some()
    }

    fn insert(&mut self, key: K, object: Arc<T>, request: u64) {
        self.entries.insert(key, (object, request));
    }

    /// Drops the objects that none of the newest requests used.
    fn trim(&mut self, request: u64) {
        self.entries.retain(|_, (_, used)| *used + PipelineSet::REQUESTS_KEPT > request);
    }
}

impl<K, T> Default for Recent<K, T> {
    fn default() -> Self {
        Self { entries: HashMap::new() }
    }
}

/// Compiled shaders, and the pipelines of the newest requests.
pub struct PipelineSet {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) layouts: Arc<SetLayouts>,
    /// The shaders of this generation, with their modes and parameters.
    pub shaders: Arc<ShaderSet>,
    graphics: Mutex<Recent<PipelineKey, Pipeline>>,
    computes: Mutex<Recent<(String, Specialization), ComputePipeline>>,
    requests: AtomicU64,
}

impl PipelineSet {
    /// A set keeps the pipelines of this many newest requests, so recent modes return at once and memory stays bounded.
    pub const REQUESTS_KEPT: u64 = 64;

    /// Creates a set with the pipelines of `request`, all or nothing. Pipelines of `before` whose stages did not change are
    /// taken over.
    ///
    /// # Errors
    /// The driver rejects a stage or a pipeline.
    pub fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        shaders: Arc<ShaderSet>,
        request: &PipelineRequest,
        before: Option<&Self>,
    ) -> Result<(Arc<Self>, usize), GpuError> {
        let set = Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            shaders,
            graphics: Mutex::default(),
            computes: Mutex::default(),
            requests: AtomicU64::default(),
        };
        if let Some(before) = before {
            set.take_over(before);
            set.take_over_same(before, request);
        }
        let built = set.build(request)?;
        Ok((Arc::new(set), built))
    }

    /// Takes over the pipelines of unchanged stages. Frames may use `before` at the same time, so its locks are held briefly.
    fn take_over(&self, before: &Self) {
        let is_same = |path: &str| match (before.shaders.stages.get(path), self.shaders.stages.get(path)) {
            (Some(before), Some(now)) => Arc::ptr_eq(before, now),
            _ => false,
        };
        self.requests.store(before.requests.load(Ordering::SeqCst), Ordering::SeqCst);
        for (key, entry) in &lock(&before.graphics).entries {
            if key.pass.stages().iter().all(|path| is_same(path)) {
                lock(&self.graphics).entries.insert(key.clone(), entry.clone());
            }
        }
        for (key, entry) in &lock(&before.computes).entries {
            if is_same(&key.0) {
                lock(&self.computes).entries.insert(key.clone(), entry.clone());
            }
        }
    }

    /// Takes over the pipelines of `request` whose stages are new, but do the same with the constants of the pipeline: an edit
    /// of a clear coat changes only materials that have one, and an edit of a model that is not selected changes none.
    fn take_over_same(&self, before: &Self, request: &PipelineRequest) {
        let is_same = |path: &str, constants: &[(u32, u32)]| {
            let stages = (before.shaders.stages.get(path), self.shaders.stages.get(path));
            let (Some(old), Some(new)) = stages else { return false };
            Arc::ptr_eq(old, new) || old.specialized_hash(constants) == new.specialized_hash(constants)
        };
        let keys: HashSet<PipelineKey> = request.keys().filter(|key| !self.is_pending(key)).collect();
        keys.into_par_iter().for_each(|key| {
            let old = lock(&before.graphics).entries.get(&key).cloned();
            let Some(old) = old.filter(|_| !lock(&self.graphics).entries.contains_key(&key)) else { return };
            // Its stages name loops by the module that they were compiled as.
            if old.0.names_loops() {
                return;
            }
            if key.pass.stages().iter().all(|path| is_same(path, &key.specialization)) {
                lock(&self.graphics).entries.insert(key, old);
            }
        });
    }

    /// Creates the missing pipelines of `request` in parallel, except those of pending stages, and returns their number. Any
    /// thread may call this while frames use the set.
    ///
    /// # Errors
    /// The driver rejects a pipeline. The others stay.
    pub fn build(&self, request: &PipelineRequest) -> Result<usize, GpuError> {
        let number = self.requests.fetch_add(1, Ordering::SeqCst) + 1;
        let keys: HashSet<PipelineKey> = request.keys().filter(|key| !self.is_pending(key)).collect();
        let missing: Vec<PipelineKey> =
            keys.into_iter().filter(|key| !lock(&self.graphics).touch(key, number)).collect();
        missing.par_iter().try_for_each(|key| {
            let pipeline = self.make(key)?;
            lock(&self.graphics).insert(key.clone(), pipeline, number);
            Ok::<_, GpuError>(())
        })?;
        lock(&self.graphics).trim(number);
        lock(&self.computes).trim(number);
        Ok(missing.len())
    }

    /// Whether a stage of the pipeline is still to be compiled.
    fn is_pending(&self, key: &PipelineKey) -> bool {
        key.pass.stages().iter().any(|path| self.shaders.pending.contains(*path))
    }

    /// The pipelines of `request`, or `None` if one is missing.
    pub(crate) fn bind(&self, request: &PipelineRequest) -> Option<BoundPipelines> {
        if request.needs_pending(&self.shaders) {
            return None;
        }
        let graphics = lock(&self.graphics);
        let pipelines = request.keys().map(|key| graphics.get(&key).cloned().map(|pipeline| (key, pipeline)));
        let pipelines = pipelines.collect::<Option<_>>()?;
        Some(BoundPipelines { pipelines })
    }

    /// A stage of this generation.
    fn stage(&self, path: &str) -> Result<&Arc<Stage>, GpuError> {
        self.shaders.stages.get(path).ok_or_else(|| GpuError::NoStage(path.to_owned()))
    }

    /// The module of a stage, specialized with these constants.
    fn module(&self, path: &str, constants: &[(u32, u32)]) -> Result<Arc<ShaderModule>, GpuError> {
        shader_module(&self.gpu, self.stage(path)?, constants)
    }

    /// A compute pipeline, created at its first use.
    pub(crate) fn compute(&self, path: &str, constants: &Specialization) -> Result<Arc<ComputePipeline>, GpuError> {
        let key = (path.to_owned(), constants.clone());
        let number = self.requests.load(Ordering::SeqCst);
        lock(&self.computes).touch(&key, number);
        if let Some(pipeline) = lock(&self.computes).get(&key) {
            return Ok(pipeline.clone());
        }
        let module = self.module(path, constants)?;
        let pipeline = ComputePipeline::new(&self.gpu, &self.layouts, &module)?;
        lock(&self.computes).insert(key, pipeline.clone(), number);
        Ok(pipeline)
    }

    fn make(&self, key: &PipelineKey) -> Result<Arc<Pipeline>, GpuError> {
        let module = |path: &str| self.module(path, &key.specialization);
        let [vertex, fragment] = key.pass.stages();
        let (depth, raster, class) = match key.pass {
            Pass::Model { raster, class, .. } => (true, raster, class),
            Pass::Sky => (true, Raster::Solid, PrimitiveClass::Triangles),
            Pass::Average => (false, Raster::Averaged, PrimitiveClass::Triangles),
            Pass::Tonemap => (false, Raster::Solid, PrimitiveClass::Triangles),
        };
        let desc = PipelineDesc {
            vertex: &*module(vertex)?,
            fragment: &*module(fragment)?,
            color: key.format,
            depth,
            raster,
            samples: key.samples,
            class,
        };
        Pipeline::new(&self.gpu, &self.layouts, &desc)
    }
}
