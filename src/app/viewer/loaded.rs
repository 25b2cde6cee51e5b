//! Shows the model that the loader has read, and reads changed files again.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::Viewer;
use crate::app::command::Command;
use crate::app::state::recent::Kind;
use crate::app::state::selection::Selected;
use crate::message;
use crate::scene::BUILT_IN;
use crate::settings::{LightSource, SceneSettings};
use crate::threads::Loaded;

impl Viewer {
    pub(super) fn on_loaded(&mut self, loaded: Loaded) {
        if !self.threads.loader.is_newest(loaded.number) {
            return;
        }
        self.model.loading = false;
        match loaded.result {
            Ok(uploaded) => {
                // The pictures of older versions would keep the old model on the device.
                self.generations.drop_pictures();
                self.forget_second_picture();
                let (model, is_other) = (uploaded.model(), loaded.path != self.model.path);
                for warning in &model.warnings {
                    message::warn(format_args!("{}: {warning}", model.name));
                }
                if self.session.settings.lights.source == LightSource::Model && model.lights.is_empty() {
                    self.say(format!("warning: {} has no lights of its own for `--lights model`", model.name));
                }
                // A session that is restored brings its own settings.
                let is_restored = std::mem::take(&mut self.model.keeps_camera);
                if is_other && !is_restored {
                    self.execute(Command::FrameModel);
                    // They name parts of the model before.
                    self.session.settings.scene = SceneSettings::default();
                    self.session.settings.materials.clear();
                }
                let keeps_selection = |before| !is_other && self.selected.is_same(before, model);
                if !self.session.model().is_some_and(|before| keeps_selection(before)) {
                    self.select(Selected::Nothing);
                }
                if !is_restored && (is_other || self.session.model().is_none()) {
                    self.follow_lights(model);
                }
                self.model.shows_warnings = true;
                if let Some(path) = loaded.path.as_deref().filter(|path| !is_built_in(path)) {
                    self.recent.remember(Kind::Model, path);
                }
                self.model.path = loaded.path;
                self.model.load_ms = loaded.ms;
                self.model.files = model.files.as_slice().into();
                self.session.set_model(model);
                self.resources.set_model(&uploaded);
                let settings = &self.session.settings;
                let unknown = model.unknown_part(&settings.scene);
                let unknown = unknown.or_else(|| model.unknown_material(settings.materials.keys()));
                unknown.into_iter().for_each(|problem| self.say(problem));
            }
            Err((message, tried)) => {
                self.model.keeps_camera = false;
                // Watch the model on screen as well as the files that must be repaired.
                let on_screen = self.session.model().map(|model| model.files.clone()).unwrap_or_default();
                self.model.files = on_screen.into_iter().chain(tried).collect();
                if let Some(path) = &loaded.path {
                    self.recent.forget(Kind::Model, path);
                }
                self.model_failed(&message);
                self.say(message);
            }
        }
        self.watch_files();
    }

    /// Handles changed files of the environment, the measured BRDF or the model.
    pub(super) fn on_files_changed(&mut self, changed: &BTreeSet<PathBuf>) {
        let (environment, measured) = (self.session.environment_files(), self.session.measured_files());
        let is_changed = |files: &[PathBuf]| files.iter().any(|file| changed.contains(file));
        if is_changed(&environment) {
            self.session.revisions.environment += 1;
        }
        if is_changed(&measured) {
            self.session.revisions.measured += 1;
        }
        self.on_picture_changed(changed);
        if is_changed(&self.model.files) {
            let on_screen = self.session.model().is_some_and(|model| is_changed(&model.files));
            let path = if on_screen && !self.model.loading { &self.model.path } else { &self.model.requested };
            self.load_model(path.clone());
        }
    }
}

/// Whether a path is the name of a built-in model.
fn is_built_in(path: &Path) -> bool {
    BUILT_IN.iter().any(|name| Path::new(name) == path)
}
