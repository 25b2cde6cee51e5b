//! The pipelines of one shader generation. A frame draws with exactly one set, so it never mixes two generations.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

use crate::gpu::{Gpu, GpuError, Pipeline, PipelineDesc, PrimitiveClass, Raster, SetLayouts, ShaderModule};
use crate::shader::{ShaderSet, Stage};

use super::wanted::{Pass, PipelineKey, Wanted};

/// The stages that a shader tree must have, as paths from its root.
pub const STAGES: [&str; 4] = ["pbr.vert", "pbr.frag", "tonemap.vert", "tonemap.frag"];

impl Pass {
    /// Vertex and fragment stage.
    fn stages(self) -> [&'static str; 2] {
        match self {
            Self::Model { .. } => [STAGES[0], STAGES[1]],
            Self::Tonemap => [STAGES[2], STAGES[3]],
        }
    }
}

/// Compiled shaders and every pipeline made of them so far. Pipelines are only ever added.
pub struct PipelineSet {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    /// The shaders of this generation, with their modes and parameters.
    pub shaders: Arc<ShaderSet>,
    modules: BTreeMap<String, Arc<ShaderModule>>,
    made: Mutex<HashMap<PipelineKey, Arc<Pipeline>>>,
}

impl PipelineSet {
    /// Makes the set and the pipelines of `wanted`, all or nothing. What an edit left alone is taken over from the set before:
    /// a stage that is the same object there, and the pipelines made of two such stages.
    ///
    /// # Errors
    /// The driver refuses a stage or a pipeline.
    pub fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        shaders: Arc<ShaderSet>,
        wanted: &Wanted,
        before: Option<&Self>,
    ) -> Result<Arc<Self>, GpuError> {
        let kept = |path: &str| {
            let before = before?;
            let same = Arc::ptr_eq(before.shaders.stages.get(path)?, shaders.stages.get(path)?);
            before.modules.get(path).filter(|_| same).cloned()
        };
        let module = |(path, stage): (&String, &Arc<Stage>)| match kept(path) {
            Some(module) => Ok((path.clone(), module)),
            None => Ok((path.clone(), ShaderModule::new(gpu, &stage.spirv)?)),
        };
        let modules = shaders.stages.iter().map(module).collect::<Result<_, GpuError>>()?;
        let pipelines = before.map(|set| set.made.lock().unwrap_or_else(PoisonError::into_inner));
        let is_kept = |pass: Pass| pass.stages().iter().all(|path| kept(path).is_some());
        let made = pipelines.iter().flat_map(|made| made.iter()).filter(|(key, _)| is_kept(key.pass));
        let made = made.map(|(key, pipeline)| (key.clone(), pipeline.clone())).collect();
        let set = Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            shaders: shaders.clone(),
            modules,
            made: Mutex::new(made),
        };
        set.build(wanted)?;
        Ok(Arc::new(set))
    }

    /// Adds what `wanted` lacks. From any thread; frames may be drawn meanwhile.
    ///
    /// # Errors
    /// The driver refuses a pipeline; those made before it stay.
    pub fn build(&self, wanted: &Wanted) -> Result<(), GpuError> {
        for key in wanted.keys() {
            if self.get(&key).is_none() {
                let pipeline = self.make(&key)?;
                self.made.lock().unwrap_or_else(PoisonError::into_inner).insert(key, pipeline);
            }
        }
        Ok(())
    }

    /// Whether a frame of `wanted` can be drawn now.
    pub fn has(&self, wanted: &Wanted) -> bool {
        wanted.keys().all(|key| self.get(&key).is_some())
    }

    pub(super) fn get(&self, key: &PipelineKey) -> Option<Arc<Pipeline>> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned()
    }

    fn make(&self, key: &PipelineKey) -> Result<Arc<Pipeline>, GpuError> {
        let missing = |path: &str| GpuError::NoStage(path.to_owned());
        let module = |path: &str| self.modules.get(path).ok_or_else(|| missing(path));
        let [vertex, fragment] = key.pass.stages();
        let (depth, raster, class) = match key.pass {
            Pass::Model { raster, class } => (true, raster, class),
            Pass::Tonemap => (false, Raster::Solid, PrimitiveClass::Triangles),
        };
        let desc = PipelineDesc {
            vertex: module(vertex)?,
            fragment: module(fragment)?,
            specialization: &key.specialization,
            color: key.format,
            depth,
            raster,
            samples: key.samples,
            class,
        };
        Pipeline::new(&self.gpu, &self.layouts, &desc)
    }
}
