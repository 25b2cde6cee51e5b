//! The user's work: settings, model, the last good shaders, diagnostics. A session holds no device object, so it
//! survives the loss of the device.

mod recent;

use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::frame::{Clock, FrameInputs, FrameState, PipelineRequest, Revisions, Scene, TargetFormat};
use crate::message::did_you_mean;
use crate::scene::{Model, environment};
use crate::settings::Settings;
use crate::shader::values::{misfits, unknown_names};
use crate::shader::{Diagnostic, Mode, ShaderSet};
use recent::Recent;

/// Settings, model and shaders, from which every [`FrameState`] is made.
#[derive(Clone, Default)]
pub struct Session {
    /// The user's settings.
    pub settings: Settings,
    /// The last good shaders, once there are any.
    pub shaders: Option<Arc<ShaderSet>>,
    /// Errors of the newest edit, or warnings of the shaders in use.
    pub diagnostics: Vec<Diagnostic>,
    /// Revisions of the files that the settings name.
    pub revisions: Revisions,
    model: Option<Arc<Model>>,
    /// The last scene, kept because a scene of a large model takes time to create.
    scene: RefCell<Option<Scene>>,
    /// The time of the last frame, seconds.
    time_s: Cell<f32>,
    recent: RefCell<Recent>,
}

impl Session {
    /// A session without a model and shaders.
    pub fn new(settings: Settings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// The model, once there is one.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.model.as_ref()
    }

    /// The model at the place that the settings give it, in the pose of the last frame.
    pub fn placed_model(&self) -> Option<Arc<Model>> {
        self.scene().map(|scene| scene.model().clone())
    }

    /// Replaces the model.
    pub fn set_model(&mut self, model: &Arc<Model>) {
        self.model = Some(model.clone());
        // Its pictures would keep the old model.
        self.recent.take();
    }

    /// The settings as they are now, shared: the same `Arc` as long as they stay the same, so that its address tells whether they
    /// have changed.
    pub fn shared_settings(&self) -> Arc<Settings> {
        self.recent.borrow_mut().settings.shared(&self.settings)
    }

    /// The selected debug mode; `None` if the shaders lack it.
    pub fn mode(&self) -> Option<&Mode> {
        self.shaders.as_ref()?.modes.iter().find(|mode| mode.slug == self.settings.mode)
    }

    /// The model with the selected variant, materials and transform, in the pose of the last frame.
    pub fn scene(&self) -> Option<Scene> {
        let model = self.model.as_ref()?;
        let mut last = self.scene.borrow_mut();
        let scene = Scene::update(last.as_ref(), model, &self.settings, self.time_s.get());
        *last = Some(scene.clone());
        Some(scene)
    }

    /// `FEATURE_*` bits of the materials in use and of the light. `None` without a model.
    pub fn features(&self) -> Option<u32> {
        let hook = self.shaders.as_ref().map_or(0, |shaders| shaders.hook_features());
        self.scene().map(|scene| scene.features(&self.settings) | hook)
    }

    /// The pipelines that the settings need from `shaders`.
    pub fn pipelines(&self, shaders: &ShaderSet, target: TargetFormat) -> PipelineRequest {
        let request = PipelineRequest::new(&self.settings, shaders, self.scene().as_ref(), target);
        request.for_suns(self.revisions.suns_of(&self.settings))
    }

    /// The frame that the settings describe; `None` without shaders.
    pub fn frame_state(&self, clock: Clock, size: (u32, u32), target: TargetFormat) -> Option<Arc<FrameState>> {
        self.shaders.as_ref().map(|shaders| self.frame_state_of(shaders, clock, size, target))
    }

    /// The frame that the settings describe with these shaders: the same object as long as nothing has changed.
    pub fn frame_state_of(
        &self,
        shaders: &Arc<ShaderSet>,
        clock: Clock,
        size: (u32, u32),
        target: TargetFormat,
    ) -> Arc<FrameState> {
        self.time_s.set(clock.time_s);
        let (settings, scene) = (self.shared_settings(), self.scene());
        let inputs = FrameInputs { settings: &settings, ..self.inputs(shaders, scene.as_ref(), clock, size, target) };
        self.recent.borrow_mut().pictures.state(&settings, &inputs)
    }

    /// The inputs of a frame with these settings and shaders. `scene`: [`Session::scene`].
    pub fn inputs<'a>(
        &'a self,
        shaders: &'a Arc<ShaderSet>,
        scene: Option<&'a Scene>,
        clock: Clock,
        size: (u32, u32),
        target: TargetFormat,
    ) -> FrameInputs<'a> {
        FrameInputs { settings: &self.settings, shaders, scene, revisions: self.revisions, clock, size, target }
    }

    /// The absolute path of the environment's file; empty for a built-in environment.
    pub fn environment_files(&self) -> Vec<PathBuf> {
        let name = self.settings.environment.name.as_str();
        let is_file = !environment::is_word_of_specula(name)
            || (environment::BUILT_IN.contains(&name) && Path::new(name).is_file());
        is_file.then(|| std::path::absolute(name).ok()).flatten().into_iter().collect()
    }

    /// The absolute path of the measured BRDF's file; empty without a measured BRDF.
    pub fn measured_files(&self) -> Vec<PathBuf> {
        let path = &self.settings.measured;
        std::path::absolute(path).ok().filter(|_| !path.is_empty()).into_iter().collect()
    }

    /// Describes each setting that does not fit the shaders or the model in a sentence. With `names`, it also reports
    /// unknown names; otherwise they are accepted, because the next edit may declare them.
    pub fn problems(&self, names: bool) -> Vec<String> {
        let Some(shaders) = &self.shaders else { return Vec::new() };
        let mut problems = misfits(&self.settings.shader, shaders);
        if names {
            problems.extend(unknown_names(&self.settings.shader, shaders));
            problems.extend(unknown_pass(&self.settings, shaders));
        }
        let variant = self.model.as_ref().and_then(|model| model.variant(&self.settings.variant).err());
        problems.extend(variant);
        if let Some(model) = self.model.as_ref().filter(|model| !model.instances.is_empty()) {
            problems.extend(model.unknown_part(&self.settings.scene));
            problems.extend(model.unknown_material(self.settings.materials.keys()));
            problems.extend(model.unknown_camera(&self.settings.camera));
            problems.extend(model.unknown_clip(&self.settings.animation));
            problems.extend(model.unknown_target(&self.settings.animation));
        }
        problems
    }
}

/// A message about the first switch of a pass that the tree does not declare.
fn unknown_pass(settings: &Settings, shaders: &ShaderSet) -> Option<String> {
    let known: Vec<&str> =
        shaders.graph.passes.iter().filter(|pass| pass.has_switch()).map(|pass| pass.name()).collect();
    let unknown = settings.passes.keys().find(|name| !known.contains(&name.as_str()))?;
    if shaders.graph.pass(unknown).is_some() {
        return Some(format!("passes.{unknown}: this pass is a step of every picture, so it has no switch"));
    }
    let hint = did_you_mean(unknown, known.iter().copied());
    let list = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
    Some(format!("passes.{unknown}: no pass is named `{unknown}`.{hint} Passes: {list}"))
}
