//! Makes the pipeline of a key: its modules, its layout and its fixed state.

use super::{PipelineSet, check_bound, of_pass};
use crate::frame::{PipelineKey, pass_format};
use crate::gpu::{GpuError, PipelineDesc, ShaderModule, vk};
use crate::pipeline::bounds::{module_of_modes, shader_module};
use crate::shader::graph::RenderPhase;
use crate::shader::{GraphPass, StageKind};

impl PipelineSet {
    /// Whether the device and the stages of a pass can find draws in a buffer: a vertex and a fragment stage can, as a rule.
    fn can_draw_by_index(&self, pass: &GraphPass) -> Result<bool, GpuError> {
        let vertex = pass.pre_rasterization.vertex.as_str();
        if !self.gpu.draw_features().by_index || !pass.pre_rasterization.stages().eq([vertex]) {
            return Ok(false);
        }
        Ok(self.stage(vertex)?.can_index_draws() && self.stage(&pass.desc.stage)?.can_index_draws())
    }

    /// Calls `then` with the create info of the pipeline of `key`.
    pub(super) fn make<T>(
        &self,
        key: &PipelineKey,
        then: impl FnOnce(&PipelineDesc<'_>) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let pass = &key.pass.0;
        let is_on_display = matches!(pass.phase, RenderPhase::Tonemap | RenderPhase::Display);
        let draws_by_index = key.draws_by_index && self.can_draw_by_index(pass)?;
        let module = |path: &str| {
            shader_module(&self.gpu, self.stage(path)?, &key.specialization, is_on_display, draws_by_index)
        };
        let pre_rasterization =
            pass.pre_rasterization.stages().map(|path| Ok((flag_of(self.stage(path)?.kind), module(path)?)));
        let pre_rasterization = pre_rasterization.collect::<Result<Vec<_>, GpuError>>()?;
        let fragment = match &*key.modes {
            [] => module(&pass.desc.stage)?,
            modes => {
                let stage = self.stage(&pass.desc.stage)?;
                let several = module_of_modes(&self.gpu, stage, &key.specialization, modes, draws_by_index);
                several.ok_or_else(|| GpuError::NoStage(format!("{} in several modes", pass.desc.stage)))??
            }
        };
        let pre_rasterization: Vec<_> = pre_rasterization.iter().map(|(flag, module)| (*flag, &**module)).collect();
        let modules: Vec<&ShaderModule> =
            pre_rasterization.iter().map(|(_, module)| *module).chain([&*fragment]).collect();
        modules.iter().try_for_each(|module| check_bound(module, pass.role()))?;
        let layout = self.layout(&pass.inputs, &modules, pass.desc.draws_model());
        let layout = layout.map_err(|error| of_pass(pass, error))?;
        let more = pass.desc.also.iter().map(|(_, format)| pass_format(*format));
        let modes = key.modes.iter().skip(1).map(|_| key.format);
        let colors: Vec<_> = std::iter::once(key.format).chain(more).chain(modes).collect();
        let desc = PipelineDesc {
            pre_rasterization: &pre_rasterization,
            fragment: &fragment,
            colors: &colors,
            depth: pass.desc.model.is_some() || pass.phase == RenderPhase::Model,
            raster: key.raster,
            samples: key.samples,
            class: key.class,
            layout,
            draws_by_index,
        };
        then(&desc)
    }
}

fn flag_of(kind: StageKind) -> vk::ShaderStageFlags {
    use vk::ShaderStageFlags as S;
    match kind {
        StageKind::Vertex => S::VERTEX,
        StageKind::TessellationControl => S::TESSELLATION_CONTROL,
        StageKind::TessellationEvaluation => S::TESSELLATION_EVALUATION,
        StageKind::Geometry => S::GEOMETRY,
        StageKind::Task => S::TASK_EXT,
        StageKind::Mesh => S::MESH_EXT,
        StageKind::Fragment => S::FRAGMENT,
        StageKind::Compute => S::COMPUTE,
    }
}
