//! The curves of one material under one light: its lobes, its albedo over the angle, and the white furnace.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{BrdfMeter, Grid, Lobe, Surface};
use crate::frame::stages::{HEMISPHERE_STAGE, MEASURE_STAGES, TABLE_STAGES};
use crate::gpu::{Gpu, GpuError};
use crate::settings::Settings;
use crate::shader::{Change, Compiler, Library, ShaderSet, Source, StageKind, TreePath, Update};

/// Angles of the eye in a plot of lobes, from -90 to 90 degrees. The lobe at the smallest roughness is half a degree wide.
const LOBE_COLUMNS: u32 = 721;
/// Angles from the normal in a plot of albedo, two degrees apart.
const ALBEDO_COLUMNS: u32 = 45;
/// The last of these angles, degrees.
const LAST_DEG: f32 = 88.0;
/// Samples of each albedo.
const ALBEDO_SAMPLES: u32 = 512;
/// Azimuths of the lobe in space.
const AZIMUTHS: u32 = 64;
/// Angles from the normal of the lobe in space.
const RINGS: u32 = 32;

/// A material under a light. Other properties have glTF's defaults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Linear RGB.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Angle between the normal and the direction to the light, degrees, 0..90.
    pub light_deg: f32,
}

/// Measured curves of a material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Lobes in the plane of incidence, as [`BrdfMeter::lobes`] returns them.
    pub lobes: Vec<Lobe>,
    /// Albedo, linear RGB: see [`Curves::angle_deg`].
    pub albedo: Vec<[f32; 3]>,
    /// The same with a base color of white: 1 means that all light is reflected.
    pub furnace: Vec<[f32; 3]>,
    /// f NoV over the hemisphere. `None` if the tree lacks the stage that measures it.
    pub hemisphere: Option<Hemisphere>,
}

/// f NoV over the hemisphere of directions to the eye, in 1/sr, linear RGB.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hemisphere {
    /// Azimuths of a ring, once around from the azimuth of the mirror direction.
    pub azimuths: usize,
    /// The values, ring by ring from the normal to the horizon.
    pub values: Vec<[f32; 3]>,
}

impl Curves {
    /// Measures a material. `prepared` comes from [`prepare`].
    ///
    /// # Errors
    /// A device error.
    pub fn measure(meter: &BrdfMeter, material: &Material) -> Result<Self, GpuError> {
        let Material { base_color, metallic, roughness, light_deg } = *material;
        let surface = Surface { base_color, metallic };
        let lobes = Grid {
            rows: 1,
            roughness: (roughness, roughness),
            columns: LOBE_COLUMNS,
            theta: (light_deg, 0.0),
            samples: 1,
        };
        let albedo = Grid { columns: ALBEDO_COLUMNS, theta: (0.0, LAST_DEG), samples: ALBEDO_SAMPLES, ..lobes };
        let sphere = Grid { rows: RINGS, columns: AZIMUTHS, ..lobes };
        let values = match meter.has(HEMISPHERE_STAGE) {
            true => Some(meter.run(HEMISPHERE_STAGE, surface, sphere)?),
            false => None,
        };
        Ok(Self {
            lobes: meter.lobes(surface, lobes)?,
            albedo: meter.furnace(surface, albedo)?,
            furnace: meter.furnace(Surface { base_color: [1.0; 3], metallic }, albedo)?,
            hemisphere: values.map(|values| Hemisphere { azimuths: AZIMUTHS as usize, values }),
        })
    }

    /// Angle of a value of albedo or furnace from the normal, degrees.
    pub fn angle_deg(index: usize) -> f32 {
        LAST_DEG * index as f32 / (ALBEDO_COLUMNS - 1) as f32
    }
}

/// Compiles what [`Curves::measure`] needs of the shaders `texts`, with the measuring stages and the rest of `tree`.
///
/// # Errors
/// Why there is nothing to measure: a stage that the tree lacks or that does not compile, or a device error.
pub fn prepare(
    gpu: &Arc<Gpu>,
    compiler: &Arc<Compiler>,
    tree: &Source,
    texts: &BTreeMap<TreePath, Arc<str>>,
    settings: &Settings,
) -> Result<BrdfMeter, String> {
    let measured = [&TABLE_STAGES[..], &[MEASURE_STAGES[0], MEASURE_STAGES[3]]].concat();
    let source = only_measuring(tree, texts);
    let has_hemisphere = source.read(&HEMISPHERE_STAGE.into()).is_ok();
    let stages: Vec<&str> = measured.into_iter().chain(has_hemisphere.then_some(HEMISPHERE_STAGE)).collect();
    if let Some(missing) = stages.iter().find(|stage| source.read(&TreePath::from(**stage)).is_err()) {
        return Err(format!(
            "the shader tree has no {missing}, which measures the BRDF; `specula new DIR` writes a tree with it"
        ));
    }
    // Stages compile on the shared thread pool, where an edit would have to wait for these.
    let own = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|error| error.to_string())?;
    let mut library = Library::of_part(source, compiler.clone(), &stages);
    let shaders: Arc<ShaderSet> = match own.install(|| library.update(&Change::All)) {
        Update::Ready(shaders, _) => shaders,
        Update::Failed(diagnostics, _) => {
            let first = diagnostics.first().map(|diagnostic| diagnostic.to_string()).unwrap_or_default();
            return Err(format!("the stages that measure the BRDF do not compile: {first}"));
        }
        Update::Unchanged { .. } => return Err("the stages that measure the BRDF were not compiled".into()),
    };
    BrdfMeter::new(gpu, &shaders, settings).map_err(|error| error.to_string())
}

/// The texts that the measuring stages may include. Other stages are left out, so that they are not compiled.
fn only_measuring(tree: &Source, texts: &BTreeMap<TreePath, Arc<str>>) -> Source {
    let is_used = |path: &TreePath| match StageKind::of(path) {
        Some(StageKind::Compute) => {
            let path = path.as_str();
            path.starts_with("measure/") || TABLE_STAGES.contains(&path)
        }
        Some(_) => false,
        None => path.extension() == Some("glsl"),
    };
    let files = tree.list().into_iter().filter(is_used);
    let mut files: BTreeMap<TreePath, String> =
        files.filter_map(|path| tree.read(&path).ok().map(|text| (path, text))).collect();
    let newest = texts.iter().filter(|(path, _)| is_used(path));
    files.extend(newest.map(|(path, text)| (path.clone(), text.to_string())));
    Source::of_texts(files)
}
