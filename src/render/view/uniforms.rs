//! Descriptor set 0. Each frame slot has its own, so that the CPU never writes what a frame in flight reads.

use std::sync::Arc;

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Image, Memory, Sampler, SamplerDesc, SetLayouts, SetWriter, vk,
};
use crate::interface::{self, Frame, Light};

use crate::render::brdf::ltc;
use crate::render::brdf::tables::Tables;
use crate::render::compute;
use crate::render::environment::maps::GpuEnvironment;
use crate::render::paths::PathTracing;

/// The resources in set 0 that change.
#[derive(Clone)]
pub(crate) struct Sources {
    pub(crate) environment: Arc<GpuEnvironment>,
    pub(crate) tables: Arc<Tables>,
    pub(crate) measured: Arc<Buffer>,
    pub(crate) path_tracing: Arc<PathTracing>,
}

impl Sources {
    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.environment, &other.environment)
            && Arc::ptr_eq(&self.tables, &other.tables)
            && Arc::ptr_eq(&self.measured, &other.measured)
            && Arc::ptr_eq(&self.path_tracing, &other.path_tracing)
    }
}

/// The resources in set 0 that never change.
pub(crate) struct SharedImages {
    /// Table of the rectangular lights.
    pub(crate) ltc: Arc<Image>,
    /// Trilinear, clamped.
    pub(crate) linear: Arc<Sampler>,
    /// Bilinear, clamped, without mip levels.
    pub(crate) flat: Arc<Sampler>,
}

impl SharedImages {
    pub(crate) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        let linear = compute::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        let flat = Sampler::new(gpu, &SamplerDesc::BILINEAR)?;
        Ok(Self { ltc: ltc::table(gpu)?, linear, flat })
    }
}

/// Buffers and set 0 of one frame slot.
pub(crate) struct Uniforms {
    frame: Arc<Buffer>,
    lights: Arc<Buffer>,
    params: Arc<Buffer>,
    set: Option<(Sources, Arc<DescriptorSet>)>,
}

impl Uniforms {
    pub(crate) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let frame = Buffer::new(gpu, "frame", size_of::<Frame>() as u64, uniform, Memory::Upload)?;
        let lights = Buffer::new(gpu, "lights", interface::LIGHT_BYTES as u64, uniform, Memory::Upload)?;
        let params = Buffer::new(gpu, "params", interface::PARAMS_SIZE.into(), uniform, Memory::Upload)?;
        Ok(Self { frame, lights, params, set: None })
    }

    /// Writes the buffers. SYNC: after the slot's fence.
    pub(crate) fn write(&self, frame: &Frame, lights: &[Light], params: &[u8]) {
        self.frame.write(0, bytemuck::bytes_of(frame));
        self.lights.write(0, bytemuck::cast_slice(lights));
        self.params.write(0, params);
    }

    /// The set with these sources. It is created again when one of them has been replaced.
    pub(crate) fn set(
        &mut self,
        layouts: &Arc<SetLayouts>,
        sources: &Sources,
        shared: &SharedImages,
    ) -> Result<Arc<DescriptorSet>, GpuError> {
        if let Some((_, set)) = self.set.as_ref().filter(|(made_of, _)| made_of.is_same(sources)) {
            return Ok(set.clone());
        }
        let Sources { environment, tables, measured, path_tracing } = sources;
        let scene = &path_tracing.scene;
        let writer = SetWriter::default()
            .buffer(0, &self.frame)
            .buffer(1, &self.lights)
            .buffer(2, &self.params)
            .texture(3, &environment.radiance.cube, &environment.sampler)
            .texture(4, &environment.prefiltered.levels, &shared.flat)
            .texture(5, &environment.sheen, &environment.sampler)
            .texture(6, &environment.radiance.irradiance, &shared.flat)
            .texture(7, &tables.dfg, &shared.flat)
            .texture(8, &shared.ltc, &shared.linear)
            .buffer(9, measured)
            .texture(10, &tables.sheen_albedo, &shared.linear)
            .texture(12, &tables.diffuse_albedo, &shared.flat)
            .texture(13, &tables.lamp_dfg, &shared.flat)
            .buffer(14, &scene.nodes)
            .buffer(15, &scene.triangles)
            .buffer(16, &scene.corners)
            .buffer(17, &scene.materials)
            .texture(18, &scene.textures, &scene.sampler)
            .buffer(19, &path_tracing.alias_table);
        let set = DescriptorSet::new(layouts, interface::SET_FRAME, writer)?;
        self.set = Some((sources.clone(), set.clone()));
        Ok(set)
    }
}
