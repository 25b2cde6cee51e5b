//! Measures the BRDF of the user's shaders on the device: albedo, reciprocity, the integral of D, lobes.

mod curves;
mod furnace;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

pub use curves::{Curves, Hemisphere, Material, prepare};
pub use furnace::{Furnace, extremes};

use crate::frame::stages::MEASURE_STAGES;
use crate::frame::{BakeValues, PipelineRequest, TablesKey, TargetFormat};
use crate::gpu::{Buffer, DescriptorSet, Gpu, GpuError, Memory, SetLayouts, SetWriter, Specialization, one_shot, vk};
use crate::interface::{self, Task};
use crate::pipeline::PipelineSet;
use crate::render::{GpuEnvironment, PathTracing, SharedImages, Sources, Tables, Uniforms, compute, measured_buffer};
use crate::scene::LightGrid;
use crate::settings::Settings;
use crate::shader::{Constant, ShaderSet, values};

/// The measured surface. All other properties have glTF's defaults.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Linear RGB.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
}

/// Rows of roughness and columns of angles, in even steps from first to last, both included.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Number of roughness values.
    pub rows: u32,
    /// First and last roughness.
    pub roughness: (f32, f32),
    /// Number of angles.
    pub columns: u32,
    /// First and last angle to the normal, degrees.
    pub theta: (f32, f32),
    /// Samples in each cell.
    pub samples: u32,
}

impl Grid {
    /// Roughness of a row.
    pub fn roughness_of(&self, row: u32) -> f64 {
        step(self.roughness, row, self.rows)
    }

    /// Angle of a column, degrees.
    pub fn theta_of(&self, column: u32) -> f64 {
        step(self.theta, column, self.columns)
    }
}

/// A value of the grid, rounded to six decimals, since 0.05 as a float is 0.05000000074505806.
fn step((first, last): (f32, f32), index: u32, count: u32) -> f64 {
    let (first, last) = (f64::from(first), f64::from(last));
    let value = first + (last - first) * f64::from(index) / f64::from(count.max(2) - 1);
    (value * 1e6).round() / 1e6
}

/// A pair of directions, and the change of f when they are swapped.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Worst {
    /// |f(l, v) - f(v, l)| divided by their mean, in the worst channel; 1e30 if one of them is not finite.
    pub error: f32,
    /// Direction to the light; z is the normal.
    pub l: [f32; 3],
    /// Direction to the eye.
    pub v: [f32; 3],
}

/// f NoV of each lobe, in 1/sr, linear RGB: the intensity that leaves per unit area under an irradiance of 1.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Lobe {
    /// Diffuse.
    pub diffuse: [f32; 3],
    /// Specular, single scattering.
    pub specular: [f32; 3],
    /// Multiple scattering.
    pub multiple: [f32; 3],
}

/// A property that a choice guarantees, by its annotation: see brdf/models.glsl.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// A white surface reflects no more light than it receives.
    Conserves,
    /// f(l, v) = f(v, l)
    Reciprocal,
}

impl Claim {
    /// The choices of a constant that guarantee this property. `None` if the constant does not affect it.
    pub fn of(self, constant: &Constant) -> Option<&Vec<String>> {
        match self {
            Self::Conserves => constant.conserves.as_ref(),
            Self::Reciprocal => constant.reciprocal.as_ref(),
        }
    }
}

/// The author's constants by ascending id, each with its value in `settings`: the name of a choice, or a number.
pub fn choices<'a>(settings: &Settings, shaders: &'a ShaderSet) -> Vec<(&'a Constant, String)> {
    let chosen = values::constants(&settings.shader, &shaders.constants);
    let name = |constant: &Constant, bits: u32| {
        // Choices of an `int` may be negative.
        let is = |value: i64| value == i64::from(bits) || value == i64::from(bits.cast_signed());
        let found = constant.choices.iter().find(|(_, value)| is(*value));
        found.map_or_else(|| bits.to_string(), |(name, _)| name.clone())
    };
    shaders.constants.iter().zip(chosen).map(|(constant, (_, bits))| (constant, name(constant, bits))).collect()
}

/// The [`choices`] that do not guarantee `claim`. If there are none, the combination guarantees it.
pub fn unclaimed<'a>(claim: Claim, settings: &Settings, shaders: &'a ShaderSet) -> Vec<(&'a Constant, String)> {
    let lacks =
        |(constant, chosen): &(&Constant, String)| claim.of(constant).is_some_and(|names| !names.contains(chosen));
    choices(settings, shaders).into_iter().filter(lacks).collect()
}

/// Shared by all measurements of one shader set.
struct Shared {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    set: Arc<PipelineSet>,
    environment: Arc<GpuEnvironment>,
    measured: Arc<Buffer>,
    path_tracing: Arc<PathTracing>,
    images: SharedImages,
}

/// Measures one shader set with one choice of models.
pub struct BrdfMeter {
    shared: Arc<Shared>,
    constants: Specialization,
    frame: Arc<DescriptorSet>,
}

impl BrdfMeter {
    /// Prepares shaders with [`crate::frame::stages::all_stages`]. The author's constants and parameters come from `settings`.
    ///
    /// # Errors
    /// The driver rejects a stage, or no memory is left.
    pub fn new(gpu: &Arc<Gpu>, shaders: &Arc<ShaderSet>, settings: &Settings) -> Result<Self, GpuError> {
        let layouts = SetLayouts::new(gpu)?;
        let (set, _) =
            PipelineSet::new(gpu, &layouts, shaders.clone(), Arc::default(), &request(settings, shaders), None)?;
        let shared = Shared {
            gpu: gpu.clone(),
            layouts,
            set,
            environment: GpuEnvironment::uniform(gpu, [1.0; 3])?,
            measured: measured_buffer(gpu, None)?,
            path_tracing: PathTracing::empty(gpu)?,
            images: SharedImages::new(gpu)?,
        };
        Self::on(Arc::new(shared), settings)
    }

    /// [`BrdfMeter::new`] for the same shaders with other settings.
    ///
    /// # Errors
    /// As [`BrdfMeter::new`].
    pub fn with(&self, settings: &Settings) -> Result<Self, GpuError> {
        Self::on(self.shared.clone(), settings)
    }

    /// Whether the shaders have this stage.
    fn has(&self, stage: &str) -> bool {
        self.shared.set.shaders.stages.contains_key(stage)
    }

    fn on(shared: Arc<Shared>, settings: &Settings) -> Result<Self, GpuError> {
        let request = request(settings, &shared.set.shaders);
        shared.set.build(&request)?;
        let params: Arc<[u8]> = values::params(&settings.shader, &shared.set.shaders.parameters).into();
        let values = BakeValues { constants: &request.constants, params: &params };
        let tables = Tables::bake(&shared.set, &TablesKey::new(&shared.set.shaders, values), None)?;
        let (measured, path_tracing) = (shared.measured.clone(), shared.path_tracing.clone());
        let sources = Sources { environment: shared.environment.clone(), tables, measured, path_tracing };
        let mut uniforms = Uniforms::new(&shared.gpu)?;
        uniforms.write(&interface::Frame::default(), (&[], &LightGrid::default()), &params);
        let frame = uniforms.set(&shared.layouts, &sources, &shared.images)?;
        Ok(Self { shared, constants: request.constants, frame })
    }

    /// Albedo (linear RGB) of each cell, row by row.
    ///
    /// # Errors
    /// A device error.
    pub fn furnace(&self, surface: Surface, grid: Grid) -> Result<Vec<[f32; 3]>, GpuError> {
        self.run(MEASURE_STAGES[0], surface, grid)
    }

    /// The worst pair of directions of each cell. Columns only split the work; they do not stand for an angle.
    ///
    /// # Errors
    /// A device error.
    pub fn reciprocity(&self, surface: Surface, grid: Grid) -> Result<Vec<Worst>, GpuError> {
        self.run(MEASURE_STAGES[1], surface, grid)
    }

    /// The integral of D NoH for each roughness. Columns and angles of `grid` are ignored.
    ///
    /// # Errors
    /// A device error.
    pub fn normalization(&self, grid: Grid) -> Result<Vec<f32>, GpuError> {
        self.run(MEASURE_STAGES[2], Surface { base_color: [1.0; 3], metallic: 1.0 }, Grid { columns: 1, ..grid })
    }

    /// Lobes in the plane of incidence. The columns split -90 to 90 degrees evenly, with the eye at their centers; the light is
    /// at `grid.theta.0` degrees on the negative side.
    ///
    /// # Errors
    /// A device error.
    pub fn lobes(&self, surface: Surface, grid: Grid) -> Result<Vec<Lobe>, GpuError> {
        self.run(MEASURE_STAGES[3], surface, grid)
    }

    fn run<T: Pod>(&self, stage: &str, surface: Surface, grid: Grid) -> Result<Vec<T>, GpuError> {
        let Shared { gpu, layouts, set, .. } = &*self.shared;
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
        let results = Buffer::new(gpu, "results", size as u64, vk::BufferUsageFlags::STORAGE_BUFFER, Memory::Readback)?;
        let writer = |writer: SetWriter| writer.buffer(interface::BINDING_RESULTS, &results);
        let bindings = compute::bindings(gpu, layouts, &task, writer)?;
        let pipeline = set.compute(stage, &self.constants)?;
        let groups = [grid.columns.div_ceil(8), grid.rows.div_ceil(8), 1];
        one_shot(gpu, |encoder| {
            encoder.dispatch(&pipeline, &[&self.frame, &bindings], groups);
            encoder.computed();
            Ok(())
        })?;
        Ok(results.read().chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect())
    }
}

fn request(settings: &Settings, shaders: &ShaderSet) -> PipelineRequest {
    PipelineRequest::new(settings, shaders, None, TargetFormat::half(1))
}
