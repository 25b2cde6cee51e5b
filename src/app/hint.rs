//! The hint of the first start: which folder to edit. Once dismissed it does not come back. The first save that reaches the picture
//! dismisses it, too.

use std::path::{Path, PathBuf};

use super::dialog::{self, Dialog};
use crate::events::ReloadEvent;
use crate::shader::embedded;
use crate::state;

const FILE: &str = "hint.json";
/// The content of the file once the hint is dismissed.
const DISMISSED: &str = "{\"dismissed\": true}";

/// Whether the hint is shown, and what it offers.
pub(super) struct Hint {
    is_shown: bool,
    /// The folder to which its button writes the built-in shaders.
    pub(super) folder: PathBuf,
}

impl Hint {
    pub(super) fn restored() -> Self {
        Self { is_shown: state::load(FILE).is_none(), folder: standard_folder(Path::new("")) }
    }

    pub(super) fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// Hides it in this run.
    pub(super) fn hide(&mut self) {
        self.is_shown = false;
    }

    /// Hides it for good.
    pub(super) fn dismiss(&mut self) {
        self.is_shown = false;
        state::save(FILE, DISMISSED);
    }

    /// Dismisses it if a save of the user's own files has changed the picture: the user has done what it says.
    pub(super) fn saved(&mut self, reload: &ReloadEvent) {
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

/// Writes the built-in shaders, as `specula new` does, and returns their folder. Without a folder the user chooses one. It blocks, so
/// it runs on a thread of its own.
///
/// # Errors
/// A message: there is no dialog, or the folder cannot be written.
pub(super) fn write_tree(folder: Option<PathBuf>) -> Result<Option<PathBuf>, String> {
    let folder = match folder {
        Some(folder) => Some(folder),
        // A folder that holds other files gets one inside.
        None => dialog::choose(Dialog::New)?.map(|chosen| {
            let holds_files = std::fs::read_dir(&chosen).is_ok_and(|mut entries| entries.next().is_some());
            if holds_files { chosen.join("specula-shaders") } else { chosen }
        }),
    };
    let Some(folder) = folder else { return Ok(None) };
    let folder = std::path::absolute(&folder).unwrap_or(folder);
    embedded::write_to(&folder, None)
        .map(|_| Some(folder.clone()))
        .map_err(|error| format!("cannot write the shaders to {}: {error}", folder.display()))
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

    #[test]
    fn the_tree_is_written_once() {
        let working = tempfile::tempdir().unwrap();
        let folder = working.path().join("shaders");
        assert_eq!(write_tree(Some(folder.clone())), Ok(Some(folder.clone())));
        assert!(folder.join("user.glsl").is_file());
        assert!(write_tree(Some(folder)).unwrap_err().contains("not empty"));
    }
}
