//! The passes of a bake. Each method records, submits and waits.

use std::ops::Range;
use std::sync::Arc;

use crate::gpu::{Buffer, Gpu, GpuError, Image, Memory, Sampler, SetLayouts, SetWriter, Use, one_shot, vk};
use crate::interface::{
    BINDING_LEVEL_ABOVE, BINDING_RESULTS, BINDING_SOURCE, BINDING_SOURCE_CUBE, BINDING_TARGET, SET_TASK, Task,
};

use crate::render::compute;
use crate::render::environment::bake::{BAKE_STAGES, CUBE, DOWNSAMPLE, IRRADIANCE};
use crate::render::pipeline::PipelineSet;

/// Level of the cube that irradiance is summed over: 16 x 16 texels.
pub(crate) const IRRADIANCE_LEVEL: u32 = 5;
/// The zeroed buffer `BINDING_RESULTS`, as large as the largest declaration in the stages (ibl/small_lights.glsl).
pub(crate) fn no_results(gpu: &Arc<Gpu>, set: &PipelineSet) -> Result<Arc<Buffer>, GpuError> {
    let stages = BAKE_STAGES.iter().filter_map(|path| set.shaders.stages.get(*path));
    let declared = stages.flat_map(|stage| &stage.reflection.descriptors);
    let results = declared.filter(|d| (d.set, d.binding) == (SET_TASK, BINDING_RESULTS));
    let sizes = results.filter_map(|descriptor| descriptor.block.as_ref()).map(|block| u64::from(block.size));
    let bytes = sizes.max().unwrap_or(0).max(16);
    use vk::BufferUsageFlags as Usage;
    let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let results = Buffer::new(gpu, "bake", bytes, usage, Memory::Device)?;
    let staging = Buffer::new(gpu, "staging", bytes, Usage::TRANSFER_SRC, Memory::Upload)?;
    staging.write(0, &vec![0; bytes as usize]);
    one_shot(gpu, |encoder| {
        encoder.copy_buffer(&staging, 0, &results, 0, bytes);
        encoder.copies_done();
        Ok(())
    })?;
    Ok(results)
}

/// The arguments of all passes.
pub(crate) struct Passes<'a> {
    pub(crate) gpu: &'a Arc<Gpu>,
    pub(crate) layouts: &'a Arc<SetLayouts>,
    pub(crate) set: &'a PipelineSet,
    /// `BINDING_RESULTS`: one pass stores here what the following ones read, see ibl/small_lights.glsl.
    pub(crate) results: &'a Arc<Buffer>,
}

impl Passes<'_> {
    /// Binds the level that a pass writes, and the shared results.
    fn to(&self, writer: SetWriter, image: &Arc<Image>, level: u32) -> SetWriter {
        writer.storage_level(BINDING_TARGET, image, level).buffer(BINDING_RESULTS, self.results)
    }

    /// Resamples the map to level 0, then each level from the level above. Leaves the cube in [`Use::Sampled`].
    pub(crate) fn cube(&self, map: &Arc<Image>, cube: &Arc<Image>, radiance_scale: f32) -> Result<(), GpuError> {
        let desc = *cube.desc();
        let sampler = compute::linear(self.gpu, vk::SamplerAddressMode::REPEAT)?;
        // At the center of a face, a texel of the cube spans 2 / side radians; the map has width / 2 pi texels per radian.
        // At least 2 x 2 samples: with one, the energy of a small lamp is off by 0.6 %.
        let finer = (map.desc().width as f32 / std::f32::consts::TAU * 2.0 / desc.width as f32).ceil().max(2.0);
        let first = Task {
            size: [desc.width; 2],
            levels: desc.mips,
            samples: (finer as u32).min(8),
            radiance_scale,
            ..Task::default()
        };
        let bind = |task: &Task, more: &dyn Fn(SetWriter) -> SetWriter| {
            let writer = |writer| more(self.to(writer, cube, task.level));
            compute::bindings(self.gpu, self.layouts, task, writer)
        };
        let mut dispatches = vec![(
            self.set.compute(CUBE, &Vec::new())?,
            bind(&first, &|w| w.texture(BINDING_SOURCE, map, &sampler))?,
            desc.width,
        )];
        for level in 1..desc.mips {
            let side = (desc.width >> level).max(1);
            let task = Task { size: [side; 2], level, ..first };
            let set = bind(&task, &|writer| writer.storage_level(BINDING_LEVEL_ABOVE, cube, level - 1))?;
            dispatches.push((self.set.compute(DOWNSAMPLE, &Vec::new())?, set, side));
        }
        one_shot(self.gpu, |encoder| {
            encoder.transition(cube, Use::Undefined, Use::Storage);
            for (pipeline, set, side) in &dispatches {
                encoder.dispatch(self.layouts, pipeline, &[set], compute::groups(*side, desc.layers));
                encoder.transition(cube, Use::Storage, Use::Storage);
                encoder.computed();
            }
            encoder.transition(cube, Use::Storage, Use::Sampled);
            Ok(())
        })
    }

    /// Integrates the radiance of the cube over the hemisphere of each normal. Leaves both images in [`Use::Sampled`].
    pub(crate) fn irradiance(&self, cube: &Arc<Image>, to: &Arc<Image>) -> Result<(), GpuError> {
        let side = to.desc().width;
        let task = Task { size: [side; 2], levels: 1, ..Task::default() };
        let bindings = compute::bindings(self.gpu, self.layouts, &task, |writer| {
            self.to(writer, to, 0).storage_level(BINDING_LEVEL_ABOVE, cube, IRRADIANCE_LEVEL)
        })?;
        let pipeline = self.set.compute(IRRADIANCE, &Vec::new())?;
        one_shot(self.gpu, |encoder| {
            encoder.transition(to, Use::Undefined, Use::Storage);
            encoder.transition(cube, Use::Sampled, Use::Storage);
            encoder.dispatch(self.layouts, &pipeline, &[&bindings], compute::groups(side, to.desc().layers));
            encoder.transition(cube, Use::Storage, Use::Sampled);
            encoder.transition(to, Use::Storage, Use::Sampled);
            Ok(())
        })
    }

    /// Prefilters `levels` of `to`. `samples` has an entry for every level of the image. The last level leaves the image in
    /// [`Use::Sampled`].
    pub(crate) fn prefilter(
        &self,
        stage: &str,
        (cube, sampler): (&Arc<Image>, &Arc<Sampler>),
        to: &Arc<Image>,
        levels: Range<u32>,
        samples: &[u32],
    ) -> Result<(), GpuError> {
        let desc = *to.desc();
        let pipeline = self.set.compute(stage, &Vec::new())?;
        let mut dispatches = Vec::new();
        for level in levels {
            let side = (desc.width >> level).max(1);
            let samples = samples.get(level as usize).copied().unwrap_or(1);
            let task = Task { size: [side; 2], level, levels: desc.mips, samples, ..Task::default() };
            let bindings = compute::bindings(self.gpu, self.layouts, &task, |writer| {
                self.to(writer.texture(BINDING_SOURCE_CUBE, cube, sampler), to, level)
            })?;
            dispatches.push((level, bindings, compute::groups(side, desc.layers)));
        }
        one_shot(self.gpu, |encoder| {
            for (level, bindings, groups) in &dispatches {
                if *level == 0 {
                    encoder.transition(to, Use::Undefined, Use::Storage);
                }
                encoder.dispatch(self.layouts, &pipeline, &[bindings], *groups);
                if level + 1 == desc.mips {
                    encoder.transition(to, Use::Storage, Use::Sampled);
                }
            }
            Ok(())
        })
    }
}
