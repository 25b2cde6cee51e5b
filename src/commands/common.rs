//! The options that every command takes, and what they come to.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use clap::ValueEnum;
use specula::gpu::{Gpu, GpuOptions};
use specula::scene::{self, BUILT_IN, LoadOptions, Model};
use specula::settings::{LightSource, Settings, Tonemap};
use specula::shader::{Compiler, ShaderSet, Source, is_specula_tree};

use super::Failure;

/// Options that are the same everywhere.
#[derive(clap::Args, Clone, Debug)]
pub struct Common {
    /// Shader tree [default: ./shaders when it is Specula's, else the built-in one]
    #[arg(long, value_name = "DIR")]
    pub shaders: Option<PathBuf>,
    /// Light from all around: studio, sky, furnace, a .hdr or .exr file, or none [default: studio]
    #[arg(long, value_name = "WHAT")]
    env: Option<String>,
    /// File of a measured BRDF (MERL or UTIA) for the modes measured, measured-split and measured-error
    #[arg(long, value_name = "FILE")]
    measured: Option<PathBuf>,
    /// Which lights shine
    #[arg(long, value_enum)]
    lights: Option<LightSource>,
    /// Camera position in meters, as 0,1,3 [default: the model is framed]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    eye: Option<[f32; 3]>,
    /// Point the camera looks at
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    target: Option<[f32; 3]>,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEG")]
    fovy: Option<f32>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: (u32, u32),
    /// Tone map
    #[arg(long, value_enum)]
    tonemap: Option<Tonemap>,
    /// Exposure value (EV100): exposure is 1 / (1.2 * 2^N)
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    ev: Option<f32>,
    /// Behind the model: none (transparent), env or #rrggbb
    #[arg(long, value_name = "WHAT")]
    background: Option<String>,
    /// Debug mode; `specula modes` lists them
    #[arg(long, value_name = "NAME")]
    pub mode: Vec<String>,
    /// Set anything, as view.msaa=1 or a shader parameter's name=value; may repeat
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Look file (TOML) with settings to start from
    #[arg(long, value_name = "FILE.toml")]
    look: Option<PathBuf>,
    /// Device whose name contains this
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Print what happens as JSON lines on stdout
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub events: Option<EventFormat>,
    /// Let a model read files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
    /// Turn the Vulkan validation layers on; their messages fail the command
    #[arg(long)]
    pub validate: bool,
}

/// How events are printed.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum EventFormat {
    /// One JSON object a line.
    Json,
}

impl Common {
    /// The settings: defaults, then the look file, then options, then `--set` in order. Warns of those that change nothing.
    pub fn settings(&self) -> Result<Settings, Failure> {
        let settings = self.settings_silently()?;
        warn_unmeasured(&settings.mode, &settings);
        let of_material = |set: &&String| {
            let path = set.split('=').next().unwrap_or_default().trim();
            path.starts_with("material.") && path != "material.enabled"
        };
        if let Some(set) = self.set.iter().find(of_material).filter(|_| !settings.material.enabled) {
            warn_once(&format!("--set {set} changes nothing without --set material.enabled=true"));
        }
        Ok(settings)
    }

    /// The same without the warnings.
    fn settings_silently(&self) -> Result<Settings, Failure> {
        let mut settings = match &self.look {
            None => Settings::default(),
            Some(path) => {
                let text = std::fs::read_to_string(path)
                    .map_err(|e| Failure::Input(format!("{}: cannot read the look file: {e}", path.display())))?;
                Settings::from_toml(&text).map_err(|e| Failure::Input(format!("{}: {e}", path.display())))?
            }
        };
        let put = |to: &mut f32, from: Option<f32>| *to = from.unwrap_or(*to);
        settings.camera.eye = self.eye.or(settings.camera.eye);
        settings.camera.target = self.target.or(settings.camera.target);
        put(&mut settings.camera.fovy, self.fovy);
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
        match self.mode.as_slice() {
            [] => {}
            [mode] => settings.mode.clone_from(mode),
            _ => return Err(Failure::Input("--mode is given more than once; here it takes one mode".into())),
        }
        for assignment in &self.set {
            settings.assign(assignment).map_err(|e| Failure::Input(format!("--set: {e}")))?;
        }
        settings.check().map_err(Failure::Input)?;
        Ok(settings)
    }

    /// The shader tree.
    pub fn source(&self) -> Result<Source, Failure> {
        source(self.shaders.as_deref())
    }

    /// The model at `path`, or the built-in shader ball; prints its warnings.
    pub fn model(&self, path: Option<&Path>) -> Result<Model, Failure> {
        let model = self.model_silently(path)?;
        for warning in &model.warnings {
            eprintln!("specula: warning: {}: {warning}", model.name);
        }
        Ok(model)
    }

    /// The same without printing its warnings, but for that of `--lights model`.
    pub fn model_silently(&self, path: Option<&Path>) -> Result<Model, Failure> {
        check_model_path(path)?;
        let loaded = scene::open(path, &LoadOptions { allow_outside: self.allow_outside });
        let model = loaded.map_err(|e| Failure::Input(e.to_string()))?;
        let wants_its_lights = || self.settings_silently().is_ok_and(|s| s.lights.source == LightSource::Model);
        if model.lights.is_empty() && wants_its_lights() {
            warn_once(&format!("{} has no lights of its own for `--lights model`", model.name));
        }
        Ok(model)
    }

    /// Opens the device without a window.
    pub fn gpu(&self) -> Result<Arc<Gpu>, Failure> {
        open_gpu(self.device.as_deref(), self.validate)
    }

    /// Whether events are printed.
    pub fn emits(&self) -> bool {
        self.events.is_some()
    }
}

/// Warns of a mode that needs a measured BRDF when there is none.
pub fn warn_unmeasured(slug: &str, settings: &Settings) {
    if slug.starts_with("measured") && settings.measured.is_empty() {
        warn_once(&format!("mode {slug} shows nothing without --measured FILE"));
    }
}

/// Prints a warning, but never twice: settings and models may be read again and again.
fn warn_once(message: &str) {
    static TOLD: Mutex<Vec<String>> = Mutex::new(Vec::new());
    let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
    if !told.iter().any(|old| old == message) {
        eprintln!("specula: warning: {message}");
        told.push(message.to_owned());
    }
}

/// The shader tree in a folder; without one the tree in ./shaders, or the built-in one.
pub fn source(directory: Option<&Path>) -> Result<Source, Failure> {
    match directory {
        Some(directory) if is_specula_tree(directory) => disk(directory),
        Some(directory) => Err(Failure::Input(format!(
            "{} is no Specula shader tree: it has no interface.glsl. `specula new {}` writes one",
            directory.display(),
            directory.display()
        ))),
        None if is_specula_tree(Path::new("shaders")) => disk(Path::new("shaders")),
        None => Ok(Source::embedded()),
    }
}

/// Opens the device whose name contains `name`, or the best one, without a window.
pub fn open_gpu(name: Option<&str>, validation: bool) -> Result<Arc<Gpu>, Failure> {
    Ok(Gpu::new(&GpuOptions { device: name.map(str::to_owned), validation, display: None })?)
}

/// Fails when there is neither such a file nor a built-in model of that name.
pub fn check_model_path(path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path.filter(|path| !path.exists()) else { return Ok(()) };
    let name = path.to_string_lossy();
    if BUILT_IN.contains(&&*name) {
        return Ok(());
    }
    let hint = closest(&name, BUILT_IN.into_iter()).map(|c| format!(" Did you mean {c}?")).unwrap_or_default();
    let list = BUILT_IN.join(", ");
    Err(Failure::Input(format!("{name}: there is no such file, and the built-in models are {list}.{hint}")))
}

/// The shader compiler.
pub fn compiler() -> Result<Arc<Compiler>, Failure> {
    Compiler::new().map(Arc::new).map_err(Failure::Input)
}

/// Fails when the tree has no such mode, and names the closest.
pub fn check_mode(shaders: &ShaderSet, slug: &str) -> Result<(), Failure> {
    if shaders.modes.iter().any(|m| m.slug == slug) {
        return Ok(());
    }
    let hint = match closest(slug, shaders.modes.iter().map(|m| m.slug.as_str())) {
        Some(close) => format!(" Did you mean {close}?"),
        None => String::new(),
    };
    Err(Failure::Input(format!("there is no mode '{slug}'.{hint} `specula modes` lists them all")))
}

/// The candidate that is most like what was typed, if one is.
fn closest<'a>(typed: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |candidate: &str| strsim::normalized_damerau_levenshtein(typed, candidate);
    let best = candidates.max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) > 0.4).then_some(best)
}

/// Fails when the validation layers said something.
pub fn check_validation(gpu: &Gpu) -> Result<(), Failure> {
    match gpu.validation_messages().len() {
        0 => Ok(()),
        count => Err(Failure::Input(format!("the validation layers reported {count} messages (above)"))),
    }
}

fn disk(directory: &Path) -> Result<Source, Failure> {
    let absolute = std::path::absolute(directory);
    absolute.map(Source::Disk).map_err(|e| Failure::Input(format!("{}: {e}", directory.display())))
}

fn vector(text: &str) -> Result<[f32; 3], String> {
    let numbers: Vec<f32> = text.split(',').map_while(|t| t.trim().parse().ok()).collect();
    let vector = <[f32; 3]>::try_from(numbers).map_err(|_| "expected three numbers, as 0,1.5,3".to_owned())?;
    if vector.iter().all(|v| v.is_finite()) { Ok(vector) } else { Err("the numbers must be finite".into()) }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match parts {
        Some((width, height)) if width > 0 && height > 0 => Ok((width, height)),
        _ => Err("expected width x height in pixels, each at least 1, as 1280x720".into()),
    }
}
