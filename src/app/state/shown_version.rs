//! Which version of the shaders is on screen, and its file.

use super::State;
use super::shaders::stages::main_stage;
use super::shaders::versions::Version;
use crate::shader::TreePath;

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

    /// The file that draws the picture: the single file that was opened, or that of the main stage.
    pub(in crate::app) fn file_of_picture(&self) -> Option<TreePath> {
        let of_stage = || self.shown().map(|shown| TreePath::from(main_stage(&shown.pipelines)));
        self.source.opened().or_else(of_stage)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::shader::Source;

    #[test]
    fn a_toy_is_the_file_of_its_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rings.glsl");
        std::fs::write(&path, "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); }\n").unwrap();
        let state = State::new(Settings::of_window(), Source::open(path));
        assert_eq!(state.file_of_picture(), Some(TreePath::from("opened/rings.glsl")));
        let state = State::new(Settings::of_window(), Source::embedded());
        assert_eq!(state.file_of_picture(), None, "there is no picture yet");
    }
}
