//! Which files the window watches. Absolute paths need the file system, which may not answer, so they are looked up only when a name
//! has changed.

use std::path::PathBuf;
use std::sync::Arc;

use crate::settings::Settings;

/// The names behind the list of watched files.
#[derive(Default)]
pub(in crate::app) struct WatchedFiles {
    environment: String,
    measured: String,
    model: Arc<[PathBuf]>,
    compared: Vec<PathBuf>,
}

impl WatchedFiles {
    /// The files to watch, if they may differ from those of the last call: of the `model`, of the `compared` picture, and those that
    /// `settings` name, whose paths `look_up` returns.
    pub(in crate::app) fn changed<'a>(
        &mut self,
        settings: &Settings,
        model: &Arc<[PathBuf]>,
        compared: impl Iterator<Item = &'a PathBuf> + Clone,
        look_up: impl FnOnce() -> Vec<PathBuf>,
    ) -> Option<Vec<PathBuf>> {
        let (environment, measured) = (&settings.environment.name, &settings.measured);
        if (&self.environment, &self.measured) == (environment, measured)
            && Arc::ptr_eq(&self.model, model)
            && self.compared.iter().eq(compared.clone())
        {
            return None;
        }
        *self = Self {
            environment: environment.clone(),
            measured: measured.clone(),
            model: model.clone(),
            compared: compared.cloned().collect(),
        };
        Some(model.iter().cloned().chain(look_up()).chain(self.compared.iter().cloned()).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_looked_up_only_when_a_name_has_changed() {
        let (mut watched, mut settings) = (WatchedFiles::default(), Settings::default());
        let model: Arc<[PathBuf]> = Arc::new([PathBuf::from("/duck.glb")]);
        let mut lookups = 0;
        let mut frame = |settings: &Settings, model: &Arc<[PathBuf]>, compared: &[PathBuf]| {
            let look_up = || {
                lookups += 1;
                vec![PathBuf::from("/sky.hdr")]
            };
            (watched.changed(settings, model, compared.iter(), look_up), lookups)
        };
        let paths = |names: &[&str]| Some(names.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(frame(&settings, &model, &[]), (paths(&["/duck.glb", "/sky.hdr"]), 1));
        settings.camera.fovy = 20.0;
        assert_eq!(frame(&settings, &model, &[]), (None, 1));
        settings.environment.name = "sky.hdr".into();
        assert_eq!(frame(&settings, &model, &[]), (paths(&["/duck.glb", "/sky.hdr"]), 2));
        assert_eq!(frame(&settings, &model, &["/a.png".into()]), (paths(&["/duck.glb", "/sky.hdr", "/a.png"]), 3));
        assert_eq!(frame(&settings, &model, &["/a.png".into()]), (None, 3));
        assert_eq!(frame(&settings, &Arc::default(), &["/a.png".into()]), (paths(&["/sky.hdr", "/a.png"]), 4));
        settings.measured = "gold.binary".into();
        assert_eq!(frame(&settings, &Arc::default(), &[]).1, 5);
    }
}
