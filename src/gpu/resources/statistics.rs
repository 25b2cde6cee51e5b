//! Statistics of a compiled pipeline: the SPIR-V words of its modules, the compile time of the driver, and the driver's statistics of
//! the machine code (VK_KHR_pipeline_executable_properties). Each driver reports different statistics under its own names.
//!
//! The driver's statistics need VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT, which may change what a driver does and
//! whether its cache hits. So no pipeline of a frame has this flag: if the user asks, the worker builds the largest
//! pipeline of each stage once more with the flag when idle. A change is the difference to the same request in the set
//! of the previous version.

use std::ffi::{CStr, c_char};
use std::sync::OnceLock;

use ash::vk;
use serde::Serialize;

use crate::gpu::error::Context;
use crate::gpu::{Gpu, GpuError};

/// A driver statistic of machine code.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistic {
    /// The driver's name of the statistic, as `Register Count`.
    pub name: String,
    /// The driver's description of the statistic.
    pub meaning: String,
    /// Its value. A driver's true is 1.
    pub value: f64,
}

/// Machine code that a driver has generated for one stage or several.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Executable {
    /// The driver's name of the code.
    pub name: String,
    /// The kinds of its stages, as `fragment`.
    pub stages: Vec<&'static str>,
    /// Invocations that run together (subgroup size); 0 if the driver does not report it.
    pub subgroup_size: u32,
    /// The driver's statistics, in its order.
    pub statistics: Vec<Statistic>,
}

/// A stage of a pipeline.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PipelineStage {
    /// Path of the stage.
    pub stage: String,
    /// Words of its specialized module.
    pub words_before: usize,
    /// Words that the driver gets: the specialized module after Specula's optimizer.
    pub words: usize,
    /// The driver's time for this stage, milliseconds, if it reports that.
    pub driver_ms: Option<f64>,
}

/// Information about a compiled pipeline.
#[derive(Debug, Default)]
pub struct CompileInfo {
    /// Its stages, in the order in which they run.
    pub stages: Vec<PipelineStage>,
    /// Time of the call that created it, milliseconds.
    pub ms: f64,
    /// Whether the driver took it from a cache.
    pub is_cached: bool,
    statistics: OnceLock<Vec<Executable>>,
}

impl CompileInfo {
    pub(super) fn new(stages: Vec<PipelineStage>, ms: f64, is_cached: bool) -> Self {
        Self { stages, ms, is_cached, statistics: OnceLock::new() }
    }

    /// The driver's statistics; `None` until they are queried ([`CompileInfo::set_statistics`]).
    pub fn statistics(&self) -> Option<&[Executable]> {
        self.statistics.get().map(Vec::as_slice)
    }

    /// Stores the statistics that were queried from a second build of this pipeline.
    pub fn set_statistics(&self, statistics: Vec<Executable>) {
        let _ = self.statistics.set(statistics);
    }
}

/// Milliseconds of a creation feedback, where the driver fills it.
pub(super) fn feedback_ms(feedback: &vk::PipelineCreationFeedback) -> Option<f64> {
    let is_valid = feedback.flags.contains(vk::PipelineCreationFeedbackFlags::VALID);
    is_valid.then_some(feedback.duration as f64 * 1e-6)
}

/// Queries the statistics of a pipeline, which must have been created with the flag `CAPTURE_STATISTICS`.
pub(super) fn read(gpu: &Gpu, pipeline: vk::Pipeline) -> Result<Vec<Executable>, GpuError> {
    let Some(extension) = &gpu.executables else { return Ok(Vec::new()) };
    let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
    // SAFETY: the pipeline is live, in this and the next call.
    let all = unsafe { extension.get_pipeline_executable_properties(&info) }.context("asking what a pipeline is of")?;
    let of = |(index, properties): (u32, &vk::PipelineExecutablePropertiesKHR<'_>)| {
        let info = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline).executable_index(index);
        // SAFETY: the index is one of those that the driver has listed, and statistics were captured.
        let found = unsafe { extension.get_pipeline_executable_statistics(&info) };
        let found = found.context("asking for the statistics of a pipeline")?;
        Ok(Executable {
            name: text(&properties.name),
            stages: kinds(properties.stages),
            subgroup_size: properties.subgroup_size,
            statistics: found.iter().map(statistic).collect(),
        })
    };
    (0..).zip(&all).map(of).collect()
}

fn statistic(found: &vk::PipelineExecutableStatisticKHR<'_>) -> Statistic {
    use vk::PipelineExecutableStatisticFormatKHR as Format;
    // SAFETY: the driver has set the field of the union that the format names.
    let value = unsafe {
        match found.format {
            Format::BOOL32 => f64::from(u8::from(found.value.b32 != vk::FALSE)),
            Format::INT64 => found.value.i64 as f64,
            Format::UINT64 => found.value.u64 as f64,
            _ => found.value.f64,
        }
    };
    Statistic { name: text(&found.name), meaning: text(&found.description), value }
}

/// The text before the first NUL.
fn text(characters: &[c_char]) -> String {
    CStr::from_bytes_until_nul(bytemuck::cast_slice(characters))
        .map(|text| text.to_string_lossy().into_owned())
        .unwrap_or_default()
}

fn kinds(stages: vk::ShaderStageFlags) -> Vec<&'static str> {
    use vk::ShaderStageFlags as S;
    let all = [
        (S::VERTEX, "vertex"),
        (S::TESSELLATION_CONTROL, "tessellation control"),
        (S::TESSELLATION_EVALUATION, "tessellation evaluation"),
        (S::GEOMETRY, "geometry"),
        (S::TASK_EXT, "task"),
        (S::MESH_EXT, "mesh"),
        (S::FRAGMENT, "fragment"),
        (S::COMPUTE, "compute"),
    ];
    all.iter().filter(|(flag, _)| stages.contains(*flag)).map(|(_, name)| *name).collect()
}
