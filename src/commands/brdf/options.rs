//! Options that the measurements share, and what they open with them.

use std::path::PathBuf;
use std::sync::Arc;

use specula::frame::stages::all_stages;
use specula::gpu::Gpu;
use specula::measure::{BrdfMeter, Claim, Surface, choices, unclaimed};
use specula::report::Report;
use specula::settings::Settings;
use specula::shader::values::{misfits, unknown_names};
use specula::shader::{Change, Constant, Library, ShaderSet, Update};

use crate::commands::Failure;
use crate::commands::common::parse::number;
use crate::commands::common::report::{check_report, write_report};
use crate::commands::common::{TIMEOUT_S, check_validation, compiler, open_gpu, source};

/// Options of every measurement.
#[derive(clap::Args)]
pub(super) struct Options {
    /// Shader tree [default: ./shaders or the working directory, if one is a Specula tree, else the built-in one]
    #[arg(long, value_name = "DIR")]
    pub(super) shaders: Option<PathBuf>,
    /// Set a constant or parameter of the shader tree, such as NDF=Beckmann; may be repeated. `specula modes` lists them
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub(super) set: Vec<String>,
    /// Write a page of HTML with charts of the result
    #[arg(long, value_name = "FILE.html")]
    pub(super) report: Option<PathBuf>,
    /// Use the device whose name contains this text; `specula info` lists the devices
    #[arg(long, value_name = "NAME")]
    pub(super) device: Option<String>,
    /// Turn on the Vulkan validation layers; any message fails the command
    #[arg(long)]
    pub(super) validate: bool,
}

impl Options {
    /// The default settings with the values of `--set`.
    pub(super) fn settings(&self) -> Result<Settings, Failure> {
        let mut settings = Settings::default();
        for assignment in &self.set {
            settings.assign(assignment).map_err(|e| Failure::Usage(format!("--set: {e}")))?;
        }
        let foreign = Settings { shader: Settings::default().shader, ..settings.clone() } != Settings::default();
        if foreign {
            let message = "--set: `specula brdf` takes only constants and parameters of the shader tree, as NDF=Beckmann; \
                `specula modes` lists them";
            return Err(Failure::Usage(message.into()));
        }
        Ok(settings)
    }
}

/// The surface that is measured.
#[derive(clap::Args)]
pub(super) struct SurfaceOptions {
    /// Metallic of the surface, 0 (dielectric) to 1 (metal)
    #[arg(long, value_name = "0..1", allow_negative_numbers = true, value_parser = unit)]
    pub(super) metallic: Option<f32>,
    /// Base color of the surface: linear RGB, each 0 to 1
    #[arg(long, value_name = "R,G,B", default_value = "1,1,1", allow_hyphen_values = true, value_parser = color)]
    pub(super) base_color: [f32; 3],
}

impl SurfaceOptions {
    /// A surface with the chosen metallic, or else one with each of these.
    pub(super) fn surfaces(&self, metallic: &[f32]) -> Vec<Surface> {
        let chosen = self.metallic.map_or_else(|| metallic.to_vec(), |metallic| vec![metallic]);
        chosen.into_iter().map(|metallic| Surface { base_color: self.base_color, metallic }).collect()
    }
}

/// A compiled shader tree on a device.
pub(super) struct Opened {
    pub(super) gpu: Arc<Gpu>,
    pub(super) shaders: Arc<ShaderSet>,
    pub(super) settings: Settings,
    pub(super) meter: BrdfMeter,
}

impl Opened {
    pub(super) fn new(options: &Options) -> Result<Self, Failure> {
        options.report.as_deref().map_or(Ok(()), check_report)?;
        let settings = options.settings()?;
        let mut library = Library::new(source(options.shaders.as_deref())?, compiler()?, &all_stages());
        let shaders = match library.update(&Change::All) {
            Update::Ready(shaders, _) => shaders,
            Update::Failed(diagnostics, _) => return Err(Failure::Shaders(diagnostics)),
            Update::Unchanged { .. } => return Err(Failure::Shaders(Vec::new())),
        };
        let misfit = misfits(&settings.shader, &shaders).into_iter().next();
        if let Some(message) = unknown_names(&settings.shader, &shaders).or(misfit) {
            return Err(Failure::Usage(message));
        }
        let gpu = open_gpu(options.device.as_deref(), options.validate, TIMEOUT_S, None)?;
        let meter = BrdfMeter::new(&gpu, &shaders, &settings)?;
        Ok(Self { gpu, shaders, settings, meter })
    }

    pub(super) fn unclaimed(&self, claim: Claim) -> Vec<(&Constant, String)> {
        unclaimed(claim, &self.settings, &self.shaders)
    }

    /// Writes the page of `--report`, with the choices of the tree at its end. `fill`: adds the result.
    pub(super) fn report(&self, options: &Options, title: &str, fill: impl FnOnce(&mut Report)) -> Result<(), Failure> {
        let Some(path) = &options.report else { return Ok(()) };
        let mut report = Report::new(title);
        fill(&mut report);
        let choices = choices(&self.settings, &self.shaders);
        let rows: Vec<Vec<String>> =
            choices.into_iter().map(|(constant, chosen)| vec![constant.label.clone(), chosen]).collect();
        report.table("Choices of the shader tree", &["choice", "value"], &rows);
        write_report(path, &report)
    }

    /// Destroys everything, and fails if the validation layers reported a message then or before.
    pub(super) fn close(self) -> Result<(), Failure> {
        let gpu = self.gpu.clone();
        drop(self);
        check_validation(&gpu)
    }
}

/// Choices in the form of `--set`: `NDF=GGX, DIFFUSE=Burley`.
pub(super) fn listed(choices: &[(&Constant, String)]) -> String {
    choices.iter().map(|(constant, chosen)| format!("{}={chosen}", constant.name)).collect::<Vec<_>>().join(", ")
}

/// A surface in words.
pub(super) fn title(surface: Surface) -> String {
    let kind = match surface.metallic {
        0.0 => "Dielectric".to_owned(),
        1.0 => "Metal".to_owned(),
        metallic => format!("Metallic {metallic}"),
    };
    let [r, g, b] = short(surface.base_color);
    format!("{kind}, base color {r} {g} {b}")
}

/// Rounds floats to six digits after the point, so that 0.3 is not printed as 0.30000001192092896.
pub(super) fn short(numbers: [f32; 3]) -> [f64; 3] {
    numbers.map(|x| (f64::from(x) * 1e6).round() / 1e6)
}

/// A direction as angles.
pub(super) fn direction(v: [f32; 3]) -> String {
    let [x, y, z] = v.map(f64::from);
    format!(
        "{:.1} degrees from the normal, azimuth {:.1}",
        z.clamp(-1.0, 1.0).acos().to_degrees(),
        y.atan2(x).to_degrees()
    )
}

pub(super) fn unit(text: &str) -> Result<f32, String> {
    number(text, 0.0, 1.0)
}

pub(super) fn color(text: &str) -> Result<[f32; 3], String> {
    let expected = |found: String| format!("expected three numbers, each 0 to 1, as 1,0.8,0.6; found {found}");
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| unit(number).ok()).collect();
    let numbers = numbers.ok_or_else(|| expected(text.to_owned()))?;
    <[f32; 3]>::try_from(numbers).map_err(|numbers| expected(numbers.len().to_string()))
}
