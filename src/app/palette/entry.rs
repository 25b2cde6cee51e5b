//! A row that the palette can show, and a number that it asks for.

use serde::Serialize;

use crate::app::command::settings::{change, set_shader};
use crate::app::command::spec::Command;
use crate::app::numbers::{Number, Scale};
use crate::settings::{Settings, ShaderValue};

/// The action of an entry.
#[derive(Clone, Debug)]
pub(super) enum Action {
    Run(Command),
    /// Asks for a number, and sets it.
    Number(Box<Ask>),
    /// Replaces the query by this one.
    Complete(String),
}

/// A row that the palette can show.
#[derive(Debug, Serialize)]
pub(in crate::app) struct Entry {
    pub(super) group: &'static str,
    #[serde(rename = "entry")]
    pub(super) title: String,
    /// More words by which it is found.
    #[serde(skip)]
    pub(super) words: String,
    /// Key that does the same, or the value of a number; may be empty.
    #[serde(skip)]
    pub(super) key: String,
    #[serde(skip)]
    pub(super) action: Action,
    /// Whether it comes after entries that match as well: it shows or switches the inside of an effect.
    #[serde(skip)]
    pub(super) is_minor: bool,
    /// Whether it is the choice in force, so that choosing it changes nothing.
    #[serde(rename = "now")]
    pub(super) is_in_force: bool,
}

impl Entry {
    pub(super) fn new(group: &'static str, title: impl Into<String>, command: Command) -> Self {
        Self::of(group, title.into(), Action::Run(command))
    }

    pub(super) fn of(group: &'static str, title: String, action: Action) -> Self {
        Self { group, title, words: String::new(), key: String::new(), action, is_minor: false, is_in_force: false }
    }

    pub(super) fn words(self, words: impl Into<String>) -> Self {
        Self { words: words.into(), ..self }
    }
}

/// An entry that switches something on or off.
pub(super) fn switch(
    group: &'static str,
    label: &str,
    name: &str,
    is_on: bool,
    command: impl Fn(bool) -> Command,
) -> Entry {
    let turns = if is_on { "off" } else { "on" };
    Entry::new(group, format!("{label}: turn {turns}"), command(!is_on)).words(name)
}

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
