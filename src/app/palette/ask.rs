//! Numbers that the palette asks for.

use super::entries::{Action, Entry};
use crate::app::command::settings::{change, set_shader};
use crate::app::command::spec::Command;
use crate::app::numbers::{Number, Scale};
use crate::settings::{Settings, ShaderValue};

/// A number that the palette asks for.
#[derive(Clone, Debug)]
pub(super) struct Ask {
    pub(super) title: String,
    pub(super) group: &'static str,
    pub(super) doc: String,
    pub(super) scale: Scale,
    /// The present value.
    pub(super) now: f64,
    pub(super) target: Target,
}

/// Where a number is.
#[derive(Clone, Debug)]
pub(super) enum Target {
    Setting(Number),
    /// A parameter or constant of the shaders; `true` for a whole number.
    Shader(String, bool),
}

impl Ask {
    pub(super) fn of_setting(number: &Number, settings: &Settings) -> Self {
        Self {
            title: number.title(),
            group: number.group(),
            doc: number.doc().to_owned(),
            scale: number.scale(),
            now: number.get(settings),
            target: Target::Setting(number.clone()),
        }
    }

    pub(super) fn entry(self) -> Entry {
        let (group, title, key) = (self.group, self.title.clone(), self.scale.text(self.now));
        let words = match &self.target {
            // The index of a light in its path is not the number in its name.
            Target::Setting(number) => number.path().rsplit('.').next().unwrap_or_default().to_owned(),
            Target::Shader(name, _) => name.clone(),
        };
        Entry { words, key, ..Entry::of(group, title, Action::Number(Box::new(self))) }
    }

    /// The command that sets the number.
    pub(super) fn command(&self, value: f64) -> Command {
        match &self.target {
            Target::Setting(number) => {
                let number = number.clone();
                change(self.title.clone(), move |settings| number.set(settings, value))
            }
            Target::Shader(name, true) => set_shader(name, &ShaderValue::Int(value.round() as i64)),
            Target::Shader(name, false) => set_shader(name, &ShaderValue::Float(value)),
        }
    }
}
