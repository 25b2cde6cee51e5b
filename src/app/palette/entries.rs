//! The entries of the command palette: what the window can do at the moment.

use std::path::{Path, PathBuf};

use super::entry::{Action, Ask, Entry, Target, switch};
use super::settings::of_settings;
use crate::app::command::camera::{LOOK_THROUGH, VIEW_FROM, ViewSide};
use crate::app::command::compare::{COMPARE, CompareFields, TOGGLE_COMPARE, TOGGLE_DIFFERENCE};
use crate::app::command::file::{CHOOSE, OPEN, Open};
use crate::app::command::layout::{ARRANGE, ARRANGE_OWN, OPEN_INSPECTOR, OPEN_PANEL};
use crate::app::command::models::{SCENE, SceneFields};
use crate::app::command::program::LEARN;
use crate::app::command::scene::SELECT;
use crate::app::command::settings::{change, set_shader};
use crate::app::command::shaders::{ASK_VERSION, VERSIONS, VersionsRequest};
use crate::app::command::spec::{Command, Registered};
use crate::app::numbers::{default_of, of_constant, of_parameter};
use crate::app::state::State;
use crate::app::state::arrangement::{Panel, Preset};
use crate::app::state::dialog::Dialog;
use crate::app::state::exercise::LearnCommand;
use crate::app::state::inspection::Page;
use crate::app::state::recent::Kind;
use crate::app::state::selection::{LightId, Selected, name_or};
use crate::app::state::shaders::effects::{is_of_pass, is_switch};
use crate::learn::exercises;
use crate::message::did_you_mean;
use crate::scene::environment::{BUILT_IN, MODEL};
use crate::settings::{Settings, ShaderValue};
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::number;
use crate::shader::{Mode, ShaderSet};

/// All entries: the commands with a label, and those that the settings, the shaders, the model and the picture offer.
pub(in crate::app) fn entries(state: &State, registry: &[&'static dyn Registered]) -> Vec<Entry> {
    let settings = &state.session.settings;
    let mut entries: Vec<Entry> = {
        let enabled = registry.iter().filter(|command| command.is_enabled(state));
        enabled.filter_map(|command| of_command(*command)).collect()
    };
    entries.extend(of_layout());
    entries.extend(files(state));
    entries.extend(lessons());
    entries.extend(of_settings(state));
    entries.extend(of_picture(state));
    if let Some(shaders) = &state.session.shaders {
        constants(&mut entries, shaders, settings);
        parameters(&mut entries, shaders, settings);
        passes(&mut entries, shaders, settings);
        let shown = state.session.mode().map(|mode| mode.slug.as_str());
        entries.extend(shaders.modes.iter().enumerate().map(|(index, mode)| of_mode(index, mode, shown)));
    }
    let is_refused =
        |entry: &Entry| matches!(&entry.action, Action::Run(command) if command.about.refusal(state).is_some());
    entries.retain(|entry| !is_refused(entry));
    entries
}

/// The command of the entry with this title. `value` is for an entry that sets a number.
///
/// # Errors
/// A message: no entry has the title, or the value does not fit.
pub(in crate::app) fn entry_with(entries: &[Entry], title: &str, value: Option<f64>) -> Result<Command, String> {
    let Some(entry) = entries.iter().find(|entry| entry.title.eq_ignore_ascii_case(title)) else {
        let hint = did_you_mean(title, entries.iter().map(|entry| entry.title.as_str()));
        return Err(format!("the palette has no entry `{title}`.{hint} `entries` lists them all"));
    };
    match (&entry.action, value) {
        (Action::Number(ask), Some(value)) => {
            let value = ask.scale.parse(&value.to_string()).map_err(|why| format!("`{}`: {why}", entry.title))?;
            Ok(ask.command(value))
        }
        (Action::Number(ask), None) => Err(format!("`{}` needs a `value`: {}", entry.title, ask.scale.range_text())),
        (_, Some(_)) => Err(format!("`{}` takes no value", entry.title)),
        (Action::Run(command), None) => Ok(command.clone()),
        (Action::Complete(_), None) => Err(format!("`{}` only completes a path", entry.title)),
    }
}

/// The entry of a command with a label.
pub(super) fn of_command(command: &'static dyn Registered) -> Option<Entry> {
    let about = command.about();
    let command = command.at(0).filter(|_| !about.label.is_empty())?;
    Some(Entry { key: about.key(), ..Entry::new("Command", about.label, command).words(about.words) })
}

/// Arrangements and panels.
pub(super) fn of_layout() -> impl Iterator<Item = Entry> {
    let preset = |preset: Preset| {
        Entry::new("Layout", format!("Layout: {}", preset.title()), ARRANGE.with(preset)).words(preset.doc())
    };
    let panel =
        |panel: Panel| Entry::new("Panel", format!("Panel: {}", panel.0), OPEN_PANEL.with(panel)).words(panel.words());
    let page = |page: Page| {
        let (name, doc) = page.words();
        let entry = Entry::new("Panel", format!("Panel: Inspector, {name}"), OPEN_INSPECTOR.with(page));
        entry.words(format!("polar plot curves {doc}"))
    };
    let panels = Panel::groups().concat().into_iter().map(panel).chain(Page::ALL.map(page));
    Preset::ALL.into_iter().map(preset).chain(panels)
}

/// Environments, models and shader trees: the built-in ones and the files that were open.
fn files(state: &State) -> impl Iterator<Item = Entry> {
    let entry = |group: &'static str, kind: Kind, path: PathBuf, open: fn(PathBuf) -> Open| {
        let (title, words) = (format!("{group}: {}", kind.name_of(&path)), path.display().to_string());
        Entry::new(group, title, OPEN.with(open(path))).words(words)
    };
    let recent = |kind| state.recent.of(kind).iter().cloned();
    let built_in = |names: &'static [&'static str]| names.iter().map(PathBuf::from);
    let environments = built_in(&BUILT_IN).chain([MODEL, "none"].map(PathBuf::from)).chain(recent(Kind::Environment));
    let environments = environments.map(move |path| {
        let is_in_force = Path::new(&state.session.settings.environment.name) == path;
        Entry { is_in_force, ..entry("Environment", Kind::Environment, path, Open::Environment) }
    });
    let models = built_in(&crate::scene::BUILT_IN).chain(recent(Kind::Model));
    let models = models.map(move |path| entry("Model", Kind::Model, path, Open::Model));
    environments.chain(models).chain(recent(Kind::Tree).map(move |path| entry("Shaders", Kind::Tree, path, Open::Tree)))
}

/// The exercises.
fn lessons() -> impl Iterator<Item = Entry> {
    exercises().iter().map(|exercise| {
        let title = format!("Exercise {}: {}", exercise.number, exercise.title);
        let entry = Entry::new("Learn", title, LEARN.with(LearnCommand::Open(exercise.number)));
        Entry { is_minor: true, ..entry.words(format!("learn {} {}", exercise.slug(), exercise.idea)) }
    })
}

/// Entries that depend on the current picture: comparisons, versions to write to the files, views of the model.
fn of_picture(state: &State) -> Vec<Entry> {
    let compare = |title: String, command| Entry::new("Compare", title, command);
    let toggle = if state.compare.is_on() { "Stop comparing" } else { "Keep this picture and compare" };
    let key = TOGGLE_COMPARE.about().key();
    let mut entries = vec![Entry { key, ..Entry::new("Compare", toggle, TOGGLE_COMPARE.with(())) }];
    if TOGGLE_DIFFERENCE.is_enabled(state) {
        let entry = Entry::new("Compare", "Show or hide the differences", TOGGLE_DIFFERENCE.with(()));
        entries.push(entry.words("FLIP map heat"));
    }
    let choose = |title: &str, words: &str, dialog| Entry::new("Compare", title, CHOOSE.with(dialog)).words(words);
    entries.push(choose("Compare with a picture…", "file image PNG JPEG EXR HDR reference", Dialog::Picture));
    entries.push(choose("Compare with another shader tree…", "second folder A B", Dialog::SecondTree));
    let others = || state.versions.iter().filter(|version| state.can_show(version));
    entries.extend(others().map(|version| {
        let title = format!("Compare with version {}: {}", version.number, version.title());
        compare(title, COMPARE.with(CompareFields::version(version.number)))
    }));
    if state.edits.restored.is_some() {
        entries.push(compare("Go back to the newest version".to_owned(), VERSIONS.with(VersionsRequest::ShowNewest)));
    }
    entries.extend(others().map(|version| {
        let title = format!("Show version {} alone: {}", version.number, version.title());
        compare(title, VERSIONS.with(VersionsRequest::Show(version.number)))
    }));
    let writable = state.versions.iter().filter(|version| !state.files_of_version(version.number).is_empty());
    entries.extend(writable.map(|version| {
        compare(format!("Write version {} to the files…", version.number), ASK_VERSION.with(version.number))
    }));
    entries.extend(ViewSide::ALL.map(|side| {
        let entry = Entry::new("Camera", format!("View from the {}", side.name()), VIEW_FROM.with(side));
        Entry { key: side.key(), ..entry }
    }));
    entries.extend(of_scene(state));
    if ARRANGE_OWN.is_enabled(state) {
        entries.push(Entry::new("Layout", "Layout: Own", ARRANGE_OWN.with(())));
    }
    entries
}

/// Most nodes that the palette lists; the panel Scene has a search of its own.
const MOST_NODES: usize = 300;

/// Nodes, materials, cameras and scenes of the model, and lights with a handle.
fn of_scene(state: &State) -> Vec<Entry> {
    let Some(model) = state.session.model() else { return Vec::new() };
    let select = |title: String, selected| {
        let entry = Entry::new("Scene", title, SELECT.with(selected));
        Entry { is_minor: true, ..entry }
    };
    let nodes = model.nodes.iter().enumerate().filter(|(_, node)| !node.name.is_empty()).take(MOST_NODES);
    let mut entries: Vec<Entry> =
        nodes.map(|(at, node)| select(format!("Select node {}", node.name), Selected::Node(at))).collect();
    entries.extend(
        (0..)
            .zip(model.material_keys())
            .skip(1)
            .take(MOST_NODES)
            .map(|(index, key)| select(format!("Select material {key}"), Selected::Material(index))),
    );
    entries.extend((0..state.session.settings.lights.orbit.len()).map(|light| {
        select(format!("Move light {} in the picture", light + 1), Selected::Light(LightId::Orbit(light)))
    }));
    let contents = &model.contents;
    entries.extend((0..contents.scenes.len()).filter(|_| contents.scenes.len() > 1).map(|number| {
        let title = format!("Scene: {}", model.scene_name(number));
        let entry = Entry::new("Model", title, SCENE.with(SceneFields::of(number))).words("scene of the file");
        Entry { is_in_force: number == contents.scene, ..entry }
    }));
    entries.extend(model.cameras.iter().enumerate().map(|(index, camera)| {
        let name = name_or(&camera.name, || index.to_string());
        Entry::new("Camera", format!("Look through camera {name}"), LOOK_THROUGH.with(index))
    }));
    entries
}

/// A mode with its keys.
fn of_mode(index: usize, mode: &Mode, shown: Option<&str>) -> Entry {
    let digit = (index < 10).then(|| char::from_digit((index as u32 + 1) % 10, 10)).flatten();
    let keys: Vec<String> =
        mode.key.map(|key| key.to_ascii_uppercase()).into_iter().chain(digit).map(String::from).collect();
    let slug = mode.slug.clone();
    let show = change(format!("mode {slug}"), move |settings| settings.mode.clone_from(&slug));
    Entry {
        words: format!("{} {} {}", mode.slug, mode.group, mode.words),
        key: keys.join(" "),
        is_minor: mode.pass.is_some(),
        is_in_force: shown == Some(mode.slug.as_str()),
        ..Entry::new("Mode", mode.name.clone(), show)
    }
}

/// An entry for each choice of a constant or parameter, which has the value `now`.
fn choices<'a>(
    group: &'static str,
    label: &'a str,
    name: &'a str,
    choices: &'a [(String, i64)],
    now: Option<f64>,
) -> impl Iterator<Item = Entry> + 'a {
    choices.iter().map(move |(choice, value)| {
        let command = set_shader(name, &ShaderValue::Name(choice.clone()));
        let entry = Entry::new(group, format!("{label}: {choice}"), command).words(name);
        Entry { is_in_force: now == Some(*value as f64), ..entry }
    })
}

fn constants(entries: &mut Vec<Entry>, shaders: &ShaderSet, settings: &Settings) {
    for constant in &shaders.constants {
        let (name, label, default) = (&constant.name, &constant.label, default_of(constant));
        let group = if is_switch(shaders, name) { "Pass" } else { "Parameter" };
        let now = settings.shader.get(name).and_then(|value| number(value, &constant.choices)).unwrap_or(default);
        if constant.scalar == Scalar::Bool {
            let command = |on| set_shader(name, &ShaderValue::Bool(on));
            entries.push(switch(group, label, name, now != 0.0, command));
        } else if let Some(scale) = of_constant(constant) {
            let target = Target::Shader(name.clone(), constant.scalar != Scalar::Float);
            let (title, doc) = (label.clone(), constant.doc.clone());
            entries.push(Ask { title, group, doc, scale, now, target }.entry());
        }
        entries.extend(choices(group, label, name, &constant.choices, Some(now)));
    }
}

fn parameters(entries: &mut Vec<Entry>, shaders: &ShaderSet, settings: &Settings) {
    for parameter in &shaders.parameters {
        let (name, label) = (&parameter.name, &parameter.label);
        let is_of_pass = is_of_pass(shaders, parameter);
        let group = if is_of_pass { "Pass" } else { "Parameter" };
        let set = settings.shader.get(name).and_then(|value| number(value, &parameter.choices));
        let now = set.or_else(|| parameter.default.first().copied());
        if parameter.kind == ParameterType::Bool {
            let command = |on| set_shader(name, &ShaderValue::Bool(on));
            entries.push(switch(group, label, name, now.unwrap_or_default() != 0.0, command));
        } else if let Some(scale) = of_parameter(parameter) {
            let target = Target::Shader(name.clone(), parameter.kind != ParameterType::Float);
            let (title, doc, now) = (label.clone(), parameter.doc.clone(), now.unwrap_or_default());
            entries.push(Ask { title, group, doc, scale, now, target }.entry());
        } else if parameter.choices.is_empty() {
            // Colors and vectors have no single number to type.
            let panel = if is_of_pass { Panel::PASSES } else { Panel::PARAMETERS };
            entries.push(Entry::new(group, label.clone(), OPEN_PANEL.with(panel)).words(name.clone()));
        }
        entries.extend(choices(group, label, name, &parameter.choices, now));
    }
}

fn passes(entries: &mut Vec<Entry>, shaders: &ShaderSet, settings: &Settings) {
    let internal = &shaders.graph.internal;
    for pass in shaders.graph.passes.iter().filter(|pass| pass.has_switch() && pass.desc.when.is_none()) {
        let command = |on| {
            let name = pass.name().to_owned();
            change(name.clone(), move |settings| {
                settings.passes.insert(name.clone(), on);
            })
        };
        let entry = switch("Pass", &pass.desc.label, pass.name(), pass.is_wanted(&settings.passes), command);
        entries.push(Entry { is_minor: internal.contains(pass.name()), ..entry });
    }
}
