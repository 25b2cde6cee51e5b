//! The BRDF as it stands in the user's shaders, measured on the device: albedo, reciprocity, the integral of D, its lobes.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Memory, SetLayouts, SetWriter, Specialization, one_shot, vk,
};
use crate::interface::{self, Task};
use crate::settings::Settings;
use crate::shader::ShaderSet;

use super::environment::Baked;
use super::ltc;
use super::measured::measured_buffer;
use super::pipelines::{MEASURE_STAGES, PipelineSet};
use super::task;
use super::uniforms::{Constants, Sources, Uniforms};
use super::values;
use super::wanted::Wanted;

/// What is measured, and over which grid.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Linear RGB.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
}

/// Rows of roughness and columns of angles, even steps, first and last included.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// How many values of roughness.
    pub rows: u32,
    /// First and last.
    pub roughness: (f32, f32),
    /// How many angles.
    pub columns: u32,
    /// First and last angle to the normal, degrees.
    pub theta: (f32, f32),
    /// Samples for each cell.
    pub samples: u32,
}

impl Grid {
    /// Roughness of a row.
    pub fn roughness_of(&self, row: u32) -> f32 {
        step(self.roughness, row, self.rows)
    }

    /// Angle of a column, degrees.
    pub fn theta_of(&self, column: u32) -> f32 {
        step(self.theta, column, self.columns)
    }
}

fn step((first, last): (f32, f32), index: u32, count: u32) -> f32 {
    first + (last - first) * index as f32 / (count.max(2) - 1) as f32
}

/// A pair of directions, and how much f differs when they change places.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Worst {
    /// |f(l, v) - f(v, l)| over their mean, the worst channel.
    pub error: f32,
    /// Towards the light; z is the normal.
    pub l: [f32; 3],
    /// Towards the eye.
    pub v: [f32; 3],
}

/// f NoL by lobe, 1/sr, linear RGB.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Lobe {
    /// Diffuse.
    pub diffuse: [f32; 3],
    /// Specular, single scattering.
    pub specular: [f32; 3],
    /// Multiple scattering.
    pub multiple: [f32; 3],
}

/// Measures with the stages of one shader set and one choice of models.
pub struct Bench {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    set: Arc<PipelineSet>,
    constants: Specialization,
    frame: Arc<DescriptorSet>,
}

impl Bench {
    /// For shaders that hold [`super::all_stages`], with the author's constants and parameters as `settings` have them.
    ///
    /// # Errors
    /// The device refuses a pipeline.
    pub fn new(gpu: &Arc<Gpu>, shaders: &Arc<ShaderSet>, settings: &Settings) -> Result<Self, GpuError> {
        let layouts = SetLayouts::new(gpu)?;
        let none = std::collections::BTreeSet::new();
        let half = vk::Format::R16G16B16A16_SFLOAT;
        let wanted = Wanted::new(settings, shaders, &none, 1, half, super::Renderer::OUTPUT_FORMAT);
        let set = PipelineSet::new(gpu, &layouts, shaders.clone(), &wanted, None)?;
        let tables = set.tables(&wanted).ok_or_else(|| GpuError::NoStage(super::tables::DFG.to_owned()))?;
        let linear = task::linear(gpu, vk::SamplerAddressMode::CLAMP_TO_EDGE)?;
        let constants = Constants { ltc: ltc::table(gpu)?, linear };
        let environment = Baked::uniform(gpu, [1.0; 3])?.environment;
        let sources = Sources { environment, tables, measured: measured_buffer(gpu, None)? };
        let mut uniforms = Uniforms::new(gpu, 0)?;
        let params = values::params(&settings.shader, &shaders.parameters);
        uniforms.write(&interface::Frame::default(), &[], &params);
        let frame = uniforms.set(&layouts, &sources, &constants)?;
        Ok(Self { gpu: gpu.clone(), layouts, set, constants: wanted.constants, frame })
    }

    /// Albedo (linear RGB) of each cell, row by row.
    ///
    /// # Errors
    /// The device.
    pub fn furnace(&self, surface: Surface, grid: Grid) -> Result<Vec<[f32; 3]>, GpuError> {
        self.run(MEASURE_STAGES[0], surface, grid)
    }

    /// The worst pair of directions of each cell; columns only share the work.
    ///
    /// # Errors
    /// The device.
    pub fn reciprocity(&self, surface: Surface, grid: Grid) -> Result<Vec<Worst>, GpuError> {
        self.run(MEASURE_STAGES[1], surface, grid)
    }

    /// Integral of D NoH for each roughness; one column.
    ///
    /// # Errors
    /// The device.
    pub fn normalization(&self, grid: Grid) -> Result<Vec<f32>, GpuError> {
        self.run(MEASURE_STAGES[2], Surface { base_color: [1.0; 3], metallic: 1.0 }, grid)
    }

    /// Lobes in the plane of incidence: columns run from -90 to 90 degrees; the eye is at `grid.theta.0` degrees on the
    /// negative side.
    ///
    /// # Errors
    /// The device.
    pub fn lobes(&self, surface: Surface, grid: Grid) -> Result<Vec<Lobe>, GpuError> {
        self.run(MEASURE_STAGES[3], surface, grid)
    }

    fn run<T: Pod>(&self, stage: &str, surface: Surface, grid: Grid) -> Result<Vec<T>, GpuError> {
        let task = Task {
            size: [grid.columns, grid.rows],
            samples: grid.samples,
            roughness_first: grid.roughness.0,
            roughness_last: grid.roughness.1,
            theta_first: grid.theta.0,
            theta_last: grid.theta.1,
            base_color: surface.base_color,
            metallic: surface.metallic,
            ..Task::default()
        };
        let size = (grid.columns * grid.rows) as usize * size_of::<T>();
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let results = Buffer::new(&self.gpu, "results", size as u64, usage, Memory::Readback)?;
        let writer = |writer: SetWriter| task::results(writer, &results);
        let bindings = task::bindings(&self.gpu, &self.layouts, &task, writer)?;
        let pipeline = self.set.compute(stage, &self.constants)?;
        let groups = [grid.columns.div_ceil(8), grid.rows.div_ceil(8), 1];
        one_shot(&self.gpu, |encoder| {
            encoder.dispatch(&self.layouts, &pipeline, &[&self.frame, &bindings], groups);
            encoder.computed();
            Ok(())
        })?;
        let bytes = results.read();
        Ok(bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect())
    }
}
