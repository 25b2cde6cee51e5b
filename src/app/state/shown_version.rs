//! Which version of the shaders is on screen.

use super::State;
use super::shaders::versions::Version;

impl State {
    /// The number of the version on screen, or its generation if it is none.
    pub(in crate::app) fn shown_version(&self) -> u64 {
        let generation = self.shown_generation();
        self.versions.of_generation(generation).map_or(generation, |version| version.number)
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
