//! The passes of a bake. Each method records, submits and waits.

use std::ops::Range;
use std::sync::Arc;

use crate::gpu::{
    Buffer, ComputePipeline, DescriptorSet, Gpu, GpuError, Image, Memory, SetLayouts, SetWriter, Use, one_shot, vk,
};
use crate::interface::{
    BINDING_LEVEL_ABOVE, BINDING_LOBE, BINDING_LOBE_TARGET, BINDING_PACKED, BINDING_RESULTS, BINDING_SMALL_LIGHTS,
    BINDING_SOURCE, BINDING_SOURCE_CUBE, BINDING_TARGET, MAX_SUNS, MIRROR_SIDE, SET_TASK, SPECULAR_SIDE, Task,
};

use crate::frame::BakeStage;
use crate::frame::stages::{CUBE, DOWNSAMPLE, IRRADIANCE};
use crate::pipeline::PipelineSet;
use crate::render::compute;
use crate::render::environment::transfer;
use crate::scene::Sun;

/// Level of the cube that irradiance is summed over: 16 x 16 texels.
pub(crate) const IRRADIANCE_LEVEL: u32 = 5;

/// Bytes of the block that a stage declares at this binding of set 3.
fn declared_size(set: &PipelineSet, stage: &str, binding: u32) -> u64 {
    let stage = set.shaders.stages.get(stage);
    let mut declared = stage.iter().flat_map(|stage| &stage.reflection.descriptors);
    let found = declared.find(|d| (d.set, d.binding) == (SET_TASK, binding));
    found.and_then(|descriptor| descriptor.block.as_ref()).map_or(0, |block| u64::from(block.size)).max(16)
}

/// Bytes of the list of ibl/small_lights/list.glsl.
pub(crate) fn small_lights_size(set: &PipelineSet) -> u64 {
    declared_size(set, DOWNSAMPLE, BINDING_RESULTS)
}

/// The suns at the start of the list of ibl/small_lights/list.glsl.
pub(crate) fn suns_of(list: &[u8]) -> Vec<Sun> {
    let Some((count, rest)) = list.split_first_chunk() else { return Vec::new() };
    let suns = rest.chunks_exact(size_of::<Sun>()).take(MAX_SUNS.min(u32::from_ne_bytes(*count) as usize));
    suns.map(bytemuck::pod_read_unaligned).collect()
}

/// Replaces the suns with the same number of others.
pub(crate) fn set_suns(list: &mut [u8], suns: &[Sun]) {
    let bytes = bytemuck::cast_slice(suns);
    if let Some(place) = list.get_mut(size_of::<u32>()..size_of::<u32>() + bytes.len()) {
        place.copy_from_slice(bytes);
    }
}

/// The buffer of ibl/small_lights/list.glsl with these bytes; zeros for a new bake.
pub(crate) fn small_lights(gpu: &Arc<Gpu>, bytes: &[u8]) -> Result<Arc<Buffer>, GpuError> {
    use vk::BufferUsageFlags as Usage;
    let size = bytes.len() as u64;
    let usage = Usage::STORAGE_BUFFER | Usage::UNIFORM_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let results = Buffer::new(gpu, "small lights", size, usage, Memory::Device)?;
    let staging = Buffer::new(gpu, "staging", size, Usage::TRANSFER_SRC, Memory::Upload)?;
    staging.write(0, bytes);
    one_shot(gpu, |encoder| {
        encoder.copy_buffer(&staging, 0, &results, 0, size);
        encoder.copies_done();
        Ok(())
    })?;
    Ok(results)
}

/// Texels to a side that cover a tile of a pair of specular levels (`specular_tile` in ibl/maps/levels.glsl), whose
/// corner may lie within a texel. Pair 0 is the mirror.
fn specular_side(pair: u32) -> u32 {
    if pair == 0 {
        return MIRROR_SIDE;
    }
    (SPECULAR_SIDE as f32 * 0.75_f32.powf(pair as f32 - 1.0)).ceil() as u32 + 1
}

/// The samples of every pair of specular levels: ibl/sampling/lobe.glsl.
pub(crate) struct Lobes<'a> {
    /// A buffer for each pair. That of the mirror stays empty.
    pub(crate) buffers: Vec<Arc<Buffer>>,
    /// Samples of each pair.
    samples: &'a [u32],
}

impl<'a> Lobes<'a> {
    /// Cells of ibl/lobe.comp, passed as a parameter: if the driver knew the number, it would unroll the loops over them, which
    /// took a second on NVIDIA.
    const CELLS: u32 = 1024;

    pub(crate) fn new(set: &PipelineSet, stage: &BakeStage, samples: &'a [u32]) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let size = declared_size(set, stage.stage.path.as_str(), BINDING_LOBE_TARGET);
        let usage = Usage::STORAGE_BUFFER | Usage::UNIFORM_BUFFER | Usage::TRANSFER_SRC;
        let buffers = samples.iter().map(|_| Buffer::new(&set.gpu, "lobe", size, usage, Memory::Device));
        Ok(Self { buffers: buffers.collect::<Result<_, _>>()?, samples })
    }
}

/// The arguments of all passes.
pub(crate) struct Passes<'a> {
    pub(crate) gpu: &'a Arc<Gpu>,
    pub(crate) layouts: &'a Arc<SetLayouts>,
    pub(crate) set: &'a PipelineSet,
    /// The stages of the cube map and the irradiance.
    pub(crate) radiance: &'a [BakeStage],
    /// Descriptor set 0: see [`compute::frame_set`].
    pub(crate) frame: &'a Arc<DescriptorSet>,
    /// `cube` lists them, all other passes read the list: ibl/small_lights/list.glsl.
    pub(crate) small_lights: &'a Arc<Buffer>,
}

impl Passes<'_> {
    /// The pipeline of one of the stages of the cube map and the irradiance.
    fn radiance_pipeline(&self, path: &str) -> Result<Arc<ComputePipeline>, GpuError> {
        let stage = self.radiance.iter().find(|stage| stage.stage.path.as_str() == path);
        let stage = stage.ok_or_else(|| GpuError::NoStage(path.to_owned()))?;
        self.set.compute(path, &stage.constants)
    }

    /// Binds the list of small lights for a pass that reads it.
    fn lit(&self, writer: SetWriter) -> SetWriter {
        writer.buffer(BINDING_SMALL_LIGHTS, self.small_lights)
    }

    /// Resamples the map to level 0, then each level from the level above. Leaves the cube in [`Use::Sampled`].
    /// `separates_suns`: takes suns out of the list of small lights.
    pub(crate) fn cube(
        &self,
        map: &Arc<Image>,
        cube: &Arc<Image>,
        radiance_scale: f32,
        separates_suns: bool,
    ) -> Result<(), GpuError> {
        let desc = *cube.desc();
        let sampler = compute::linear(self.gpu, vk::SamplerAddressMode::REPEAT)?;
        // At the center of a face, a texel of the cube spans 2 / side radians; the map has width / 2 pi texels per radian. At
        // least 2 x 2 samples: with one, the energy of a small light is off by 0.6 %.
        let finer = (map.desc().width as f32 / std::f32::consts::TAU * 2.0 / desc.width as f32).ceil().max(2.0);
        let first = Task {
            size: [desc.width; 2],
            levels: desc.mips,
            samples: (finer as u32).min(8),
            radiance_scale,
            separates_suns: separates_suns.into(),
            ..Task::default()
        };
        let bind = |task: &Task, more: &dyn Fn(SetWriter) -> SetWriter| {
            compute::bindings(self.gpu, self.layouts, task, |writer| {
                let writer = writer.storage_level(BINDING_TARGET, cube, task.level);
                more(writer.buffer(BINDING_RESULTS, self.small_lights))
            })
        };
        let mut dispatches = vec![(
            self.radiance_pipeline(CUBE)?,
            bind(&first, &|w| w.texture(BINDING_SOURCE, map, &sampler))?,
            desc.width,
        )];
        for level in 1..desc.mips {
            let side = (desc.width >> level).max(1);
            let task = Task { size: [side; 2], level, ..first };
            let set = bind(&task, &|writer| writer.storage_level(BINDING_LEVEL_ABOVE, cube, level - 1))?;
            dispatches.push((self.radiance_pipeline(DOWNSAMPLE)?, set, side));
        }
        one_shot(self.gpu, |encoder| {
            encoder.transition(cube, Use::Undefined, Use::Storage);
            for (pipeline, set, side) in &dispatches {
                encoder.dispatch(pipeline, &[self.frame, set], compute::groups(*side, desc.layers));
                encoder.transition(cube, Use::Storage, Use::Storage);
                encoder.computed();
            }
            encoder.transition(cube, Use::Storage, Use::Sampled);
            Ok(())
        })
    }

    /// Integrates the radiance of the cube over the hemisphere of each normal. Leaves both images in [`Use::Sampled`].
    pub(crate) fn irradiance(&self, cube: &Arc<Image>, texels: &Arc<Buffer>, to: &Arc<Image>) -> Result<(), GpuError> {
        let side = to.desc().width;
        let task = Task { size: [side; 2], levels: 1, ..Task::default() };
        let bindings = compute::bindings(self.gpu, self.layouts, &task, |writer| {
            let writer = writer.storage_level(BINDING_LEVEL_ABOVE, cube, IRRADIANCE_LEVEL);
            self.lit(writer.buffer(BINDING_PACKED, texels))
        })?;
        let pipeline = self.radiance_pipeline(IRRADIANCE)?;
        one_shot(self.gpu, |encoder| {
            encoder.transition(cube, Use::Sampled, Use::Storage);
            encoder.dispatch(&pipeline, &[self.frame, &bindings], compute::groups(side, to.desc().layers));
            encoder.transition(cube, Use::Storage, Use::Sampled);
            encoder.computed();
            transfer::fill_from(encoder, texels, to);
            Ok(())
        })
    }

    /// Generates the samples of every pair but the first, which is a mirror.
    pub(crate) fn lobes(&self, stage: &BakeStage, lobes: &Lobes<'_>, cube: &Arc<Image>) -> Result<(), GpuError> {
        let sampler = compute::linear(self.gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        let pipeline = self.set.compute(stage.stage.path.as_str(), &stage.constants)?;
        let mut dispatches = Vec::new();
        for ((level, samples), buffer) in (0..).zip(lobes.samples).zip(&lobes.buffers).skip(1) {
            let task = Task { size: [Lobes::CELLS, 1], level, samples: *samples, ..Task::default() };
            dispatches.push(compute::bindings(self.gpu, self.layouts, &task, |writer| {
                writer.texture(BINDING_SOURCE_CUBE, cube, &sampler).buffer(BINDING_LOBE_TARGET, buffer)
            })?);
        }
        one_shot(self.gpu, |encoder| {
            for bindings in &dispatches {
                encoder.dispatch(&pipeline, &[self.frame, bindings], [1, 1, 1]);
            }
            encoder.computed();
            Ok(())
        })
    }

    /// Prefilters `pairs` of levels of the specular lobe.
    pub(crate) fn specular(
        &self,
        stage: &BakeStage,
        cube: &Arc<Image>,
        lobes: &Lobes<'_>,
        texels: &Arc<Buffer>,
        pairs: Range<u32>,
    ) -> Result<(), GpuError> {
        let sampler = compute::linear(self.gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        let pipeline = self.set.compute(stage.stage.path.as_str(), &stage.constants)?;
        let mut dispatches = Vec::new();
        let all = (0..).zip(lobes.samples).zip(&lobes.buffers);
        for ((level, samples), buffer) in all.skip(pairs.start as usize).take(pairs.len()) {
            let side = specular_side(level);
            let task = Task { size: [side; 2], level, samples: *samples, ..Task::default() };
            let bindings = compute::bindings(self.gpu, self.layouts, &task, |writer| {
                let writer = writer.texture(BINDING_SOURCE_CUBE, cube, &sampler).buffer(BINDING_LOBE, buffer);
                self.lit(writer.buffer(BINDING_PACKED, texels))
            })?;
            dispatches.push((bindings, compute::groups(side, 1)));
        }
        one_shot(self.gpu, |encoder| {
            for (bindings, groups) in &dispatches {
                encoder.dispatch(&pipeline, &[self.frame, bindings], *groups);
            }
            encoder.computed();
            Ok(())
        })
    }

    /// Copies the texels of all levels to their image, and leaves it in [`Use::Sampled`]. Returns whether D or V returned invalid
    /// values for one of the pairs.
    pub(crate) fn finish_specular(
        &self,
        lobes: &Lobes<'_>,
        texels: &Arc<Buffer>,
        to: &Arc<Image>,
    ) -> Result<bool, GpuError> {
        one_shot(self.gpu, |encoder| {
            transfer::fill_from(encoder, texels, to);
            Ok(())
        })?;
        // The first word of a buffer, `wrong` in ibl/sampling/lobe.glsl. The mirror has no lobe.
        let flags: Vec<_> = lobes.buffers.iter().skip(1).map(|buffer| (buffer, 4)).collect();
        Ok(transfer::read(self.gpu, &[], &flags)?.iter().any(|byte| *byte != 0))
    }

    /// Prefilters all levels for sheen. Leaves the image in [`Use::Sampled`].
    pub(crate) fn sheen(
        &self,
        stage: &BakeStage,
        cube: &Arc<Image>,
        to: &Arc<Image>,
        samples: u32,
    ) -> Result<(), GpuError> {
        let desc = *to.desc();
        let sampler = compute::linear(self.gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        let pipeline = self.set.compute(stage.stage.path.as_str(), &stage.constants)?;
        let mut dispatches = Vec::new();
        for level in 0..desc.mips {
            let side = (desc.width >> level).max(1);
            let task = Task { size: [side; 2], level, levels: desc.mips, samples, ..Task::default() };
            let bindings = compute::bindings(self.gpu, self.layouts, &task, |writer| {
                let writer = writer.texture(BINDING_SOURCE_CUBE, cube, &sampler);
                self.lit(writer.storage_level(BINDING_TARGET, to, level))
            })?;
            dispatches.push((bindings, compute::groups(side, desc.layers)));
        }
        one_shot(self.gpu, |encoder| {
            encoder.transition(to, Use::Undefined, Use::Storage);
            for (bindings, groups) in &dispatches {
                encoder.dispatch(&pipeline, &[self.frame, bindings], *groups);
            }
            encoder.transition(to, Use::Storage, Use::Sampled);
            Ok(())
        })
    }
}
