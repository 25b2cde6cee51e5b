//! The model and the shader tree that the command line, or else the look, names.

use std::path::{Path, PathBuf};

use specula::file_kind::FileKind;
use specula::message;
use specula::scene::{self, LoadOptions, Model};
use specula::settings::{LightSource, Settings};
use specula::shader::Source;

use super::look::read_look;
use super::names::check_model_path;
use super::{Common, warn_once};
use crate::commands::Failure;

/// The models to show.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Models {
    /// glTF model: .gltf, .glb, a .zip or folder with one, or the name of a built-in one [default: shader-ball]
    pub model: Option<PathBuf>,
    /// More models, which stand beside the first
    #[arg(value_name = "MODEL")]
    added: Vec<PathBuf>,
}

impl Models {
    /// All of them.
    pub fn all(&self) -> Vec<PathBuf> {
        self.model.iter().chain(&self.added).cloned().collect()
    }
}

impl From<Option<PathBuf>> for Models {
    fn from(model: Option<PathBuf>) -> Self {
        Self { model, added: Vec::new() }
    }
}

impl Common {
    /// Leaves out of the settings what the look says about parts that the model lacks, with a warning for each kind.
    ///
    /// # Errors
    /// The look cannot be read.
    pub fn fit(&self, model: &Model, settings: &mut Settings) -> Result<(), Failure> {
        let Some(path) = self.look.as_deref() else { return Ok(()) };
        for problem in model.leave_out_lacking(&read_look(path)?.settings, settings) {
            warn_once(&format!("{}: {problem}. This part of the look is left out", path.display()));
        }
        Ok(())
    }

    /// Takes the models beside the first into the settings. Treats a shader file in the model's position as the shader tree, and a folder as the model in it. Options that the
    /// command line does not give come from the look.
    ///
    /// # Errors
    /// The folder has no model or several, the look cannot be read, or a file that it names is gone.
    pub fn take_files(&mut self, Models { model, added }: &mut Models) -> Result<(), Failure> {
        for path in std::mem::take(added) {
            check_model_path(Some(&path))?;
            self.added.push(path.display().to_string());
        }
        if self.shaders.is_none() && model.as_deref().is_some_and(|path| Source::is_file(path) && path.exists()) {
            self.shaders = model.take();
        }
        if let Some(folder) = model.as_deref().filter(|path| FileKind::of(path) == FileKind::Folder) {
            let found = scene::find_model(folder);
            *model = Some(found.map_err(|problem| Failure::Usage(format!("{} {problem}", folder.display())))?);
        }
        let Some(path) = self.look.as_deref() else { return Ok(()) };
        let look = read_look(path)?;
        if model.is_some() || !self.added.is_empty() {
            // Those of the look stood beside its own model.
            self.replaces_added = true;
        }
        let gone = |what: &str, file: &Path, option: &str| {
            let (path, file) = (path.display(), file.display());
            Err(Failure::Input(format!("{path}: its {what} {file} is not there; name it with {option}")))
        };
        match look.model {
            Some(file) if model.is_none() => {
                if !file.exists() && !scene::BUILT_IN.iter().any(|name| Path::new(name) == file) {
                    return gone("model", &file, "MODEL");
                }
                *model = Some(file);
                self.scene = self.scene.or(look.scene);
            }
            _ => {}
        }
        match look.shaders {
            Some(tree) if self.shaders.is_none() && !tree.exists() => return gone("shader tree", &tree, "`--shaders`"),
            Some(tree) if self.shaders.is_none() => self.shaders = Some(tree),
            _ => {}
        }
        Ok(())
    }

    /// The model at `path`, or the built-in shader ball. Prints the model's warnings.
    pub fn model(&self, path: Option<&Path>) -> Result<Model, Failure> {
        let model = self.model_silently(path)?;
        for warning in model.warnings.iter() {
            message::warn(format_args!("{}: {warning}", model.name));
        }
        Ok(model)
    }

    /// The same without the model's warnings. Only `--lights model` without lights is warned about.
    pub fn model_silently(&self, path: Option<&Path>) -> Result<Model, Failure> {
        check_model_path(path)?;
        let model = scene::open(path, &self.load_options()).map_err(|e| Failure::Input(e.to_string()))?;
        if let Some(scene) = self.scene.filter(|scene| *scene >= model.contents.scenes.len().max(1)) {
            let (name, scenes) = (&model.name, model.contents.scenes.len());
            return Err(Failure::Usage(format!("--scene {scene}: {name} has {scenes} scenes; the first is 0")));
        }
        let wants_its_lights =
            || self.settings_silently(Settings::default()).is_ok_and(|s| s.lights.source == LightSource::Model);
        if model.lights.is_empty() && wants_its_lights() {
            warn_once(&format!("{} has no lights of its own for `--lights model`", model.name));
        }
        Ok(model)
    }

    /// How models are loaded.
    pub fn load_options(&self) -> LoadOptions {
        let settings = self.settings_silently(Settings::default());
        let added = settings.map(|settings| settings.added_files()).unwrap_or_default();
        LoadOptions { allow_outside: self.allow_outside, scene: self.scene, added }
    }
}
