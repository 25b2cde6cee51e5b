//! The document's model: loading, loading again when a file of it changes, and what is watched meanwhile.

use std::collections::BTreeSet;
use std::path::PathBuf;

use winit::event_loop::EventLoopProxy;

use crate::scene::LoadOptions;
use crate::shader::{Batch, Watcher};

use super::Message;
use super::document::Document;
use super::loader::{self, Loaded, Reading};

impl Document {
    /// Loads a model; the old one stays until it is ready.
    pub(super) fn load_model(&mut self, path: Option<PathBuf>) {
        let options = LoadOptions { allow_outside: self.allow_outside };
        self.requested = path.clone();
        self.take_model(loader::read(path, options));
    }

    /// Takes a model that is being read.
    pub(super) fn take_model(&mut self, reading: Reading) {
        self.ticket += 1;
        self.loading = true;
        self.loaders.retain(|loader| !loader.is_finished());
        self.loaders.push(loader::upload(&self.gpu, &self.layouts, &self.proxy, reading, self.ticket));
    }

    /// Files of the model or the environment have changed, or files of one that could not be loaded.
    pub(super) fn files_changed(&mut self, changed: &BTreeSet<PathBuf>) {
        if self.environment_changed(changed) && changed.len() == 1 {
            return;
        }
        let of_model = self.model.files.iter().any(|file| changed.contains(file));
        let path = if of_model && !self.loading { self.model_path.clone() } else { self.requested.clone() };
        self.load_model(path);
    }

    pub(super) fn on_loaded(&mut self, loaded: Loaded) {
        if loaded.ticket != self.ticket {
            return;
        }
        self.loading = false;
        match loaded.result {
            Ok((model, scene)) => {
                for warning in &model.warnings {
                    eprintln!("specula: warning: {}: {warning}", model.name);
                }
                self.load_ms = loaded.ms;
                if loaded.path != self.model_path {
                    self.settings.camera.eye = None;
                    self.settings.camera.target = None;
                }
                self.model_path = loaded.path;
                self.model_files.clone_from(&model.files);
                self.watch_files();
                self.next_scene = Some((model, scene));
            }
            Err((message, tried)) => {
                // The model on screen stays watched, and so is what must be repaired.
                self.model_files = self.model.files.iter().cloned().chain(tried).collect();
                self.watch_files();
                self.say(message);
            }
        }
    }

    /// Watches the files of model and environment in place of those before.
    pub(super) fn watch_files(&mut self) {
        let environment = self.surroundings.files(&self.settings.environment.name);
        let files: Vec<PathBuf> = self.model_files.iter().cloned().chain(environment).collect();
        match &self.model_watcher {
            Some(watcher) => watcher.set_files(&files),
            None => match watch(&files, &self.proxy) {
                Ok(watcher) => self.model_watcher = watcher,
                Err(message) => self.say(message),
            },
        }
    }
}

/// Watches a model's files, if there are any.
pub(super) fn watch(files: &[PathBuf], proxy: &EventLoopProxy<Message>) -> Result<Option<Watcher>, String> {
    if files.is_empty() {
        return Ok(None);
    }
    let proxy = proxy.clone();
    let on_batch = move |batch: Batch| {
        let _ = proxy.send_event(Message::FilesChanged(batch.paths));
    };
    Watcher::new(None, files, on_batch).map(Some).map_err(|e| e.to_string())
}
