//! The pipelines of one shader generation. Each frame uses exactly one set, so no frame mixes two generations.

mod bound;
mod make;
mod report;

use std::collections::{HashMap, HashSet};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use rayon::prelude::*;

use crate::frame::stages::DEFORM;
use crate::frame::{PipelineKey, PipelineRequest};
use crate::gpu::{
    ComputePipeline, Gpu, GpuError, PassBinding, PassBindings, PassLayout, Pipeline, SetLayouts, ShaderModule,
    Specialization,
};
use crate::interface::StageRole;
use crate::pipeline::bounds::shader_module;
use crate::pipeline::textures::PassTextures;
use crate::shader::graph::{Input, Inputs};
use crate::shader::{GraphPass, ShaderSet, Stage};
use bound::Bound;
pub(crate) use bound::BoundPipelines;
pub use report::{InPipeline, StageReport};

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
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

/// Layouts by their bindings, and whether they have a material's set. All generations share them.
type PassLayouts = Arc<Mutex<HashMap<(PassBindings, bool), Weak<PassLayout>>>>;

/// Compiled shaders, and the pipelines of the newest requests.
pub struct PipelineSet {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) layouts: Arc<SetLayouts>,
    /// The shaders of this generation, with their modes and parameters.
    pub shaders: Arc<ShaderSet>,
    textures: Arc<PassTextures>,
    /// The layouts of the pipelines, shared by all that have the same bindings.
    pass_layouts: PassLayouts,
    graphics: Mutex<Recent<PipelineKey, Pipeline>>,
    computes: Mutex<Recent<(String, Specialization), ComputePipeline>>,
    /// The worker does not wait for it, nor holds it.
    bound: Mutex<Bound>,
    requests: AtomicU64,
}

impl PipelineSet {
    /// A set keeps the pipelines of this many newest requests, so recent modes return at once and memory stays bounded.
    pub const REQUESTS_KEPT: u64 = 64;

    /// Creates a set with the pipelines of `request`, all or nothing. `textures`: those of the shaders' graph. Pipelines of
    /// `before` whose stages did not change are inherited.
    ///
    /// # Errors
    /// The driver rejects a stage or a pipeline.
    pub fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        shaders: Arc<ShaderSet>,
        textures: Arc<PassTextures>,
        request: &PipelineRequest,
        before: Option<&Self>,
    ) -> Result<(Arc<Self>, usize), GpuError> {
        let set = Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            shaders,
            textures,
            pass_layouts: before.map(|set| set.pass_layouts.clone()).unwrap_or_default(),
            graphics: Mutex::default(),
            computes: Mutex::default(),
            bound: Mutex::default(),
            requests: AtomicU64::default(),
        };
        if let Some(before) = before {
            set.inherit(before);
            set.inherit_equivalent(before, request);
        }
        let built = set.build(request)?;
        Ok((Arc::new(set), built))
    }

    /// A set of the same generation with another module for a stage, and with the pipelines of `request`. Also how many of them are new.
    ///
    /// # Errors
    /// As [`PipelineSet::new`].
    pub fn variant(&self, shaders: Arc<ShaderSet>, request: &PipelineRequest) -> Result<(Arc<Self>, usize), GpuError> {
        Self::new(&self.gpu, &self.layouts, shaders, self.textures.clone(), request, Some(self))
    }

    /// The textures of this generation.
    pub(super) fn textures(&self) -> &Arc<PassTextures> {
        &self.textures
    }

    /// Inherits the pipelines of unchanged stages. Frames may use `before` at the same time, so its locks are held briefly.
    fn inherit(&self, before: &Self) {
        let is_same = |path: &str| match (before.shaders.stages.get(path), self.shaders.stages.get(path)) {
            (Some(before), Some(now)) => Arc::ptr_eq(before, now),
            _ => false,
        };
        self.requests.store(before.requests.load(Ordering::SeqCst), Ordering::SeqCst);
        for (key, entry) in &lock(&before.graphics).entries {
            if key.stages().all(is_same) {
                lock(&self.graphics).entries.insert(key.clone(), entry.clone());
            }
        }
        for (key, entry) in &lock(&before.computes).entries {
            if is_same(&key.0) {
                lock(&self.computes).entries.insert(key.clone(), entry.clone());
            }
        }
    }

    /// Inherits the pipelines of `request` whose stages are new but behave the same with the constants of the pipeline: an edit
    /// of the clear coat changes only materials that have one, and an edit of a model that is not selected changes none.
    fn inherit_equivalent(&self, before: &Self, request: &PipelineRequest) {
        let is_same = |path: &str, constants: &[(u32, u32)]| {
            let stages = (before.shaders.stages.get(path), self.shaders.stages.get(path));
            let (Some(old), Some(new)) = stages else { return false };
            Arc::ptr_eq(old, new) || old.specialized_hash(constants) == new.specialized_hash(constants)
        };
        let keys: HashSet<PipelineKey> =
            request.keys().filter(|key| key.modes.is_empty() && !self.is_pending(key)).collect();
        keys.into_par_iter().for_each(|key| {
            let old = lock(&before.graphics).entries.get(&key).cloned();
            let Some(old) = old.filter(|_| !lock(&self.graphics).entries.contains_key(&key)) else { return };
            // Its stages name loops by the module from which they were compiled.
            if old.0.names_loops() {
                return;
            }
            if key.stages().all(|path| is_same(path, &key.specialization)) {
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
        self.build_as(number, request)
    }

    /// [`PipelineSet::build`] for thumbnails, which does not count as a request: it evicts no pipeline of a frame.
    ///
    /// # Errors
    /// As [`PipelineSet::build`].
    pub(crate) fn build_aside(&self, request: &PipelineRequest) -> Result<usize, GpuError> {
        self.build_as(self.requests.load(Ordering::SeqCst), request)
    }

    /// Whether all pipelines of `request` that draw are built.
    pub(crate) fn has(&self, request: &PipelineRequest) -> bool {
        request.keys().all(|key| lock(&self.graphics).entries.contains_key(&key))
    }

    fn build_as(&self, number: u64, request: &PipelineRequest) -> Result<usize, GpuError> {
        let keys: HashSet<PipelineKey> = request.keys().filter(|key| !self.is_pending(key)).collect();
        let missing: Vec<PipelineKey> =
            keys.into_iter().filter(|key| !lock(&self.graphics).touch(key, number)).collect();
        missing.par_iter().try_for_each(|key| {
            let pipeline = self.make(key, |desc| Pipeline::new(&self.gpu, &self.layouts, desc))?;
            lock(&self.graphics).insert(key.clone(), pipeline, number);
            Ok::<_, GpuError>(())
        })?;
        for pass in request.passes.iter().filter(|pass| pass.is_compute && !self.is_pending_stage(&pass.desc.stage)) {
            self.compute_pass(pass, &request.pass_constants())?;
        }
        if request.deforms && !self.is_pending_stage(DEFORM) {
            self.compute(DEFORM, &request.pass_constants())?;
        }
        lock(&self.graphics).trim(number);
        lock(&self.computes).trim(number);
        Ok(missing.len())
    }

    /// Drops all pipelines but those of `request`, for a set that a newer one has replaced: a software device takes megabytes for each. What is
    /// needed again is built again.
    pub(crate) fn keep(&self, request: &PipelineRequest) {
        let keys: HashSet<PipelineKey> = request.keys().collect();
        let constants = request.pass_constants();
        lock(&self.graphics).entries.retain(|key, _| keys.contains(key));
        lock(&self.computes)
            .entries
            .retain(|(stage, of), _| *of == constants && request.compute_stages().any(|own| own == stage));
    }

    /// Whether a stage of the pipeline is not compiled yet.
    fn is_pending(&self, key: &PipelineKey) -> bool {
        key.stages().any(|path| self.is_pending_stage(path))
    }

    fn is_pending_stage(&self, path: &str) -> bool {
        self.shaders.pending.contains(path)
    }

    /// The pipelines of `request`, or `None` if one is missing. They are collected once, as long as a frame uses them.
    pub(crate) fn bind(&self, request: &Arc<PipelineRequest>) -> Option<Arc<BoundPipelines>> {
        let known = lock(&self.bound).of(request);
        known.or_else(|| {
            let bound = Arc::new(self.collect(request)?);
            lock(&self.bound).add(request, &bound);
            Some(bound)
        })
    }

    fn collect(&self, request: &PipelineRequest) -> Option<BoundPipelines> {
        if request.needs_pending(&self.shaders) {
            return None;
        }
        let keys: Vec<PipelineKey> = request.keys().collect();
        let graphics = lock(&self.graphics);
        let pipelines = keys.into_iter().map(|key| graphics.get(&key).cloned().map(|pipeline| (key, pipeline)));
        let pipelines = pipelines.collect::<Option<_>>()?;
        drop(graphics);
        let constants = request.pass_constants();
        let known = lock(&self.computes);
        let compute = |stage: &str| {
            let pipeline = known.get(&(stage.to_owned(), constants.clone()))?;
            Some((stage.to_owned(), pipeline.clone()))
        };
        let computes = request.compute_stages().map(compute).collect::<Option<_>>()?;
        Some(BoundPipelines::new(pipelines, computes, self.textures.clone()))
    }

    /// A stage of this generation.
    fn stage(&self, path: &str) -> Result<&Arc<Stage>, GpuError> {
        self.shaders.stages.get(path).ok_or_else(|| GpuError::NoStage(path.to_owned()))
    }

    /// A compute pipeline, created at its first use.
    pub(crate) fn compute(&self, path: &str, constants: &Specialization) -> Result<Arc<ComputePipeline>, GpuError> {
        self.compute_with(path, constants, StageRole::of_compute(path), |_| Ok(None))
    }

    /// The pipeline of a compute pass, created at its first use.
    fn compute_pass(&self, pass: &GraphPass, constants: &Specialization) -> Result<Arc<ComputePipeline>, GpuError> {
        let layout = |module: &ShaderModule| self.layout(&pass.inputs, &[module], false).map(Some);
        self.compute_with(&pass.desc.stage, constants, pass.role(), layout).map_err(|error| of_pass(pass, error))
    }

    /// The layout for these inputs, as far as the modules read them.
    fn layout(
        &self,
        inputs: &Inputs,
        modules: &[&ShaderModule],
        draws_model: bool,
    ) -> Result<Arc<PassLayout>, GpuError> {
        let used = inputs
            .iter()
            .filter(|(binding, _)| modules.iter().any(|module| module.usage.pass_bindings.contains(*binding)));
        let bindings: PassBindings = used.map(|(binding, input)| (*binding, kind_of(input))).collect();
        let mut known = lock(&self.pass_layouts);
        let key = (bindings, draws_model);
        if let Some(layout) = known.get(&key).and_then(Weak::upgrade) {
            return Ok(layout);
        }
        known.retain(|_, layout| layout.strong_count() > 0);
        let layout = PassLayout::new(&self.gpu, &self.layouts, key.0.clone(), draws_model)?;
        known.insert(key, Arc::downgrade(&layout));
        Ok(layout)
    }

    fn compute_with(
        &self,
        path: &str,
        constants: &Specialization,
        role: StageRole,
        layout: impl FnOnce(&ShaderModule) -> Result<Option<Arc<PassLayout>>, GpuError>,
    ) -> Result<Arc<ComputePipeline>, GpuError> {
        let key = (path.to_owned(), constants.clone());
        let number = self.requests.load(Ordering::SeqCst);
        lock(&self.computes).touch(&key, number);
        if let Some(pipeline) = lock(&self.computes).get(&key) {
            return Ok(pipeline.clone());
        }
        let module = shader_module(&self.gpu, self.stage(path)?, constants, false, false)?;
        check_bound(&module, role)?;
        let pipeline = ComputePipeline::new(&self.gpu, &self.layouts, &module, layout(&module)?)?;
        lock(&self.computes).insert(key, pipeline.clone(), number);
        Ok(pipeline)
    }
}

/// Refuses a module that reads an unbound resource: the driver would crash, or read 0.
fn check_bound(module: &ShaderModule, role: StageRole) -> Result<(), GpuError> {
    match module.usage.resources.iter().find(|resource| !role.binds(**resource)) {
        None => Ok(()),
        Some(resource) => {
            Err(GpuError::Unbound { stage: module.name.clone(), role: role.name(), resource: resource.name() })
        }
    }
}

/// Names the pass in an error about its inputs.
fn of_pass(pass: &GraphPass, error: GpuError) -> GpuError {
    match error {
        GpuError::Texture(message) => GpuError::Texture(format!("the pass {} is too large: {message}", pass.name())),
        other => other,
    }
}

fn kind_of(input: &Input) -> PassBinding {
    match input {
        Input::Picture
        | Input::Samples
        | Input::Peeled
        | Input::OpaqueScene
        | Input::Depth
        | Input::Image(_)
        | Input::Before(_)
        | Input::Texture(..) => PassBinding::Texture,
        Input::Output => PassBinding::Storage,
        Input::Buffer(..) => PassBinding::Buffer,
        Input::Parameters(..) | Input::Pass(..) => PassBinding::Uniform,
    }
}
