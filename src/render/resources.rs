//! Everything on the device that frames are drawn with, found by the keys of a [`FrameState`]. It can be dropped and made
//! again from what the session holds.

use std::sync::Arc;

use crate::gpu::{Buffer, Gpu, GpuError, SetLayouts};
use crate::scene::{Measured, MeasuredError};

use super::brdf::measured::measured_buffer;
use super::environment::bake::{BakeControl, BakeError, GpuEnvironment};
use super::pipeline::{BoundPipelines, PipelineSet};
use super::scene::{GpuModel, GpuScene};
use super::state::{EnvironmentKey, FrameState, MeasuredKey, Scene};

/// A [`FrameState`] with the pipelines and resources that it is drawn with: complete, so that it can be shown. It keeps them
/// alive, whatever replaces them meanwhile.
#[derive(Clone)]
pub struct BoundFrame {
    /// The picture.
    pub state: Arc<FrameState>,
    pub(super) pipelines: BoundPipelines,
    pub(super) scene: Option<Arc<GpuScene>>,
    pub(super) environment: Arc<GpuEnvironment>,
    pub(super) measured: Arc<Buffer>,
}

impl BoundFrame {
    /// The same pipelines and resources under another state that asks for just these: one that differs in camera or time.
    #[must_use]
    pub fn with_state(&self, state: FrameState) -> Self {
        Self { state: Arc::new(state), ..self.clone() }
    }

    /// Whether both give the same picture, bit for bit.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let same_scene = match (&self.scene, &other.scene) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        same_scene
            && self.pipelines.is_same(&other.pipelines)
            && Arc::ptr_eq(&self.environment, &other.environment)
            && Arc::ptr_eq(&self.measured, &other.measured)
            && self.state.is_same(&other.state)
    }
}

/// What a state still needs.
#[derive(Clone, Debug, Default)]
pub struct Missing {
    /// Pipelines of the newest set.
    pub pipelines: bool,
    /// An environment to bake.
    pub environment: Option<EnvironmentKey>,
    /// A measured BRDF to read.
    pub measured: Option<MeasuredKey>,
}

/// A resource, the key that it was made for, and the newest key for which it could not be made.
struct Slot<K, T> {
    made: Option<(K, Arc<T>)>,
    failed: Option<K>,
    /// Stands for no resource.
    none: Arc<T>,
}

impl<K: PartialEq, T> Slot<K, T> {
    fn new(none: Arc<T>) -> Self {
        Self { made: None, failed: None, none }
    }

    /// The resource of `key`. After a failure the last good one stays; `None` while nobody knows yet.
    fn get(&self, key: Option<&K>) -> Option<&Arc<T>> {
        let Some(key) = key else { return Some(&self.none) };
        match &self.made {
            Some((made, resource)) if made == key => Some(resource),
            _ if self.failed.as_ref() == Some(key) => Some(self.last_good()),
            _ => None,
        }
    }

    fn last_good(&self) -> &Arc<T> {
        self.made.as_ref().map_or(&self.none, |(_, resource)| resource)
    }

    fn set(&mut self, key: K, resource: Option<Arc<T>>) {
        match resource {
            Some(resource) => (self.made, self.failed) = (Some((key, resource)), None),
            None => self.failed = Some(key),
        }
    }
}

/// Pipelines, model, environment and measured BRDF: the newest of each.
pub struct Resources {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    pipelines: Option<Arc<PipelineSet>>,
    model: Option<Arc<GpuModel>>,
    scene: Option<(Scene, Arc<GpuScene>)>,
    environment: Slot<EnvironmentKey, GpuEnvironment>,
    measured: Slot<MeasuredKey, Buffer>,
}

impl Resources {
    /// Without any pipeline or model. `ambient` is the radiance from everywhere before the first environment is baked.
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
            environment: Slot::new(GpuEnvironment::uniform(gpu, ambient)?),
            measured: Slot::new(measured_buffer(gpu, None)?),
        })
    }

    /// The pipelines of the newest good shaders.
    pub fn pipelines(&self) -> Option<&Arc<PipelineSet>> {
        self.pipelines.as_ref()
    }

    /// Replaces the pipelines by those of newer shaders.
    pub fn set_pipelines(&mut self, set: &Arc<PipelineSet>) {
        self.pipelines = Some(set.clone());
    }

    /// Replaces the model.
    pub fn set_model(&mut self, model: &Arc<GpuModel>) {
        self.model = Some(model.clone());
        self.scene = None;
    }

    /// Takes the result of a bake; `None` if it failed.
    pub fn set_environment(&mut self, key: EnvironmentKey, environment: Option<Arc<GpuEnvironment>>) {
        self.environment.set(key, environment);
    }

    /// Takes a measured BRDF; `None` if it could not be read.
    pub fn set_measured(&mut self, key: MeasuredKey, buffer: Option<Arc<Buffer>>) {
        self.measured.set(key, buffer);
    }

    /// The environment that was baked last.
    pub fn environment(&self) -> &Arc<GpuEnvironment> {
        self.environment.last_good()
    }

    /// What `state` still needs. A model is not among it: states are made of models that were uploaded.
    pub fn missing(&self, state: &FrameState) -> Missing {
        let has_pipelines = self.pipelines_of(state).is_some_and(|set| set.bind(&state.pipelines).is_some());
        let environment = state.environment.as_ref();
        let measured = state.measured.as_ref();
        Missing {
            pipelines: !has_pipelines,
            environment: environment.filter(|key| self.environment.get(Some(key)).is_none()).cloned(),
            measured: measured.filter(|key| self.measured.get(Some(key)).is_none()).cloned(),
        }
    }

    /// The frame of `state` if it is complete. `is_first` accepts flat ambient light in place of an environment that is still
    /// being baked, so that a picture is there early.
    ///
    /// # Errors
    /// No memory left for the materials.
    pub fn bind(&mut self, state: &Arc<FrameState>, is_first: bool) -> Result<Option<BoundFrame>, GpuError> {
        let Some(pipelines) = self.pipelines_of(state).and_then(|set| set.bind(&state.pipelines)) else {
            return Ok(None);
        };
        let environment = match self.environment.get(state.environment.as_ref()) {
            Some(environment) => environment.clone(),
            // An edit shows at once, in the light of the same environment as the shaders before baked it.
            None if is_first || self.has_baked(state) => self.environment.last_good().clone(),
            None => return Ok(None),
        };
        let Some(measured) = self.measured.get(state.measured.as_ref()).cloned() else { return Ok(None) };
        let scene = match &state.scene {
            Some(scene) => match self.scene_of(scene)? {
                Some(scene) => Some(scene),
                None => return Ok(None),
            },
            None => None,
        };
        Ok(Some(BoundFrame { state: state.clone(), pipelines, scene, environment, measured }))
    }

    /// Makes what `state` needs, on this thread, and binds it.
    ///
    /// # Errors
    /// A file that is bad, or a device that fails.
    pub fn provide(&mut self, state: &Arc<FrameState>) -> Result<BoundFrame, ProvideError> {
        let missing = self.missing(state);
        let set = self.pipelines_of(state).cloned().ok_or(ProvideError::Stale)?;
        if let Some(key) = missing.environment {
            self.bake(key, true)?;
        }
        if let Some(key) = missing.measured {
            let buffer = read_measured(&self.gpu, &key)?;
            self.set_measured(key, Some(buffer));
        }
        if missing.pipelines {
            set.build(&state.pipelines)?;
        }
        self.bind(state, false)?.ok_or(ProvideError::Stale)
    }

    /// Bakes an environment with the newest pipelines, on this thread. `from_disk`: a cached result will do. On failure the
    /// last good environment stays.
    ///
    /// # Errors
    /// As [`GpuEnvironment::bake`].
    pub fn bake(&mut self, key: EnvironmentKey, from_disk: bool) -> Result<(), ProvideError> {
        let set = self.pipelines.clone().ok_or(ProvideError::Stale)?;
        let control = BakeControl { progress: &|_, _| {}, superseded: &|| false, from_disk };
        match GpuEnvironment::bake(&set, &key.name, &control) {
            Ok(environment) => self.set_environment(key, Some(environment)),
            Err(error) => {
                self.set_environment(key, None);
                return Err(error.into());
            }
        }
        Ok(())
    }

    /// Whether the environment of `state` is the one that was baked last, if with other shaders or from an older file.
    fn has_baked(&self, state: &FrameState) -> bool {
        let baked = self.environment.made.as_ref().map(|(key, _)| &key.name);
        baked.is_some() && baked == state.environment.as_ref().map(|key| &key.name)
    }

    /// The newest set, if `state` was made of its shaders.
    fn pipelines_of(&self, state: &FrameState) -> Option<&Arc<PipelineSet>> {
        self.pipelines.as_ref().filter(|set| Arc::ptr_eq(&set.shaders, &state.shaders))
    }

    fn scene_of(&mut self, scene: &Scene) -> Result<Option<Arc<GpuScene>>, GpuError> {
        if let Some((_, drawn)) = self.scene.as_ref().filter(|(of, _)| of == scene) {
            return Ok(Some(drawn.clone()));
        }
        let Some(model) = self.model.as_ref().filter(|model| Arc::ptr_eq(model.model(), scene.model())) else {
            return Ok(None);
        };
        let drawn = model.scene(&self.gpu, &self.layouts, scene)?;
        self.scene = Some((scene.clone(), drawn.clone()));
        Ok(Some(drawn))
    }
}

/// Why a resource could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ProvideError {
    /// The environment.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The measured BRDF.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The state was made of other shaders or of another model than the newest.
    #[error("the frame was prepared for shaders or a model that have been replaced since")]
    Stale,
}

/// Reads a measured BRDF and uploads it. From any thread.
///
/// # Errors
/// A file that is bad, or no memory left.
pub fn read_measured(gpu: &Arc<Gpu>, key: &MeasuredKey) -> Result<Arc<Buffer>, ProvideError> {
    let measured = Measured::open(&key.path)?;
    Ok(measured_buffer(gpu, Some(&measured))?)
}
