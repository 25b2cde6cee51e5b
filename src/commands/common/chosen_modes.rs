//! The modes that `--mode` asks for: one, all, or a list.

use specula::shader::{Mode, ShaderSet};

use super::check_mode;
use crate::commands::Failure;

/// The modes to write.
#[derive(Debug, PartialEq, Eq)]
pub enum Modes {
    /// The mode of the settings, to the named file.
    One,
    /// A file for each mode.
    All,
    /// A file for each of these modes.
    Named(Vec<String>),
}

impl Modes {
    /// The modes that the text of a setting names: `all`, a mode, or several with commas between them. The setting becomes the first of
    /// them.
    pub fn of(setting: &mut String) -> Self {
        if setting == "all" {
            "final".clone_into(setting);
            return Self::All;
        }
        if !setting.contains(',') {
            return Self::One;
        }
        let mut names: Vec<String> = Vec::new();
        for name in setting.split(',').map(str::trim) {
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        setting.clone_from(&names[0]);
        Self::Named(names)
    }

    /// The modes of the shaders, in the order in which they were named. `paths`: includes the path-traced ones, if all are
    /// written.
    pub fn in_shaders<'a>(&self, shaders: &'a ShaderSet, paths: bool) -> Result<Vec<&'a Mode>, Failure> {
        let Self::Named(names) = self else {
            return Ok(shaders.modes.iter().filter(|mode| paths || !mode.follows_paths()).collect());
        };
        // Before the first picture, so that a wrong name leaves no files.
        names.iter().try_for_each(|name| check_mode(shaders, name))?;
        let of = |name: &String| shaders.modes.iter().find(|mode| mode.slug == *name);
        Ok(names.iter().filter_map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_names_one_mode_all_or_a_list() {
        let of = |text: &str| {
            let mut setting = text.to_owned();
            (Modes::of(&mut setting), setting)
        };
        assert_eq!(of("d"), (Modes::One, "d".to_owned()));
        assert_eq!(of("all"), (Modes::All, "final".to_owned()));
        let names = ["d", "final"].map(str::to_owned).to_vec();
        assert_eq!(of("d, final,d"), (Modes::Named(names), "d".to_owned()));
    }
}
