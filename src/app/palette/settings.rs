//! Entries for the settings: numbers, choices and switches.

use super::ask::Ask;
use super::entries::{Action, Entry, switch};
use crate::app::command::Command;
use crate::app::numbers::{Number, group, title};
use crate::app::state::State;
use crate::settings::{Setting, Settings, Valid, Value, catalog};

/// Entries of all settings with a row, and of the saved cameras.
pub(super) fn of_settings(state: &State) -> Vec<Entry> {
    let settings = &state.session.settings;
    let has_lights = state.session.model().is_some_and(|model| !model.lights.is_empty());
    let is_offered = |entry: &Entry| match &entry.action {
        Action::Set(path, value) => has_lights || path != "lights.source" || *value != Value::Text("model".to_owned()),
        _ => true,
    };
    let has_row = |setting: &&'static Setting| !setting.entry.label.is_empty();
    let mut entries: Vec<Entry> =
        catalog().iter().filter(has_row).flat_map(|setting| of_setting(setting, settings)).filter(is_offered).collect();
    for number in 1..=9 {
        let entry = |title: String, command| {
            let entry = Entry::new("Camera", title, Action::Do(command));
            Entry { words: "bookmark".to_owned(), is_minor: true, ..entry }
        };
        entries.push(entry(format!("Keep the camera as {number}"), Command::KeepCamera(number)));
        if settings.bookmarks.contains_key(&number.to_string()) {
            entries.push(entry(format!("Go to camera {number}"), Command::RecallCamera(number)));
        }
    }
    entries
}

/// The entries of a setting: its numbers, a switch, or its choices.
fn of_setting(setting: &'static Setting, settings: &Settings) -> Vec<Entry> {
    let (title, group, path) = (title(setting, setting.entry.label), group(setting), &setting.path);
    let choice = |name: &str, value: Value| {
        let entry = Entry::new(group, format!("{title}: {name}"), Action::Set(path.clone(), value));
        Entry { words: path.clone(), ..entry }
    };
    let text = |name: &str, value: &str| choice(name, Value::Text(value.to_owned()));
    match (&setting.default, setting.entry.valid) {
        (Value::Switch(_), _) => {
            let is_on = settings.value(path) == Some(Value::Switch(true));
            vec![switch(group, &title, path, is_on, |on| Action::Set(path.clone(), Value::Switch(on)))]
        }
        (Value::Whole(_), Valid::OneOf(values)) => {
            values.iter().map(|value| choice(&value.to_string(), Value::Whole(*value))).collect()
        }
        (Value::Text(_), _) => {
            let names = setting.names.iter().map(|name| text(name, name));
            names.chain(setting.entry.choices.iter().map(|(name, value)| text(name, value))).collect()
        }
        _ => {
            let used = Number::of(setting).filter(|number| number.is_used(settings));
            used.map(|number| Ask::of_setting(&number, settings).entry()).collect()
        }
    }
}
