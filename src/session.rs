//! What the user works on: settings, model, the last good shaders, diagnostics. Knows no device, so that it survives the loss of
//! one.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::render::{FrameInputs, FrameState, PipelineRequest, Revisions, Scene, TargetFormat};
use crate::scene::{Model, environment};
use crate::settings::Settings;
use crate::shader::values::{misfits, unknown_names};
use crate::shader::{Diagnostic, Mode, ShaderSet};

/// Settings, model and shaders, from which every [`FrameState`] is made.
#[derive(Clone, Default)]
pub struct Session {
    /// What the user set.
    pub settings: Settings,
    /// The last good shaders; `None` before the first.
    pub shaders: Option<Arc<ShaderSet>>,
    /// What is wrong with the shader tree: errors of the newest edit, or warnings of the shaders in use.
    pub diagnostics: Vec<Diagnostic>,
    /// How often the files behind the settings have changed.
    pub revisions: Revisions,
    model: Option<Arc<Model>>,
    /// The last scene: making one of a large model takes a while.
    scene: RefCell<Option<Scene>>,
}

impl Session {
    /// A session without model and shaders.
    pub fn new(settings: Settings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// The model, once there is one.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.model.as_ref()
    }

    /// Replaces the model.
    pub fn set_model(&mut self, model: &Arc<Model>) {
        self.model = Some(model.clone());
    }

    /// The debug mode of the settings as the shaders describe it; `None` if they lack it.
    pub fn mode(&self) -> Option<&Mode> {
        self.shaders.as_ref()?.modes.iter().find(|mode| mode.slug == self.settings.mode)
    }

    /// The model as the settings show it.
    pub fn scene(&self) -> Option<Scene> {
        let model = self.model.as_ref()?;
        let mut last = self.scene.borrow_mut();
        let scene = Scene::update(last.as_ref(), model, &self.settings);
        *last = Some(scene.clone());
        Some(scene)
    }

    /// The pipelines that the settings need from `shaders`.
    pub fn pipelines(&self, shaders: &ShaderSet, target: TargetFormat) -> PipelineRequest {
        PipelineRequest::new(&self.settings, shaders, self.scene().as_ref(), target)
    }

    /// The picture that the settings ask for; `None` without shaders.
    pub fn frame_state(&self, time_s: f32, size: (u32, u32), target: TargetFormat) -> Option<FrameState> {
        Some(FrameState::new(&FrameInputs {
            settings: &self.settings,
            shaders: self.shaders.as_ref()?,
            scene: self.scene().as_ref(),
            revisions: self.revisions,
            time_s,
            size,
            target,
        }))
    }

    /// The file of the environment, absolute; none for a built-in one.
    pub fn environment_files(&self) -> Vec<PathBuf> {
        let name = self.settings.environment.name.as_str();
        let is_file = name != "none" && (!environment::BUILT_IN.contains(&name) || Path::new(name).is_file());
        is_file.then(|| std::path::absolute(name).ok()).flatten().into_iter().collect()
    }

    /// The file of the measured BRDF, absolute; none without one.
    pub fn measured_files(&self) -> Vec<PathBuf> {
        let path = &self.settings.measured;
        std::path::absolute(path).ok().filter(|_| !path.is_empty()).into_iter().collect()
    }

    /// What in the settings does not fit the shaders or the model, one sentence each. `names`: unknown names count, too;
    /// without, they are kept silently, because the next edit may declare them.
    pub fn problems(&self, names: bool) -> Vec<String> {
        let Some(shaders) = &self.shaders else { return Vec::new() };
        let mut problems = misfits(&self.settings.shader, shaders);
        if names {
            problems.extend(unknown_names(&self.settings.shader, shaders));
        }
        let variant = self.model.as_ref().and_then(|model| model.variant(&self.settings.variant).err());
        problems.extend(variant);
        problems
    }
}
