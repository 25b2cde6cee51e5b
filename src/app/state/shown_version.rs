//! Which version of the shaders is on screen.

use super::State;
use super::shaders::versions::Version;

impl State {
    /// The number of the version on screen, or of the newest one if what is on screen is none. 1 before the first.
    pub(in crate::app) fn shown_version(&self) -> u64 {
        self.version_number(self.shown_generation())
            .or(self.versions.iter().next_back().map(|of| of.number))
            .unwrap_or(1)
    }

    /// The number of the version that a generation of the shaders is, if it is kept.
    fn version_number(&self, generation: u64) -> Option<u64> {
        self.versions.of_generation(generation).map(|version| version.number)
    }

    /// The version that a generation of the shaders is, in words.
    pub(in crate::app) fn version_name(&self, generation: u64) -> String {
        let number = self.version_number(generation);
        number.map_or_else(|| "an older version".to_owned(), |number| format!("version {number}"))
    }

    /// Whether a version is on screen.
    pub(in crate::app) fn shows_version(&self, version: &Version) -> bool {
        match &self.edits.restored {
            Some(restored) => restored.number == version.number,
            None => self.shown_generation() == version.generation,
        }
    }

    /// Whether a version that is not on screen can be shown beside it.
    pub(in crate::app) fn can_show(&self, version: &Version) -> bool {
        self.versions.can_show(version, self.shown_generation()) && !self.shows_version(version)
    }
}
