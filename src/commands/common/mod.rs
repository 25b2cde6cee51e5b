//! The options that every command takes: settings, shader tree, model, device.

pub mod asserts;
pub mod chosen_modes;
mod files;
pub mod frames;
mod look;
pub mod names;
pub mod opened;
pub mod parse;
pub mod report;
pub mod unchecked;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use clap::ValueEnum;
use specula::gpu::{Gpu, GpuOptions, PipelineStore, watchdog};
use specula::message::{self, did_you_mean};
use specula::picture;
use specula::pipeline::DiskPipelines;
use specula::process_end::end_process;
use specula::settings::{AddedModel, LightSource, Settings, Tonemap};
use specula::shader::embedded::Example;
use specula::shader::{Compiler, Expression, ShaderSet, Source, expression, is_specula_tree};

use super::{Failure, limits};
pub use files::Models;
use look::read_look;
use names::check_environment;
use parse::{ev, fovy, size, vector};

/// Seconds after which a device that does not answer counts as hung.
pub const TIMEOUT_S: u32 = 60;

/// Options that are the same everywhere.
#[derive(clap::Args, Clone, Debug)]
pub struct Common {
    /// Shader tree: a folder, an example such as examples:fur, built-in for that of the program, or a shader written for Shadertoy or glslViewer [default: ./shaders or the working directory, if one is a Specula tree, else the built-in one]
    #[arg(long, value_name = "DIR|FILE")]
    pub shaders: Option<PathBuf>,
    /// Environment that lights the model: studio, sky, furnace, a .hdr or .exr file, model (the light of the model's file), or none [default: studio]
    #[arg(long, value_name = "NAME|FILE")]
    env: Option<String>,
    /// Measured BRDF (MERL or UTIA file) for the modes measured, measured-split and measured-error
    #[arg(long, value_name = "FILE")]
    measured: Option<PathBuf>,
    /// Lights to use
    #[arg(long, value_enum, ignore_case = true, value_name = "NAME")]
    lights: Option<LightSource>,
    /// Position of the camera in meters, such as 0,1,3 [default: the model is framed]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    eye: Option<[f32; 3]>,
    /// Point that the camera looks at, in meters
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    target: Option<[f32; 3]>,
    /// Vertical field of view in degrees, 1 to 170 [default: 35]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = fovy)]
    fovy: Option<f32>,
    /// Size of the picture in pixels [default: 1280x720; for a window, the size of the last one]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = size)]
    pub size: Option<(u32, u32)>,
    /// Look through a camera of the model's file: its name, or #0 for the first
    #[arg(long, value_name = "NAME|#N", conflicts_with_all = ["eye", "target", "fovy", "frame_model"])]
    camera: Option<String>,
    /// Play a clip of the model: its name, its number from 0, all or none; NAME:0.5 mixes it with those before it; may be repeated [default: the first]
    #[arg(long, value_name = "NAME|N")]
    animation: Vec<String>,
    /// Frame the whole model, from the side from which the look file's camera sees it
    #[arg(long, conflicts_with_all = ["eye", "target"])]
    frame_model: bool,
    /// Tone map
    #[arg(long, value_enum, ignore_case = true, value_name = "NAME")]
    tonemap: Option<Tonemap>,
    /// Exposure value (EV100), -30 to 30: exposure is 1 / (1.2 * 2^N), so +1 is half as bright. Exposure in the window is -N [default: 0.7]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = ev)]
    ev: Option<f32>,
    /// Background: none (transparent), env (the environment) or #rrggbb
    #[arg(long, value_name = "NAME|COLOR")]
    background: Option<String>,
    /// Memory limit for the images and buffers of passes, in MiB [default: 2048]
    #[arg(long, value_name = "MIB", allow_negative_numbers = true)]
    memory: Option<u32>,
    /// Debug mode to show; `specula modes` lists them
    #[arg(long, value_name = "NAME")]
    pub mode: Vec<String>,
    /// Show the value of a shader expression, such as brdf/ndf.glsl:20:a2, as the mode `expression`. FILE:LINE:COLUMN:NAME names one of several on a line
    #[arg(long, value_name = "FILE:LINE:NAME")]
    watch_expr: Option<String>,
    /// Change a setting, such as view.msaa=1, or a shader parameter, such as NDF=Beckmann; may be repeated. Colors are linear RGB. `specula help set` lists all
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Read settings from a look file: TOML, or a PNG that Specula has written, which also names the model and the shader tree. Other options override it
    #[arg(long, value_name = "FILE")]
    look: Option<PathBuf>,
    /// Use the device whose name contains this text; `specula info` lists the devices
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Print events to stdout as JSON, one object per line
    #[arg(long, value_enum, ignore_case = true, value_name = "FORMAT")]
    pub events: Option<EventFormat>,
    /// Show this scene of the model's file, from 0 [default: the file's own]
    #[arg(long, value_name = "N")]
    scene: Option<usize>,
    /// Allow a model to read files outside its own folder
    #[arg(long)]
    allow_outside: bool,
    /// Models beside the first.
    #[arg(skip)]
    added: Vec<String>,
    /// Whether these replace the models that a look adds.
    #[arg(skip)]
    replaces_added: bool,
    /// Turn on the Vulkan validation layers; any message fails the command
    #[arg(long)]
    pub validate: bool,
    /// Time limit of the device for a frame, a bake or a pipeline. After it, a command ends with exit code 3, and a window restarts without the newest edit
    #[arg(long, value_name = "SECONDS", default_value_t = TIMEOUT_S, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=86_400))]
    pub timeout: u32,
}

/// How events are printed.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum EventFormat {
    /// One JSON object per line.
    Json,
}

impl Common {
    /// The settings: defaults, then the look file, then options, then `--set` in order. Warns about options without effect.
    pub fn settings(&self) -> Result<Settings, Failure> {
        self.settings_over(Settings::default())
    }

    /// The same for a window, which begins with more in its picture.
    pub fn settings_of_window(&self) -> Result<Settings, Failure> {
        let mut first = Settings::of_window();
        let plain = |set: &String| set.replace([' ', '"', '\''], "");
        // Without an environment there is none to see.
        if self.env.as_deref() == Some("none") || self.set.iter().any(|set| plain(set) == "environment.name=none") {
            first.view.background = Settings::default().view.background;
        }
        self.settings_over(first)
    }

    /// The settings, with `first` in place of the defaults if there is no look file.
    fn settings_over(&self, first: Settings) -> Result<Settings, Failure> {
        let settings = self.settings_silently(first)?;
        warn_unmeasured(&settings.mode, &settings);
        let of_material = |set: &&String| {
            let path = set.split('=').next().unwrap_or_default().trim();
            path.starts_with("material.") && path != "material.enabled"
        };
        let material = &settings.material;
        let is_unused = !material.enabled && material.channels.is_empty();
        if let Some(set) = self.set.iter().find(of_material).filter(|_| is_unused) {
            warn_once(&format!("--set {set} changes nothing without --set material.enabled=true"));
        }
        Ok(settings)
    }

    /// Whether no option says which lights shine.
    pub fn leaves_lights_open(&self) -> bool {
        let is_source = |set: &String| set.trim_start().starts_with("lights.source");
        self.lights.is_none() && self.look.is_none() && !self.set.iter().any(is_source)
    }

    /// Whether no option says which environment lights the model.
    pub fn leaves_environment_open(&self) -> bool {
        let is_name = |set: &String| set.trim_start().starts_with("environment.name");
        self.env.is_none() && self.look.is_none() && !self.set.iter().any(is_name)
    }

    /// The same without the warnings.
    fn settings_silently(&self, first: Settings) -> Result<Settings, Failure> {
        let look = match self.look.as_deref() {
            Some(path) => read_look(path)?.settings,
            None => first,
        };
        let mut settings = look.clone();
        if self.replaces_added {
            settings.added.clear();
        }
        settings.added.extend(self.added.iter().map(|file| AddedModel::new(file)));
        let put = |to: &mut f32, from: Option<f32>| *to = from.unwrap_or(*to);
        let camera = &mut settings.camera;
        if self.frame_model {
            camera.frame_from_here();
        }
        if let Some(name) = &self.camera {
            camera.frame_model();
            camera.name.clone_from(name);
        }
        if self.eye.is_some() || self.target.is_some() || self.fovy.is_some() {
            camera.name.clear();
        }
        camera.eye = self.eye.or(camera.eye);
        camera.target = self.target.or(camera.target);
        put(&mut camera.fovy, self.fovy);
        put(&mut settings.view.ev, self.ev);
        settings.lights.source = self.lights.unwrap_or(settings.lights.source);
        settings.view.tonemap = self.tonemap.unwrap_or(settings.view.tonemap);
        if let Some(environment) = &self.env {
            settings.environment.name.clone_from(environment);
        }
        if let Some(measured) = &self.measured {
            settings.measured = measured.display().to_string();
        }
        if let Some(background) = &self.background {
            settings.view.background.clone_from(background);
        }
        if let Some(expression) = &self.watch_expr {
            Expression::parse(expression, 0).map_err(|error| Failure::Usage(format!("--watch-expr {error}")))?;
            settings.expression.at.clone_from(expression);
            settings.mode = expression::MODE.to_owned();
        }
        if !self.animation.is_empty() {
            settings.animation.clips.clone_from(&self.animation);
        }
        settings.view.pass_memory = self.memory.unwrap_or(settings.view.pass_memory);
        match self.mode.as_slice() {
            [] => {}
            [mode] => settings.mode.clone_from(mode),
            _ => return Err(Failure::Usage("--mode is given more than once; this command takes one mode".into())),
        }
        for assignment in &self.set {
            settings.assign(assignment).map_err(|e| Failure::Usage(format!("--set: {e}")))?;
        }
        settings.check().map_err(|problem| match &self.look {
            Some(path) if look.check().as_ref() == Err(&problem) => {
                Failure::Usage(format!("{}: {problem}", path.display()))
            }
            _ => Failure::Usage(problem),
        })?;
        check_environment(&settings.environment.name)?;
        Ok(settings)
    }

    /// Puts settings before those of the command line, which come on top.
    pub fn begin_with(&mut self, assignments: &[String]) {
        self.set.splice(0..0, assignments.iter().cloned());
    }

    /// Whether no option chooses what is shown. Size, device and the like do not.
    pub fn chooses_nothing(&self) -> bool {
        let options = [
            self.shaders.is_some(),
            self.env.is_some(),
            self.measured.is_some(),
            self.lights.is_some(),
            self.eye.is_some(),
            self.target.is_some(),
            self.fovy.is_some(),
            self.camera.is_some(),
            self.frame_model,
            !self.animation.is_empty(),
            self.tonemap.is_some(),
            self.ev.is_some(),
            self.background.is_some(),
            self.memory.is_some(),
            !self.mode.is_empty(),
            !self.set.is_empty(),
            self.look.is_some(),
            self.watch_expr.is_some(),
        ];
        !options.contains(&true)
    }

    /// The shader tree.
    pub fn source(&self) -> Result<Source, Failure> {
        source(self.shaders.as_deref())
    }

    /// Opens the device without a window.
    pub fn gpu(&self) -> Result<Arc<Gpu>, Failure> {
        open_gpu(self.device.as_deref(), self.validate, self.timeout, Some(&DiskPipelines))
    }

    /// The same without the pipelines of earlier runs, so that every pipeline takes the time that an edit takes.
    pub fn gpu_without_pipelines(&self) -> Result<Arc<Gpu>, Failure> {
        open_gpu(self.device.as_deref(), self.validate, self.timeout, None)
    }

    /// Whether events are printed.
    pub fn emits(&self) -> bool {
        self.events.is_some()
    }
}

/// Warns when a mode needs a measured BRDF and none is given.
pub fn warn_unmeasured(slug: &str, settings: &Settings) {
    if slug.starts_with("measured") && settings.measured.is_empty() {
        warn_once(&format!("mode {slug} shows nothing without --measured FILE"));
    }
}

/// Prints a warning the first time only, since settings and models may be read again and again.
fn warn_once(message: &str) {
    static TOLD: Mutex<Vec<String>> = Mutex::new(Vec::new());
    let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
    if !told.iter().any(|old| old == message) {
        message::warn(message);
        told.push(message.to_owned());
    }
}

/// The example of this name.
pub fn example(name: &str) -> Result<Example, Failure> {
    Example::named(name).ok_or_else(|| {
        let names = Example::names();
        let hint = did_you_mean(name, names.iter().copied());
        Failure::Input(format!("there is no example `{name}`.{hint} There are {}", names.join(", ")))
    })
}

pub use specula::shader::BUILT_IN;

/// The shader tree in a folder, [`BUILT_IN`], or the example NAME in `examples:NAME`. Without a folder, the tree in ./shaders or else the
/// built-in one.
pub fn source(directory: Option<&Path>) -> Result<Source, Failure> {
    if let Some(name) = directory.and_then(Path::to_str).and_then(|name| name.strip_prefix("examples:")) {
        return Ok(Source::example(Some(example(name)?)));
    }
    match directory {
        Some(name) if name == Path::new(BUILT_IN) => Ok(Source::embedded()),
        Some(directory) if is_specula_tree(directory) => open(directory),
        Some(file) if Source::is_file(file) && file.exists() => open(file),
        Some(directory) if !directory.exists() => Err(Failure::Input(format!(
            "{0}: there is no such folder. `specula new {0}` writes a shader tree there",
            directory.display()
        ))),
        Some(directory) => Err(Failure::Input(format!(
            "{} is not a Specula shader tree: expected a folder with interface.glsl. `specula new DIR` writes one",
            directory.display()
        ))),
        None => match ["shaders", "."].map(Path::new).into_iter().find(|folder| is_specula_tree(folder)) {
            Some(folder) => open(folder),
            None => Ok(Source::embedded()),
        },
    }
}

/// Opens the device whose name contains `name`, or the best one, without a window. If the device hangs, the process ends after
/// `timeout_s` seconds.
pub fn open_gpu(
    name: Option<&str>,
    validation: bool,
    timeout_s: u32,
    pipelines: Option<&'static dyn PipelineStore>,
) -> Result<Arc<Gpu>, Failure> {
    limits::check()?;
    watchdog::end_after(Duration::from_secs(timeout_s.into()), end_of_device);
    Ok(Gpu::new(&GpuOptions { device: name.map(str::to_owned), validation, display: None, pipelines })?)
}

/// Ends the process: every wait for the device, and every destructor that waits, would hang.
fn end_of_device(what: &str, limit: Duration) -> ! {
    message::tell(format_args!(
        "the graphics device has not finished {what} within {} s. A very long shader may need more time (`--timeout SECONDS`). \
         If the device hangs, as in an endless loop, other programs may hang too until it is reset",
        limit.as_secs()
    ));
    let _halt = picture::remove_unfinished();
    end_process(3);
}

/// Fails before any work when no picture can be written to `path`.
pub fn check_out(path: &Path) -> Result<(), Failure> {
    picture::check_ending(path).map_err(Failure::Usage)?;
    picture::check_path(path).map_err(Failure::Input)
}

/// The shader compiler.
pub fn compiler() -> Result<Arc<Compiler>, Failure> {
    Compiler::new().map(Arc::new).map_err(Failure::Input)
}

/// Fails when the shader tree has no such mode.
pub fn check_mode(shaders: &ShaderSet, slug: &str) -> Result<(), Failure> {
    let slugs = || shaders.modes.iter().map(|mode| mode.slug.as_str());
    if slugs().any(|known| known == slug) {
        return Ok(());
    }
    let is_step = |name: &str| shaders.graph.pass(name).is_some();
    if slug.strip_prefix("pass:").is_some_and(is_step) {
        let message = format!("the mode '{slug}' is the picture itself, to which that pass draws: use --mode final");
        return Err(Failure::Usage(message));
    }
    if slug.contains(',') {
        let message = format!(
            "'{slug}' is a list, but this shows one mode. `render --mode {slug} --out FILE.png` writes a file for each, \
             `render --sheet {slug}` one picture of all"
        );
        return Err(Failure::Usage(message));
    }
    let hint = did_you_mean(slug, slugs());
    Err(Failure::Usage(format!("there is no mode '{slug}'.{hint} `specula modes` lists them all")))
}

/// Fails when the validation layers reported a message.
pub fn check_validation(gpu: &Gpu) -> Result<(), Failure> {
    match gpu.validation_messages().len() {
        0 => Ok(()),
        1 => Err(Failure::Input("the validation layers reported a message (above)".into())),
        count => Err(Failure::Input(format!("the validation layers reported {count} messages (above)"))),
    }
}

fn open(path: &Path) -> Result<Source, Failure> {
    Source::find(path).map_err(Failure::Input)
}
