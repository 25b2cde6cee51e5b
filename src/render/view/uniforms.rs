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
use crate::scene::LightGrid;

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

const LIGHTS: &str = "lights";
const LIGHT_GRID: &str = "light grid";

fn storage(gpu: &Arc<Gpu>, name: &str, bytes: u64) -> Result<Arc<Buffer>, GpuError> {
    Buffer::new(gpu, name, bytes, vk::BufferUsageFlags::STORAGE_BUFFER, Memory::Upload)
}

/// Buffers and set 0 of one frame slot.
pub(crate) struct Uniforms {
    gpu: Arc<Gpu>,
    frame: Arc<Buffer>,
    few_lights: Arc<Buffer>,
    lights: Arc<Buffer>,
    light_grid: Arc<Buffer>,
    params: Arc<Buffer>,
    set: Option<(Sources, Arc<DescriptorSet>)>,
}

impl Uniforms {
    pub(crate) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let frame = Buffer::new(gpu, "frame", size_of::<Frame>() as u64, uniform, Memory::Upload)?;
        let few = interface::FEW_LIGHT_BYTES as u64;
        let few_lights = Buffer::new(gpu, "few lights", few, uniform, Memory::Upload)?;
        let lights = storage(gpu, LIGHTS, few)?;
        let light_grid = storage(gpu, LIGHT_GRID, 1024)?;
        let params = Buffer::new(gpu, "params", interface::PARAMS_SIZE.into(), uniform, Memory::Upload)?;
        Ok(Self { gpu: gpu.clone(), frame, few_lights, lights, light_grid, params, set: None })
    }

    /// Makes room for the lights of a frame. Called before [`Self::set`], after the slot's fence.
    pub(crate) fn reserve(&mut self, light_bytes: usize, grid_bytes: usize) -> Result<(), GpuError> {
        for (buffer, name, bytes) in
            [(&mut self.lights, LIGHTS, light_bytes), (&mut self.light_grid, LIGHT_GRID, grid_bytes)]
        {
            if buffer.size() < bytes as u64 {
                *buffer = storage(&self.gpu, name, (bytes as u64).next_power_of_two())?;
                self.set = None;
            }
        }
        Ok(())
    }

    /// Writes the buffers. SYNC: after the slot's fence.
    pub(crate) fn write(&self, frame: &Frame, (lights, grid): (&[Light], &LightGrid), params: &[u8]) {
        self.frame.write(0, bytemuck::bytes_of(frame));
        let lights = bytemuck::cast_slice(lights);
        // Of many lights, shaders read none here.
        self.few_lights.write(0, lights);
        self.lights.write(0, lights);
        self.light_grid.write(0, grid.bytes());
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
            .buffer(interface::BINDING_FRAME, &self.frame)
            .buffer(interface::BINDING_FEW_LIGHTS, &self.few_lights)
            .buffer(interface::BINDING_LIGHTS, &self.lights)
            .buffer(interface::BINDING_LIGHT_GRID, &self.light_grid)
            .buffer(interface::BINDING_PARAMS, &self.params)
            .texture(interface::BINDING_ENVIRONMENT, &environment.radiance.cube, &environment.sampler)
            .texture(interface::BINDING_PREFILTERED, &environment.prefiltered.levels, &shared.flat)
            .texture(interface::BINDING_PREFILTERED_SHEEN, &environment.sheen, &environment.sampler)
            .texture(interface::BINDING_IRRADIANCE, &environment.radiance.irradiance, &shared.flat)
            .texture(interface::BINDING_DFG, &tables.dfg, &shared.flat)
            .texture(interface::BINDING_LTC, &shared.ltc, &shared.linear)
            .buffer(interface::BINDING_MEASURED, measured)
            .texture(interface::BINDING_SHEEN_ALBEDO, &tables.sheen_albedo, &shared.linear)
            .texture(interface::BINDING_DIFFUSE_ALBEDO, &tables.diffuse_albedo, &shared.flat)
            .texture(interface::BINDING_LAMP_DFG, &tables.lamp_dfg, &shared.flat)
            .buffer(interface::BINDING_BVH, &scene.nodes)
            .buffer(interface::BINDING_TRACED_TRIANGLES, &scene.triangles)
            .buffer(interface::BINDING_TRACED_CORNERS, &scene.corners)
            .buffer(interface::BINDING_TRACED_MATERIALS, &scene.materials)
            .texture(interface::BINDING_TRACED_TEXTURES, &scene.textures, &scene.sampler)
            .buffer(interface::BINDING_ENVIRONMENT_CELLS, &path_tracing.alias_table);
        let set = DescriptorSet::new(layouts, interface::SET_FRAME, writer)?;
        self.set = Some((sources.clone(), set.clone()));
        Ok(set)
    }
}
