//! Entries for the settings that are no numbers: choices and switches.

use clap::ValueEnum;

use super::entries::{Action, Entry, switch};
use crate::app::command::Command;
use crate::app::viewer::Viewer;
use crate::app::widgets::rows::choice_name;
use crate::settings::{Channels, Colormap, LightSource, Settings, Tonemap};

/// An entry that sets a setting of the command line.
fn assign(group: &'static str, title: String, path: &str, value: &str) -> Entry {
    Entry { words: path.to_owned(), ..Entry::new(group, title, Action::Assign(format!("{path}={value}"))) }
}

/// An entry for each choice of a setting.
fn choices<T: ValueEnum + 'static>(group: &'static str, title: &str, path: &str) -> impl Iterator<Item = Entry> {
    T::value_variants().iter().filter_map(move |choice| {
        let value = choice.to_possible_value()?;
        Some(assign(group, format!("{title}: {}", choice_name(choice)), path, value.get_name()))
    })
}

/// Settings of light, display and material.
pub(super) fn of_settings(viewer: &Viewer) -> Vec<Entry> {
    let settings = &viewer.session.settings;
    let has_lights = viewer.session.model().is_some_and(|model| !model.lights.is_empty());
    let is_offered =
        |entry: &Entry| has_lights || !matches!(&entry.action, Action::Assign(text) if text == "lights.source=model");
    let mut entries: Vec<Entry> =
        choices::<LightSource>("Lights", "Lights", "lights.source").filter(is_offered).collect();
    entries.extend(choices::<Tonemap>("Output", "Tone map", "view.tonemap"));
    entries.extend(choices::<Channels>("Output", "Channels", "view.channels"));
    entries.extend(choices::<Colormap>("Output", "Colors of numbers", "view.colormap"));
    for (name, value) in [("as the mode stores them", "mode"), ("auto", "auto"), ("fit to the picture", "fit")] {
        entries.push(assign("Output", format!("Range of values: {name}"), "view.range", value));
    }
    for samples in [1, 4] {
        entries.push(assign("Output", format!("Samples per pixel: {samples}"), "view.msaa", &samples.to_string()));
    }
    for (name, value) in [("environment", "env"), ("dark gray", "#1b1d21"), ("transparent", "none")] {
        entries.push(assign("Environment", format!("Background: {name}"), "view.background", value));
    }
    for (group, title, path, is_on) in switches(settings) {
        entries.push(switch(group, title, path, is_on, |on| Action::Assign(format!("{path}={on}"))));
    }
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

fn switches(settings: &Settings) -> [(&'static str, &'static str, &'static str, bool); 5] {
    let view = &settings.view;
    [
        ("Output", "Wireframe over the picture", "view.wireframe", view.wireframe),
        ("Output", "Dither", "view.dither", view.dither),
        ("Environment", "Suns of the map", "environment.suns", settings.environment.suns),
        ("Lights", "Rectangular light", "lights.rect.enabled", settings.lights.rect.enabled),
        ("Material", "One material for all", "material.enabled", settings.material.enabled),
    ]
}
