//! The models, environments and shader trees that were open, kept between runs in `recent.json`.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::state_folder;

const FILE: &str = "recent.json";
/// Most files of a kind.
const MOST: usize = 8;

/// A kind of file that is remembered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Kind {
    Model,
    Environment,
    Tree,
}

impl Kind {
    /// The name of a file in a list. Many trees are called `shaders` or `image.glsl`, so theirs begins with the folder.
    pub(in crate::app) fn name_of(self, path: &Path) -> String {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        match path.parent().and_then(Path::file_name).filter(|_| self == Self::Tree) {
            Some(folder) => format!("{}/{name}", folder.to_string_lossy()),
            None => name.into_owned(),
        }
    }
}

/// Absolute paths of files that could be opened, the newest first. A list that was not [restored](Self::restored) is not stored either.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(in crate::app) struct Recent {
    models: Vec<PathBuf>,
    environments: Vec<PathBuf>,
    trees: Vec<PathBuf>,
    #[serde(skip)]
    is_stored: bool,
}

impl Recent {
    /// The files of the last run that still exist.
    pub(in crate::app) fn restored() -> Self {
        let stored = state_folder::load(FILE).and_then(|text| parse(&text)).unwrap_or_default();
        Self { is_stored: true, ..stored }
    }

    pub(in crate::app) fn of(&self, kind: Kind) -> &[PathBuf] {
        match kind {
            Kind::Model => &self.models,
            Kind::Environment => &self.environments,
            Kind::Tree => &self.trees,
        }
    }

    fn of_mut(&mut self, kind: Kind) -> &mut Vec<PathBuf> {
        match kind {
            Kind::Model => &mut self.models,
            Kind::Environment => &mut self.environments,
            Kind::Tree => &mut self.trees,
        }
    }

    /// Moves an opened file to the front, and stores the list.
    pub(in crate::app) fn remember(&mut self, kind: Kind, path: &Path) {
        if self.insert(kind, path) && self.is_stored {
            state_folder::change(FILE, |stored: &mut Self| {
                stored.drop_missing();
                stored.insert(kind, path);
            });
        }
    }

    /// Removes a file that could not be opened, and stores the list.
    pub(in crate::app) fn forget(&mut self, kind: Kind, path: &Path) {
        let Ok(path) = std::path::absolute(path) else { return };
        let list = self.of_mut(kind);
        if list.contains(&path) && !path.exists() {
            list.retain(|known| *known != path);
            if self.is_stored {
                state_folder::change(FILE, |stored: &mut Self| stored.of_mut(kind).retain(|known| *known != path));
            }
        }
    }

    /// Leaves out files that no longer exist.
    fn drop_missing(&mut self) {
        for kind in [Kind::Model, Kind::Environment, Kind::Tree] {
            let list = self.of_mut(kind);
            list.retain(|path| path.exists());
            list.truncate(MOST);
        }
    }

    /// Returns whether the list has changed.
    fn insert(&mut self, kind: Kind, path: &Path) -> bool {
        let Ok(path) = std::path::absolute(path) else { return false };
        let list = self.of_mut(kind);
        if list.first() == Some(&path) {
            return false;
        }
        list.retain(|known| *known != path);
        list.insert(0, path);
        list.truncate(MOST);
        true
    }
}

/// The stored files that exist. A text that cannot be read counts as an empty list.
fn parse(text: &str) -> Option<Recent> {
    let mut recent: Recent = serde_json::from_str(text).ok()?;
    recent.drop_missing();
    Some(recent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_files_come_first_and_missing_ones_are_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let paths: Vec<PathBuf> = (0..10).map(|i| folder.path().join(format!("{i}.glb"))).collect();
        let mut recent = Recent::default();
        for path in &paths {
            std::fs::write(path, "").unwrap();
            assert!(recent.insert(Kind::Model, path));
        }
        assert!(!recent.insert(Kind::Model, &paths[9]), "the newest is there already");
        assert!(recent.insert(Kind::Model, &paths[5]));
        let names = |recent: &Recent| {
            let name = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
            recent.of(Kind::Model).iter().map(name).collect::<String>()
        };
        assert_eq!(names(&recent), "59876432");
        let text = serde_json::to_string(&recent).unwrap();
        assert_eq!(parse(&text), Some(recent));
        std::fs::remove_file(&paths[9]).unwrap();
        assert_eq!(names(&parse(&text).unwrap()), "5876432");
    }

    #[test]
    fn a_damaged_list_counts_as_none() {
        assert_eq!(["", "7", "{\"models\": 1}"].map(parse), [None, None, None]);
        assert_eq!(parse("{\"of_a_newer_version\": 1}"), Some(Recent::default()));
    }
}
