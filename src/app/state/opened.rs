//! The settings before files were opened that set them, so that a file that cannot be read changes none.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::settings::Settings;

/// Files whose settings are set, and that are still being read, with the settings before.
#[derive(Default)]
pub(in crate::app) struct Opened {
    pub(in crate::app) environment: Option<(String, Arc<Settings>)>,
    pub(in crate::app) measured: Option<(PathBuf, Arc<Settings>)>,
}

impl Opened {
    /// Takes an environment that was read, or that could not be: then the former one is set again.
    pub(in crate::app) fn end_environment(&mut self, name: &str, is_good: bool, settings: &mut Settings) {
        let opened = self.environment.take_if(|(opened, _)| opened == name);
        if let Some((_, before)) = opened.filter(|_| !is_good && settings.environment.name == name) {
            settings.environment.name.clone_from(&before.environment.name);
        }
    }

    /// The same of a measured BRDF, which also sets the mode.
    pub(in crate::app) fn end_measured(&mut self, path: &Path, is_good: bool, settings: &mut Settings) {
        let opened = self.measured.take_if(|(opened, _)| opened == path);
        if let Some((_, before)) = opened.filter(|_| !is_good && Path::new(&settings.measured) == path) {
            settings.measured.clone_from(&before.measured);
            if settings.mode == "measured" {
                settings.mode.clone_from(&before.mode);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_be_read_changes_no_setting() {
        let (before, mut now, mut opened) = (Settings::default(), Settings::default(), Opened::default());
        let open = |opened: &mut Opened, now: &mut Settings| {
            opened.measured = Some(("a.bin".into(), Arc::new(before.clone())));
            opened.environment = Some(("sky.hdr".into(), Arc::new(before.clone())));
            (now.measured, now.mode) = ("a.bin".into(), "measured".into());
            now.environment.name = "sky.hdr".into();
        };
        open(&mut opened, &mut now);
        opened.end_measured(Path::new("a.bin"), false, &mut now);
        opened.end_environment("sky.hdr", false, &mut now);
        assert_eq!(now, before);
        open(&mut opened, &mut now);
        opened.end_measured(Path::new("a.bin"), true, &mut now);
        opened.end_environment("sky.hdr", true, &mut now);
        // Files that are damaged later stay chosen: they may be repaired.
        opened.end_measured(Path::new("a.bin"), false, &mut now);
        opened.end_environment("sky.hdr", false, &mut now);
        assert_eq!((now.measured.as_str(), now.environment.name.as_str()), ("a.bin", "sky.hdr"));
    }
}
