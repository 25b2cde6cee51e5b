//! Compute pipelines.

use std::sync::Arc;
use std::time::Instant;

use ash::vk;

use super::buffer::Buffer;
use super::descriptor::SetLayouts;
use super::pass_layout::PassLayout;
use super::pipeline::{CAPTURE, MAIN, ShaderModule};
use super::resource_usage::ResourceUsage;
use super::statistics::{self, CompileInfo, Executable, feedback_ms};
use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};

/// A compute pipeline.
pub struct ComputePipeline {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    /// The layout of a declared pass.
    pub layout: Option<Arc<PassLayout>>,
    /// The descriptors that its stage uses.
    pub usage: ResourceUsage,
    /// Information about the compiled code.
    pub compile_info: CompileInfo,
    /// The loop report buffer, if its stages have loops that may not end.
    pub(in crate::gpu) loops: Option<Arc<Buffer>>,
    pub(in crate::gpu) raw: vk::Pipeline,
}

impl ComputePipeline {
    /// The layout that its sets are bound with.
    pub(in crate::gpu) fn raw_layout(&self) -> vk::PipelineLayout {
        self.layout.as_ref().map_or(self.layouts.pipeline, |layout| layout.pipeline)
    }

    /// Creates a pipeline of one stage, named after its module. `layout`: that of a declared pass.
    ///
    /// # Errors
    /// The driver rejects the pipeline or is out of memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        module: &ShaderModule,
        layout: Option<Arc<PassLayout>>,
    ) -> Result<Arc<Self>, GpuError> {
        let (raw, compile_info) =
            Self::create(gpu, layouts, module, layout.as_deref(), vk::PipelineCreateFlags::empty())?;
        gpu.name(raw, &module.name);
        let loops = module.names_loops.then(|| layouts.blank.loops.clone());
        let usage = module.usage.clone();
        Ok(Arc::new(Self { gpu: gpu.clone(), layouts: layouts.clone(), layout, usage, compile_info, loops, raw }))
    }

    /// Builds a pipeline once more to query its statistics.
    ///
    /// # Errors
    /// As [`ComputePipeline::new`].
    pub fn statistics(
        gpu: &Arc<Gpu>,
        layouts: &SetLayouts,
        module: &ShaderModule,
        layout: Option<&PassLayout>,
    ) -> Result<Vec<Executable>, GpuError> {
        let (raw, _) = Self::create(gpu, layouts, module, layout, CAPTURE)?;
        let statistics = statistics::read(gpu, raw);
        // SAFETY: nothing has used the pipeline.
        unsafe { gpu.device.destroy_pipeline(raw, None) };
        statistics
    }

    fn create(
        gpu: &Gpu,
        layouts: &SetLayouts,
        module: &ShaderModule,
        layout: Option<&PassLayout>,
        flags: vk::PipelineCreateFlags,
    ) -> Result<(vk::Pipeline, CompileInfo), GpuError> {
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module.raw)
            .name(MAIN);
        let layout = layout.map_or(layouts.pipeline, |layout| layout.pipeline);
        let mut whole = vk::PipelineCreationFeedback::default();
        let mut feedback = vk::PipelineCreationFeedbackCreateInfo::default().pipeline_creation_feedback(&mut whole);
        let info =
            vk::ComputePipelineCreateInfo::default().flags(flags).stage(stage).layout(layout).push_next(&mut feedback);
        let start = Instant::now();
        // SAFETY: every pointer in `info` lives until the call returns; module and layout are live. The cache is internally
        // synchronized.
        let made = unsafe { gpu.device.create_compute_pipelines(gpu.pipeline_cache.raw, &[info], None) };
        let name = format!("`{}`", module.name);
        let raw = made.map_err(|(_, result)| result).context_of("creating the compute pipeline", &name)?[0];
        let is_cached = whole.flags.contains(vk::PipelineCreationFeedbackFlags::APPLICATION_PIPELINE_CACHE_HIT);
        let compile_info = CompileInfo::new(
            vec![module.stage_info(feedback_ms(&whole))],
            start.elapsed().as_secs_f64() * 1e3,
            is_cached,
        );
        Ok((raw, compile_info))
    }
}

impl Drop for ComputePipeline {
    fn drop(&mut self) {
        // SAFETY: the last `Arc` is gone, and a submission in flight would hold one.
        unsafe { self.gpu.device.destroy_pipeline(self.raw, None) };
    }
}
