//! Reports on the stages of a picture: SPIR-V words, compile time of the driver, and statistics of the machine code.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use serde::Serialize;

use super::{PipelineSet, lock};
use crate::frame::{PipelineKey, PipelineRequest};
use crate::gpu::{CompileInfo, ComputePipeline, Executable, GpuError, Pipeline, Specialization};
use crate::pipeline::bounds::shader_module;
use crate::shader::GraphPass;

/// A stage in the largest of its pipelines.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct InPipeline {
    /// Words with the pipeline's constants, before Specula's optimizer.
    pub words_before: usize,
    /// Words that the driver got.
    pub words: usize,
    /// The driver's time for the stage, milliseconds, if it reports that.
    pub driver_ms: Option<f64>,
    /// Time of the call that created the whole pipeline, milliseconds.
    pub pipeline_ms: f64,
    /// Whether the driver took the pipeline from a cache.
    pub is_cached: bool,
    /// The driver's statistics of the stage's machine code; `None` until they are queried.
    pub executables: Option<Vec<Executable>>,
}

/// A stage of a shader set.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StageReport {
    /// Words of its module as compiled, including the code that constants may switch off.
    pub compiled: usize,
    /// Number of its pipelines in the frame: one for each kind of material, for example.
    pub pipelines: usize,
    /// Its values in the largest of these pipelines; `None` if the frame does not use the stage, or it is being built.
    pub largest: Option<InPipeline>,
}

/// A pipeline of a frame.
enum FramePipeline {
    Graphics(PipelineKey, Arc<Pipeline>),
    Compute(Arc<GraphPass>, Arc<ComputePipeline>),
}

impl FramePipeline {
    fn compile_info(&self) -> &CompileInfo {
        match self {
            Self::Graphics(_, pipeline) => &pipeline.compile_info,
            Self::Compute(_, pipeline) => &pipeline.compile_info,
        }
    }

    fn words(&self) -> usize {
        self.compile_info().stages.iter().map(|stage| stage.words).sum()
    }
}

impl PipelineSet {
    /// Number of pipelines in the set: those of the newest requests, of bakes and of thumbnails.
    pub fn count(&self) -> usize {
        lock(&self.graphics).entries.len() + lock(&self.computes).entries.len()
    }

    /// All stages by path, with their statistics in the pipelines of `request`.
    pub fn report(&self, request: &PipelineRequest) -> BTreeMap<String, StageReport> {
        let new = |words: usize| StageReport { compiled: words, ..StageReport::default() };
        let mut all: BTreeMap<String, StageReport> =
            self.shaders.stages.iter().map(|(path, stage)| (path.clone(), new(stage.spirv.len()))).collect();
        for found in self.found(request) {
            let compile_info = found.compile_info();
            for stage in &compile_info.stages {
                let Some(report) = all.get_mut(&stage.stage) else { continue };
                report.pipelines += 1;
                // The first of several equal ones, so that the same frame always gives the same report.
                if report.largest.as_ref().is_some_and(|known| known.words >= stage.words) {
                    continue;
                }
                let kind = self.shaders.stages.get(&stage.stage).map(|stage| stage.kind.name()).unwrap_or_default();
                let is_of_stage = |executable: &&Executable| executable.stages.contains(&kind);
                let of_stage = |all: &[Executable]| all.iter().filter(is_of_stage).cloned().collect();
                report.largest = Some(InPipeline {
                    words_before: stage.words_before,
                    words: stage.words,
                    driver_ms: stage.driver_ms,
                    pipeline_ms: compile_info.ms,
                    is_cached: compile_info.is_cached,
                    executables: compile_info.statistics().map(of_stage),
                });
            }
        }
        all
    }

    /// Queries the statistics of the next pipeline of `request` that lacks them, which builds that pipeline once more. Returns
    /// how long that took in milliseconds, or `None` if none is left.
    ///
    /// # Errors
    /// The driver rejects the pipeline, or does not answer.
    pub fn ask_driver(&self, request: &PipelineRequest) -> Result<Option<f64>, GpuError> {
        if !self.gpu.tells_statistics() {
            return Ok(None);
        }
        // The report shows the largest pipeline of each stage; the others need no query.
        let mut found = self.found(request);
        found.sort_by_key(|found| std::cmp::Reverse(found.words()));
        let mut stages: Vec<&str> = Vec::new();
        let mut next = None;
        for found in &found {
            let of = || found.compile_info().stages.iter().map(|stage| stage.stage.as_str());
            let is_shown = of().any(|stage| !stages.contains(&stage));
            stages.extend(of());
            if is_shown && found.compile_info().statistics().is_none() && next.is_none() {
                next = Some(found);
            }
        }
        let Some(next) = next else { return Ok(None) };
        let start = std::time::Instant::now();
        let told = match next {
            FramePipeline::Graphics(key, _) => self.make(key, |desc| Pipeline::statistics(&self.gpu, desc)),
            FramePipeline::Compute(pass, _) => self.ask_about(pass, &request.pass_constants()),
        };
        // A driver that refuses is not queried again.
        next.compile_info().set_statistics(told.as_ref().ok().cloned().unwrap_or_default());
        told.map(|_| Some(start.elapsed().as_secs_f64() * 1e3))
    }

    fn ask_about(&self, pass: &GraphPass, constants: &Specialization) -> Result<Vec<Executable>, GpuError> {
        let module = shader_module(&self.gpu, self.stage(&pass.desc.stage)?, constants, false, false)?;
        let layout = self.layout(&pass.inputs, &[&module], false)?;
        ComputePipeline::statistics(&self.gpu, &self.layouts, &module, Some(&layout))
    }

    /// The pipelines of `request` that are there, in its order.
    fn found(&self, request: &PipelineRequest) -> Vec<FramePipeline> {
        let graphics = lock(&self.graphics);
        // A material may be drawn twice with one pipeline.
        let mut known = HashSet::new();
        let keys = request.keys().filter(|key| known.insert(key.clone()));
        let pipelines = keys.filter_map(|key| {
            let pipeline = graphics.get(&key)?.clone();
            Some(FramePipeline::Graphics(key, pipeline))
        });
        let mut found: Vec<FramePipeline> = pipelines.collect();
        let computes = lock(&self.computes);
        let constants = request.pass_constants();
        found.extend(request.passes.iter().filter(|pass| pass.is_compute).filter_map(|pass| {
            let pipeline = computes.get(&(pass.desc.stage.clone(), constants.clone()))?.clone();
            Some(FramePipeline::Compute(pass.clone(), pipeline))
        }));
        found
    }
}
