//! The pipelines of one shader generation. A frame draws with exactly one set, so it never mixes two generations.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::gpu::{
    ComputePipeline, Gpu, GpuError, Pipeline, PipelineDesc, PrimitiveClass, Raster, SetLayouts, ShaderModule,
    Specialization,
};
use crate::shader::{ShaderSet, specialize};

use crate::render::brdf::tables::{self, Tables};
use crate::render::environment::bake::BAKE_STAGES;
use crate::render::wanted::{Pass, PipelineKey, Wanted};

/// The stages that a picture is drawn with.
const GRAPHICS: [&str; 7] =
    ["pbr.vert", "pbr.frag", "sky.vert", "sky.frag", "tonemap.vert", "tonemap.frag", "average.frag"];
/// The stages that measure the BRDF, compiled by those who measure.
pub const MEASURE_STAGES: [&str; 4] =
    ["measure/furnace.comp", "measure/reciprocity.comp", "measure/normalization.comp", "measure/lobe.comp"];

/// The stages that a shader tree must have to be shown, as paths from its root.
pub fn stages() -> Vec<&'static str> {
    GRAPHICS.into_iter().chain([tables::DFG, tables::SHEEN_ALBEDO]).chain(BAKE_STAGES).collect()
}

/// Those and the ones that measure the BRDF: everything in a tree with a `main()`.
pub fn all_stages() -> Vec<&'static str> {
    stages().into_iter().chain(MEASURE_STAGES).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Pass {
    /// Vertex and fragment stage.
    fn stages(self) -> [&'static str; 2] {
        match self {
            Self::Model { .. } => [GRAPHICS[0], GRAPHICS[1]],
            Self::Sky => [GRAPHICS[2], GRAPHICS[3]],
            Self::Tonemap => [GRAPHICS[4], GRAPHICS[5]],
            Self::Average => [GRAPHICS[4], GRAPHICS[6]],
        }
    }
}

/// Compiled shaders and every pipeline made of them so far. Pipelines are only ever added.
pub struct PipelineSet {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    /// The shaders of this generation, with their modes and parameters.
    pub shaders: Arc<ShaderSet>,
    made: Mutex<HashMap<PipelineKey, Arc<Pipeline>>>,
    computes: Mutex<HashMap<(String, Specialization), Arc<ComputePipeline>>>,
    tables: Mutex<HashMap<Specialization, Arc<Tables>>>,
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
        let is_same = |path: &str| match (before.and_then(|b| b.shaders.stages.get(path)), shaders.stages.get(path)) {
            (Some(before), Some(now)) => Arc::ptr_eq(before, now),
            _ => false,
        };
        let pipelines = before.map(|set| lock(&set.made));
        let is_kept = |pass: Pass| pass.stages().iter().all(|path| is_same(path));
        let made = pipelines.iter().flat_map(|made| made.iter()).filter(|(key, _)| is_kept(key.pass));
        let made = made.map(|(key, pipeline)| (key.clone(), pipeline.clone())).collect();
        // The window draws with it while this one is built.
        drop(pipelines);
        let computes = before.map(|set| lock(&set.computes).clone()).unwrap_or_default();
        let computes = computes.into_iter().filter(|((path, _), _)| is_same(path)).collect();
        let same_tables = [tables::DFG, tables::SHEEN_ALBEDO].into_iter().all(is_same);
        let tables = before.filter(|_| same_tables).map(|set| lock(&set.tables).clone()).unwrap_or_default();
        let set = Self {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            shaders: shaders.clone(),
            made: Mutex::new(made),
            computes: Mutex::new(computes),
            tables: Mutex::new(tables),
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
                lock(&self.made).insert(key, pipeline);
            }
        }
        if self.tables(wanted).is_none() {
            let constants = self.of_tables(&wanted.constants);
            let tables = Tables::new(self, &constants)?;
            lock(&self.tables).insert(constants, tables);
        }
        Ok(())
    }

    /// Whether a frame of `wanted` can be drawn now.
    pub fn has(&self, wanted: &Wanted) -> bool {
        wanted.keys().all(|key| self.get(&key).is_some()) && self.tables(wanted).is_some()
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    pub(super) fn layouts(&self) -> &Arc<SetLayouts> {
        &self.layouts
    }

    /// The tables of `wanted`'s models, once they are made.
    pub(super) fn tables(&self, wanted: &Wanted) -> Option<Arc<Tables>> {
        lock(&self.tables).get(&self.of_tables(&wanted.constants)).cloned()
    }

    /// The constants that the tables depend on.
    fn of_tables(&self, constants: &Specialization) -> Specialization {
        let stages = [tables::DFG, tables::SHEEN_ALBEDO].into_iter().filter_map(|path| self.shaders.stages.get(path));
        let declared: Vec<u32> = stages.flat_map(|s| s.reflection.constants.iter().map(|c| c.id)).collect();
        constants.iter().filter(|(id, _)| declared.contains(id)).copied().collect()
    }

    /// Whether an environment looks the same when baked with either set.
    pub(crate) fn bakes_like(&self, other: &Self) -> bool {
        BAKE_STAGES.iter().all(|path| match (self.shaders.stages.get(*path), other.shaders.stages.get(*path)) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) || a.spirv == b.spirv,
            _ => false,
        })
    }

    /// The module of a stage.
    pub(super) fn spirv(&self, path: &str) -> Result<&Vec<u32>, GpuError> {
        self.shaders.stages.get(path).map(|stage| &stage.spirv).ok_or_else(|| GpuError::NoStage(path.to_owned()))
    }

    /// A stage with these values for its constants.
    fn module(&self, path: &str, constants: &[(u32, u32)]) -> Result<Arc<ShaderModule>, GpuError> {
        ShaderModule::new(&self.gpu, path, &specialize(self.spirv(path)?, constants))
    }

    /// A compute pipeline, made at its first use.
    pub(super) fn compute(&self, path: &str, constants: &Specialization) -> Result<Arc<ComputePipeline>, GpuError> {
        let key = (path.to_owned(), constants.clone());
        if let Some(pipeline) = lock(&self.computes).get(&key) {
            return Ok(pipeline.clone());
        }
        let module = self.module(path, constants)?;
        let pipeline = ComputePipeline::new(&self.gpu, &self.layouts, &module)?;
        lock(&self.computes).insert(key, pipeline.clone());
        Ok(pipeline)
    }

    pub(super) fn get(&self, key: &PipelineKey) -> Option<Arc<Pipeline>> {
        lock(&self.made).get(key).cloned()
    }

    fn make(&self, key: &PipelineKey) -> Result<Arc<Pipeline>, GpuError> {
        let module = |path: &str| self.module(path, &key.specialization);
        let [vertex, fragment] = key.pass.stages();
        let (depth, raster, class) = match key.pass {
            Pass::Model { raster, class } => (true, raster, class),
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
