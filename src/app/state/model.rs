//! The model on screen, and the one that is being loaded.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::settings::AddedModel;

/// Files and state of the model on screen and of a model that is loading.
#[derive(Default)]
pub(in crate::app) struct ModelStatus {
    /// The file on screen; `None` is a built-in model.
    pub(in crate::app) path: Option<PathBuf>,
    /// `LoadOptions::scene` of the model on screen.
    pub(in crate::app) scene: Option<usize>,
    /// The file that was requested last.
    pub(in crate::app) requested: Option<PathBuf>,
    /// The watched files: those of the model on screen, and after a failed load also those that it tried.
    pub(in crate::app) files: Arc<[PathBuf]>,
    pub(in crate::app) loading: bool,
    /// Number of the load from which the model on screen still awaits its textures.
    pub(in crate::app) awaits: Option<u64>,
    /// The models beside the one that is being loaded, which the settings get with it. `None`: those of the settings.
    pub(in crate::app) added: Option<Vec<AddedModel>>,
    pub(in crate::app) load_ms: f64,
    /// Why there is no model: the first one could not be loaded.
    pub(in crate::app) failure: Option<String>,
    /// Whether the warnings of the model are shown over the picture.
    pub(in crate::app) shows_warnings: bool,
    /// Whether the camera keeps its position when another model finishes loading.
    pub(in crate::app) keeps_camera: bool,
}

impl ModelStatus {
    /// Whether the model that was opened by this path is on screen.
    pub(in crate::app) fn is_file(&self, path: &Path) -> bool {
        self.path.as_deref() == Some(path)
    }

    /// Whether this file is on screen.
    pub(in crate::app) fn is_open(&self, path: &Path) -> bool {
        let shown = self.path.as_ref().and_then(|path| std::path::absolute(path).ok());
        shown.is_some_and(|shown| shown == path)
    }
}
