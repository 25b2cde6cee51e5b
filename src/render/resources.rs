//! All device objects that frames are drawn with, found by the keys of a [`FrameState`]. They can be dropped and created
//! again from the session.

mod last_good;

use std::sync::Arc;

use crate::gpu::{Buffer, Gpu, GpuError, Image, SetLayouts};
use crate::message;
use crate::scene::{MeasuredBrdf, MeasuredError, TextureSource};

use super::bound_frame::BoundFrame;
use super::brdf::measured::measured_buffer;
use super::brdf::tables::Tables;
use super::environment::bake::{BakeControl, BakeError};
use super::environment::maps::GpuEnvironment;
use super::paths::{PathTracing, PathTracingError, PathTracingKey, PathTracingRequest};
use super::scene::{GpuModel, GpuScene};
use crate::frame::{EnvironmentKey, FrameState, MeasuredKey, Scene, TablesKey};
use crate::pipeline::{BoundPipelines, PipelineSet};
use last_good::LastGood;

/// The resources that a state needs and that [`Resources`] does not have yet.
#[derive(Clone, Debug, Default)]
pub struct Missing {
    /// Whether the newest set lacks pipelines.
    pub pipelines: bool,
    /// BRDF lookup tables to bake.
    pub tables: Option<Arc<TablesKey>>,
    /// An environment to bake.
    pub environment: Option<Arc<EnvironmentKey>>,
    /// A measured BRDF to read.
    pub measured: Option<MeasuredKey>,
    /// The request for path-tracing resources. They depend on the environment, so this is set only once the environment is there.
    pub path_tracing: Option<PathTracingRequest>,
}

impl Missing {
    /// Whether nothing is missing.
    pub fn is_empty(&self) -> bool {
        let Self { pipelines, tables, environment, measured, path_tracing } = self;
        !pipelines && tables.is_none() && environment.is_none() && measured.is_none() && path_tracing.is_none()
    }
}

/// Pipelines, model, environment, measured BRDF and path-tracing resources: the newest of each. A clone shares all of them, and
/// then changes independently.
#[derive(Clone)]
pub struct Resources {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    pipelines: Option<Arc<PipelineSet>>,
    model: Option<Arc<GpuModel>>,
    /// The draws of the last scene, in any pose.
    scene: Option<(Scene, Arc<GpuScene>)>,
    tables: LastGood<Arc<TablesKey>, Tables>,
    environment: LastGood<Arc<EnvironmentKey>, GpuEnvironment>,
    measured: LastGood<MeasuredKey, Buffer>,
    path_tracing: LastGood<PathTracingKey, PathTracing>,
}

impl Resources {
    /// Resources without pipelines or model. `ambient` is the uniform radiance that replaces a missing environment.
    ///
    /// # Errors
    /// No memory left.
    pub fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, ambient: [f32; 3]) -> Result<Self, GpuError> {
        Ok(Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            pipelines: None,
            model: None,
            scene: None,
            tables: LastGood::new(Tables::of_mirror(gpu)?),
            environment: LastGood::new(GpuEnvironment::uniform(gpu, ambient)?),
            measured: LastGood::new(measured_buffer(gpu, None)?),
            path_tracing: LastGood::new(PathTracing::empty(gpu)?),
        })
    }

    /// The layouts that all pipelines share.
    pub fn layouts(&self) -> &Arc<SetLayouts> {
        &self.layouts
    }

    /// The pipelines of the last good shaders.
    pub fn pipelines(&self) -> Option<&Arc<PipelineSet>> {
        self.pipelines.as_ref()
    }

    /// Replaces the pipelines with those of newer shaders.
    pub fn set_pipelines(&mut self, set: &Arc<PipelineSet>) {
        self.pipelines = Some(set.clone());
    }

    /// Replaces the model.
    pub fn set_model(&mut self, model: &Arc<GpuModel>) {
        self.model = Some(model.clone());
        self.scene = None;
    }

    /// A texture of the model, as its materials read it.
    pub fn texture(&self, source: &TextureSource) -> Option<&Arc<Image>> {
        self.model.as_ref()?.texture(source)
    }

    /// Stores baked BRDF tables; `None` if the bake failed.
    pub fn set_tables(&mut self, key: Arc<TablesKey>, tables: Option<Arc<Tables>>) {
        self.tables.set(key, tables);
    }

    /// The tables that were baked last.
    pub fn tables(&self) -> Option<&Arc<Tables>> {
        self.tables.made.as_ref().map(|(_, tables)| tables)
    }

    /// Stores a baked environment; `None` if the bake failed.
    pub fn set_environment(&mut self, key: Arc<EnvironmentKey>, environment: Option<Arc<GpuEnvironment>>) {
        self.environment.set(key, environment);
    }

    /// Stores a measured BRDF; `None` if it could not be read.
    pub fn set_measured(&mut self, key: MeasuredKey, buffer: Option<Arc<Buffer>>) {
        self.measured.set(key, buffer);
    }

    /// Stores path-tracing resources; `None` if they could not be built.
    pub fn set_path_tracing(&mut self, key: PathTracingKey, path_tracing: Option<Arc<PathTracing>>) {
        self.path_tracing.set(key, path_tracing);
    }

    /// The environment that was baked last.
    pub fn environment(&self) -> &Arc<GpuEnvironment> {
        self.environment.last_good()
    }

    /// The environment that was baked last, with its key: the next bake reuses the parts that are unchanged.
    pub fn baked_environment(&self) -> Option<&(Arc<EnvironmentKey>, Arc<GpuEnvironment>)> {
        self.environment.made.as_ref()
    }

    /// The environment of `state`, or a fallback while it is being baked. `None` while there is neither.
    fn environment_of(&self, state: &FrameState, is_first: bool) -> Option<&Arc<GpuEnvironment>> {
        // An edit of the bake stages appears at once, in the light that the previous shaders baked.
        let is_edit =
            |key: &Arc<EnvironmentKey>| state.environment.as_ref().is_some_and(|wanted| key.is_edit_of(wanted));
        let made = self.whole_environment(state.environment.as_ref());
        let made = made.or_else(|| self.environment.before_edit(is_edit));
        made.or_else(|| is_first.then(|| self.environment.last_good()))
    }

    /// The environment of `key`, unless [`Resources::free_unread`] has freed a part of it.
    fn whole_environment(&self, key: Option<&Arc<EnvironmentKey>>) -> Option<&Arc<GpuEnvironment>> {
        self.environment.get(key).filter(|environment| environment.radiance.has_cube)
    }

    /// Frees what the pipelines of a frame do not read. No other frame can be bound before this light is provided again.
    pub fn free_unread(&mut self, frame: &mut BoundFrame) {
        let Some((_, made)) = &mut self.environment.made else { return };
        let reads_cube = frame.pipelines.read_cube || frame.state.pipelines.follows_paths();
        if !reads_cube && Arc::ptr_eq(made, &frame.environment) {
            *made = Arc::new(made.without_cube(&self.environment.none));
            frame.environment = made.clone();
        }
    }

    /// Identifies the path-tracing resources of `state`; `None` for a mode without path tracing.
    fn path_tracing_key(state: &FrameState, environment: &Arc<GpuEnvironment>) -> Option<PathTracingKey> {
        let scene = state.scene.clone().filter(|_| state.pipelines.traces);
        state.pipelines.follows_paths().then(|| PathTracingKey { scene, environment: environment.clone() })
    }

    /// The resources that `state` still lacks. The model is never missing, because states refer only to uploaded models.
    fn missing(&self, state: &FrameState, pipelines: Option<&Arc<BoundPipelines>>) -> Missing {
        let environment = state.environment.as_ref();
        let measured = state.measured.as_ref();
        let path_tracing =
            self.environment_of(state, false).and_then(|environment| Self::path_tracing_key(state, environment));
        let path_tracing = path_tracing.filter(|key| self.path_tracing.get(Some(key)).is_none());
        Missing {
            path_tracing: path_tracing.map(|key| PathTracingRequest {
                key,
                model: self.model.clone(),
                before: self.path_tracing.made.clone(),
            }),
            pipelines: pipelines.is_none(),
            tables: self.tables.get(Some(&state.tables)).is_none().then(|| state.tables.clone()),
            environment: environment.filter(|key| self.whole_environment(Some(key)).is_none()).cloned(),
            measured: measured.filter(|key| self.measured.get(Some(key)).is_none()).cloned(),
        }
    }

    /// Binds `state` if nothing is missing, and returns what is. An edit of the shaders appears at once, in the light that the
    /// previous shaders baked. With `is_first`, the last environment (initially the ambient light) may replace one that is still
    /// being baked, so that the first frame appears early.
    ///
    /// # Errors
    /// No memory left for the materials.
    pub fn bind(&mut self, state: &Arc<FrameState>, is_first: bool) -> Result<(Option<BoundFrame>, Missing), GpuError> {
        let pipelines = self.pipelines_of(state).and_then(|set| set.bind(&state.pipelines));
        let missing = self.missing(state, pipelines.as_ref());
        let frame = pipelines.map_or(Ok(None), |pipelines| self.bind_with(pipelines, state, is_first))?;
        Ok((frame, missing))
    }

    /// Binds `state` to the pipelines of `set`, a variant of the newest set, as [`Resources::bind`] does to those of the newest.
    ///
    /// # Errors
    /// No memory left for the materials.
    pub fn bind_variant(&mut self, set: &PipelineSet, state: &Arc<FrameState>) -> Result<Option<BoundFrame>, GpuError> {
        set.bind(&state.pipelines).map_or(Ok(None), |pipelines| self.bind_with(pipelines, state, false))
    }

    fn bind_with(
        &mut self,
        pipelines: Arc<BoundPipelines>,
        state: &Arc<FrameState>,
        is_first: bool,
    ) -> Result<Option<BoundFrame>, GpuError> {
        let tables = self.tables.get(Some(&state.tables));
        let tables = tables.or_else(|| self.tables.before_edit(|key| key.is_edit_of(&state.tables))).cloned();
        let environment = self.environment_of(state, is_first).cloned();
        self.bind_in(pipelines, state, tables.zip(environment))
    }

    /// Binds `state`, whose shaders are older than the newest, to the pipelines of their own `set`. Light and tables are those of
    /// `like`, a frame with the same shaders, or the newest ones if their bake stages are unchanged. Returns `None` if a resource
    /// is missing.
    ///
    /// # Errors
    /// No memory left for the materials.
    pub fn bind_older(
        &mut self,
        set: &PipelineSet,
        state: &Arc<FrameState>,
        like: Option<&BoundFrame>,
    ) -> Result<Option<BoundFrame>, GpuError> {
        let Some(pipelines) = set.bind(&state.pipelines) else { return Ok(None) };
        let of_like = like.filter(|like| like.state.environment == state.environment).map(|like| &like.environment);
        let environment = of_like.or_else(|| self.whole_environment(state.environment.as_ref())).cloned();
        let of_like = like.filter(|like| like.state.tables == state.tables).map(|like| &like.tables);
        let tables = of_like.or_else(|| self.tables.get(Some(&state.tables))).cloned();
        self.bind_in(pipelines, state, tables.zip(environment))
    }

    /// Binds `state` in this light. `None` if a resource is missing.
    fn bind_in(
        &mut self,
        pipelines: Arc<BoundPipelines>,
        state: &Arc<FrameState>,
        light: Option<(Arc<Tables>, Arc<GpuEnvironment>)>,
    ) -> Result<Option<BoundFrame>, GpuError> {
        let Some((tables, environment)) = light.filter(|(_, environment)| adds_suns_of(state, environment)) else {
            return Ok(None);
        };
        let key = Self::path_tracing_key(state, &environment);
        let Some(path_tracing) = self.path_tracing.get(key.as_ref()).cloned() else { return Ok(None) };
        let Some(measured) = self.measured.get(state.measured.as_ref()).cloned() else { return Ok(None) };
        let scene = state.scene.as_ref().map(|scene| self.scene_of(scene)).transpose()?;
        // A scene whose model is not uploaded is missing.
        if matches!(scene, Some(None)) {
            return Ok(None);
        }
        let (state, scene) = (state.clone(), scene.flatten());
        Ok(Some(BoundFrame { state, pipelines, scene, tables, environment, measured, path_tracing }))
    }

    /// Creates everything that `state` lacks on this thread, and binds it.
    ///
    /// # Errors
    /// A bad file, or a device error.
    pub fn provide(&mut self, state: &Arc<FrameState>) -> Result<BoundFrame, ProvideError> {
        let set = self.pipelines_of(state).cloned().ok_or(ProvideError::Stale)?;
        let pipelines = set.bind(&state.pipelines);
        let missing = self.missing(state, pipelines.as_ref());
        if let Some(key) = missing.tables {
            let tables = Tables::bake(&set, &key, self.tables());
            self.set_tables(key, tables.as_ref().ok().cloned());
            tables?;
        }
        if let Some(key) = missing.environment {
            let before = self.baked_environment().cloned();
            self.bake_after(key, before.as_ref(), true)?;
        }
        if let Some(key) = missing.measured {
            let read = MeasuredBrdf::open(&key.path).map_err(ProvideError::from);
            read.iter().flat_map(|measured| &measured.warnings).for_each(message::warn);
            let uploaded = read.and_then(|measured| Ok(measured_buffer(&self.gpu, Some(&measured))?));
            self.set_measured(key, uploaded.as_ref().ok().cloned());
            uploaded?;
        }
        if missing.pipelines {
            set.build(&state.pipelines)?;
        }
        // Only now is the environment known.
        let (frame, missing) = self.bind(state, false)?;
        let Some(request) = missing.path_tracing else { return frame.ok_or(ProvideError::Stale) };
        let built = PathTracing::new(&self.gpu, &request);
        self.set_path_tracing(request.key, built.as_ref().ok().cloned());
        built?;
        let (frame, _) = self.bind(state, false)?;
        frame.ok_or(ProvideError::Stale)
    }

    /// Bakes all parts of an environment with the newest pipelines on this thread. `from_disk` allows a cached result. On failure
    /// the last good environment stays in use.
    ///
    /// # Errors
    /// As [`GpuEnvironment::bake`].
    pub fn bake(&mut self, key: Arc<EnvironmentKey>, from_disk: bool) -> Result<(), ProvideError> {
        self.bake_after(key, None, from_disk)
    }

    fn bake_after(
        &mut self,
        key: Arc<EnvironmentKey>,
        before: Option<&(Arc<EnvironmentKey>, Arc<GpuEnvironment>)>,
        from_disk: bool,
    ) -> Result<(), ProvideError> {
        let set = self.pipelines.clone().ok_or(ProvideError::Stale)?;
        let control = BakeControl { progress: &|_, _| {}, superseded: &|| false, from_disk };
        let baked = GpuEnvironment::bake(&set, &key, before, &control);
        self.set_environment(key, baked.as_ref().ok().cloned());
        Ok(baked.map(drop)?)
    }

    /// The newest set, if it has the shaders of `state`.
    fn pipelines_of(&self, state: &FrameState) -> Option<&Arc<PipelineSet>> {
        self.pipelines.as_ref().filter(|set| Arc::ptr_eq(&set.shaders, &state.shaders))
    }

    fn scene_of(&mut self, scene: &Scene) -> Result<Option<Arc<GpuScene>>, GpuError> {
        if let Some((_, drawn)) = self.scene.as_ref().filter(|(of, _)| of.has_same_draws(scene)) {
            return Ok(Some(drawn.clone()));
        }
        let Some(model) = self.model.as_ref().filter(|model| Arc::ptr_eq(model.model(), scene.loaded())) else {
            return Ok(None);
        };
        let drawn = model.scene(&self.gpu, &self.layouts, scene)?;
        self.scene = Some((scene.clone(), drawn.clone()));
        Ok(Some(drawn))
    }
}

/// Why a resource could not be created.
#[derive(Debug, thiserror::Error)]
pub enum ProvideError {
    /// The environment could not be baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The measured BRDF could not be read.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The path-tracing resources could not be built.
    #[error(transparent)]
    Trace(#[from] PathTracingError),
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The state refers to shaders or a model that are no longer the newest.
    #[error("the frame was prepared for shaders or a model that have been replaced since")]
    Stale,
}

/// Whether the pipelines of `state` light the model with every sun that the images of the environment leave out.
fn adds_suns_of(state: &FrameState, environment: &GpuEnvironment) -> bool {
    state.environment.is_none() || state.pipelines.sun_count >= environment.sun_count()
}
