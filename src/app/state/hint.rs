//! The hint of the first start: which folder to edit. Once dismissed it does not come back. The first save that reaches the picture
//! dismisses it, too.

use std::path::{Path, PathBuf};

use crate::events::ReloadEvent;
use crate::state_folder;

const FILE: &str = "hint.json";
/// The content of the file once the hint is dismissed.
const DISMISSED: &str = "{\"dismissed\": true}";

/// Whether the hint is shown, and what it offers.
#[derive(Default)]
pub(in crate::app) struct Hint {
    is_shown: bool,
    /// The folder to which its button writes the built-in shaders.
    pub(in crate::app) folder: PathBuf,
}

impl Hint {
    pub(in crate::app) fn restored() -> Self {
        Self { is_shown: state_folder::load(FILE).is_none(), folder: standard_folder(Path::new("")) }
    }

    #[cfg(test)]
    pub(in crate::app) fn of_first_start() -> Self {
        Self { is_shown: true, folder: "shaders".into() }
    }

    pub(in crate::app) fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// Hides it in this run.
    pub(in crate::app) fn hide(&mut self) {
        self.is_shown = false;
    }

    /// Hides it permanently.
    pub(in crate::app) fn dismiss(&mut self) {
        self.is_shown = false;
        state_folder::save(FILE, DISMISSED);
    }

    /// Dismisses the hint once a save of the user's own files has changed the picture: the hint has been followed.
    pub(in crate::app) fn saved(&mut self, reload: &ReloadEvent) {
        if self.is_shown && reaches_picture(reload) {
            self.dismiss();
        }
    }
}

/// Whether changed files were compiled and are on screen. The first compilation of a tree has no changed files.
fn reaches_picture(reload: &ReloadEvent) -> bool {
    reload.ok && !reload.changed.is_empty() && !reload.stages.is_empty()
}

/// `shaders`, which the next start without `--shaders` opens, or another name if that is taken.
fn standard_folder(working: &Path) -> PathBuf {
    let is_free = |name: &&str| {
        let entries = std::fs::read_dir(working.join(name));
        entries.map_or(!working.join(name).exists(), |mut entries| entries.next().is_none())
    };
    ["shaders", "specula-shaders", "specula-shaders-2"].into_iter().find(is_free).unwrap_or("specula-shaders-3").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_with_files_is_left_alone() {
        let working = tempfile::tempdir().unwrap();
        let standard = || standard_folder(working.path());
        assert_eq!(standard(), Path::new("shaders"));
        std::fs::create_dir(working.path().join("shaders")).unwrap();
        assert_eq!(standard(), Path::new("shaders"), "an empty folder may be used");
        std::fs::write(working.path().join("shaders/mine.txt"), "").unwrap();
        assert_eq!(standard(), Path::new("specula-shaders"));
    }

    #[test]
    fn only_a_save_that_reaches_the_picture_counts() {
        let reload = |ok, changed: &[&str], stages: &[&str]| ReloadEvent {
            ok,
            changed: changed.iter().map(|file| (*file).to_owned()).collect(),
            stages: stages.iter().map(|stage| (*stage).to_owned()).collect(),
            ..ReloadEvent::default()
        };
        assert!(reaches_picture(&reload(true, &["user.glsl"], &["pbr.frag"])));
        for other in [
            reload(false, &["user.glsl"], &["pbr.frag"]),
            reload(true, &[], &["pbr.frag"]),
            reload(true, &["user.glsl"], &[]),
        ] {
            assert!(!reaches_picture(&other), "{other:?}");
        }
    }
}
