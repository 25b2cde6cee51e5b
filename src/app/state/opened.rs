//! The settings before files were opened that set them, so that a file that cannot be read changes none.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::settings::Settings;

/// Files whose settings are set, and that are still being read, with the settings before.
#[derive(Default)]
pub(in crate::app) struct Opened {
    environment: Option<(String, Arc<Settings>)>,
    measured: Option<(PathBuf, Arc<Settings>)>,
}

impl Opened {
    /// Notes the files that `now` names and `before` does not. `is_shown`: whether the picture shows `before`. If it does not, a file of
    /// `before` may be missing, too, and the settings before that file count. Returns whether there are such files.
    pub(in crate::app) fn begin(&mut self, before: &Arc<Settings>, now: &Settings, is_shown: bool) -> bool {
        if now.environment.name != before.environment.name {
            let earlier = self.environment.take().filter(|(name, _)| !is_shown && *name == before.environment.name);
            let before = earlier.map_or_else(|| before.clone(), |(_, earlier)| earlier);
            self.environment = Some((now.environment.name.clone(), before));
        }
        if now.measured != before.measured {
            let earlier = self.measured.take().filter(|(path, _)| !is_shown && *path == Path::new(&before.measured));
            let before = earlier.map_or_else(|| before.clone(), |(_, earlier)| earlier);
            self.measured = Some((now.measured.clone().into(), before));
        }
        now.environment.name != before.environment.name || now.measured != before.measured
    }

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
            (now.measured, now.mode) = ("a.bin".into(), "measured".into());
            now.environment.name = "sky.hdr".into();
            opened.begin(&Arc::new(before.clone()), now, true);
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

    #[test]
    fn two_files_that_cannot_be_read_lead_back_to_the_last_that_could() {
        let (good, mut first, mut opened) = (Settings::default(), Settings::default(), Opened::default());
        first.environment.name = "no.hdr".into();
        let mut second = first.clone();
        second.environment.name = "nor.hdr".into();
        opened.begin(&Arc::new(good.clone()), &first, true);
        opened.begin(&Arc::new(first), &second, false);
        opened.end_environment("no.hdr", false, &mut second);
        assert_eq!(second.environment.name, "nor.hdr");
        opened.end_environment("nor.hdr", false, &mut second);
        assert_eq!(second, good);
    }
}
