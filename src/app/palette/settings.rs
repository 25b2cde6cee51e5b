//! Entries for the settings: numbers, choices and switches.

use super::entry::{Ask, Entry, switch};
use crate::app::command::camera::{KEEP_CAMERA, RECALL_CAMERA};
use crate::app::command::settings::change;
use crate::app::numbers::{Number, group, title};
use crate::app::state::State;
use crate::settings::{Setting, Settings, Valid, Value, catalog};

/// Entries of all settings with a row, and of the saved cameras.
pub(super) fn of_settings(state: &State) -> Vec<Entry> {
    let settings = &state.session.settings;
    let has_lights = state.session.model().is_some_and(|model| !model.lights.is_empty());
    let has_row = |setting: &&'static Setting| !setting.entry.label.is_empty();
    let of_setting = |setting| of_setting(setting, settings, has_lights);
    let mut entries: Vec<Entry> = catalog().iter().filter(has_row).flat_map(of_setting).collect();
    for number in 1..=9 {
        let entry = |title: String, command| {
            let entry = Entry::new("Camera", title, command).words("bookmark");
            Entry { is_minor: true, ..entry }
        };
        entries.push(entry(format!("Keep the camera as {number}"), KEEP_CAMERA.with(number)));
        if settings.bookmarks.contains_key(&number.to_string()) {
            entries.push(entry(format!("Go to camera {number}"), RECALL_CAMERA.with(number)));
        }
    }
    entries
}

/// The entries of a setting: its numbers, a switch, or its choices. Lights of the model are offered only if it has some.
fn of_setting(setting: &'static Setting, settings: &Settings, has_lights: bool) -> Vec<Entry> {
    let (title, group, path) = (title(setting, setting.entry.label), group(setting), &setting.path);
    let now = settings.value(path);
    let set = |value: Value| change(format!("{path} {value:?}"), move |settings| settings.set_value(path, &value));
    let choice = |name: &str, value: Value| {
        let is_in_force = now.as_ref() == Some(&value);
        let entry = Entry::new(group, format!("{title}: {name}"), set(value));
        Entry { is_in_force, ..entry.words(path.clone()) }
    };
    let text = |name: &str, value: &str| choice(name, Value::Text(value.to_owned()));
    match (&setting.default, setting.entry.valid) {
        (Value::Switch(_), _) => {
            let is_on = now == Some(Value::Switch(true));
            vec![switch(group, &title, path, is_on, |on| set(Value::Switch(on)))]
        }
        (Value::Whole(_), Valid::OneOf(values)) => {
            values.iter().map(|value| choice(&value.to_string(), Value::Whole(*value))).collect()
        }
        (Value::Text(_), _) => {
            let names = setting.names.iter().map(|name| (name.as_str(), name.as_str()));
            let choices = names.chain(setting.entry.choices.iter().copied());
            let is_offered = |value: &str| has_lights || path != "lights.source" || value != "model";
            choices.filter(|(_, value)| is_offered(value)).map(|(name, value)| text(name, value)).collect()
        }
        _ => {
            let used = Number::of(setting).filter(|number| number.is_used(settings));
            used.map(|number| Ask::of_setting(&number, settings).entry()).collect()
        }
    }
}
