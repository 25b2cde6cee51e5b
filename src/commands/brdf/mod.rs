//! `specula brdf`: measures the BRDF of the shader tree, checks it against its claims, and plots it.

mod canvas;
mod furnace;
mod normalization;
mod plot;
mod plot_axes;
mod reciprocity;
mod split_sum;

use std::path::PathBuf;
use std::sync::Arc;

use clap::Subcommand;
use specula::gpu::Gpu;
use specula::render::brdf::measure::{Bench, Claim, Surface, unclaimed};
use specula::render::{all_stages, misfits, unknown_names};
use specula::settings::Settings;
use specula::shader::{Change, Constant, Library, ShaderSet, Update};

use super::Failure;
use super::common::{check_validation, compiler, open_gpu, source};

/// Options of `brdf`.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Albedo over roughness and angle: a white surface must not reflect more light than it receives
    Furnace(furnace::Args),
    /// Whether the BRDF is reciprocal: f(l, v) = f(v, l)
    Reciprocity(reciprocity::Args),
    /// Whether D is normalized: the integral of D NoH is 1
    Normalization(normalization::Args),
    /// Error of the split sum against Monte Carlo, over roughness
    SplitSum(split_sum::Args),
    /// Plot the lobes, and the albedo over the angle, as a PNG
    Plot(plot::Args),
}

/// Runs the command.
pub fn run(args: Args) -> Result<(), Failure> {
    match args.what {
        What::Furnace(args) => furnace::run(&args),
        What::Reciprocity(args) => reciprocity::run(&args),
        What::Normalization(args) => normalization::run(&args),
        What::SplitSum(args) => split_sum::run(&args),
        What::Plot(args) => plot::run(&args),
    }
}

/// Options of every measurement.
#[derive(clap::Args)]
struct Options {
    /// Shader tree [default: ./shaders if it is a Specula tree, else the built-in one]
    #[arg(long, value_name = "DIR")]
    shaders: Option<PathBuf>,
    /// Select a model or set a parameter of the shader tree, such as NDF=Beckmann; may be repeated
    #[arg(long = "set", value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Device whose name contains this
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Turn the Vulkan validation layers on; their messages fail the command
    #[arg(long)]
    validate: bool,
}

impl Options {
    /// The default settings with all `--set` assignments.
    fn settings(&self) -> Result<Settings, Failure> {
        let mut settings = Settings::default();
        for assignment in &self.set {
            settings.assign(assignment).map_err(|e| Failure::Input(format!("--set: {e}")))?;
        }
        let foreign = Settings { shader: Settings::default().shader, ..settings.clone() } != Settings::default();
        if foreign {
            let message = "--set: `specula brdf` takes only constants and parameters of the shader tree, such as \
                NDF=Beckmann; `specula modes` lists them";
            return Err(Failure::Input(message.into()));
        }
        Ok(settings)
    }
}

/// The surface to measure.
#[derive(clap::Args)]
struct SurfaceOptions {
    /// 0 dielectric .. 1 metal
    #[arg(long, value_name = "0..1", value_parser = unit)]
    metallic: Option<f32>,
    /// Linear RGB of the base color, each 0..1
    #[arg(long, value_name = "R,G,B", default_value = "1,1,1", value_parser = color)]
    base_color: [f32; 3],
}

impl SurfaceOptions {
    /// One surface with the requested metallic, or one for each of these values.
    fn surfaces(&self, metallic: &[f32]) -> Vec<Surface> {
        let chosen = self.metallic.map_or_else(|| metallic.to_vec(), |metallic| vec![metallic]);
        chosen.into_iter().map(|metallic| Surface { base_color: self.base_color, metallic }).collect()
    }
}

/// A compiled shader tree on a device.
struct Opened {
    gpu: Arc<Gpu>,
    shaders: Arc<ShaderSet>,
    settings: Settings,
    bench: Bench,
}

impl Opened {
    fn new(options: &Options) -> Result<Self, Failure> {
        let settings = options.settings()?;
        let mut library = Library::new(source(options.shaders.as_deref())?, compiler()?, &all_stages());
        let shaders = match library.update(&Change::All) {
            Update::Ready(shaders, _) => shaders,
            Update::Failed(diagnostics, _) => return Err(Failure::Shaders(diagnostics)),
            Update::Unchanged { .. } => return Err(Failure::Shaders(Vec::new())),
        };
        let misfit = misfits(&settings.shader, &shaders).into_iter().next();
        if let Some(message) = unknown_names(&settings.shader, &shaders).or(misfit) {
            return Err(Failure::Input(message));
        }
        let gpu = open_gpu(options.device.as_deref(), options.validate)?;
        let bench = Bench::new(&gpu, &shaders, &settings)?;
        Ok(Self { gpu, shaders, settings, bench })
    }

    fn unclaimed(&self, claim: Claim) -> Vec<(&Constant, String)> {
        unclaimed(claim, &self.settings, &self.shaders)
    }

    /// Destroys everything first, so that validation messages of destruction count too.
    fn close(self) -> Result<(), Failure> {
        let gpu = self.gpu.clone();
        drop(self);
        check_validation(&gpu)
    }
}

/// Choices as the user types them: `NDF=GGX, DIFFUSE=Burley`.
fn listed(choices: &[(&Constant, String)]) -> String {
    choices.iter().map(|(constant, chosen)| format!("{}={chosen}", constant.name)).collect::<Vec<_>>().join(", ")
}

/// Rounds for display: 0.3, not 0.30000001192092896.
fn short(numbers: [f32; 3]) -> [f64; 3] {
    numbers.map(|x| (f64::from(x) * 1e6).round() / 1e6)
}

/// A direction as text.
fn direction(v: [f32; 3]) -> String {
    let [x, y, z] = v.map(f64::from);
    format!(
        "{:.1} degrees from the normal, azimuth {:.1}",
        z.clamp(-1.0, 1.0).acos().to_degrees(),
        y.atan2(x).to_degrees()
    )
}

fn number(text: &str, low: f32, high: f32) -> Result<f32, String> {
    let number = text.trim().parse::<f32>().map_err(|_| format!("expected a number from {low} to {high}"))?;
    if (low..=high).contains(&number) { Ok(number) } else { Err(format!("it can be {low} to {high}")) }
}

fn unit(text: &str) -> Result<f32, String> {
    number(text, 0.0, 1.0)
}

fn color(text: &str) -> Result<[f32; 3], String> {
    let expected = |why: String| format!("expected three numbers, such as 1,0.8,0.6: {why}");
    let numbers = text.split(',').map(unit).collect::<Result<Vec<_>, _>>().map_err(expected)?;
    <[f32; 3]>::try_from(numbers).map_err(|found| expected(format!("found {}", found.len())))
}
