//! The entries of the command palette: what the window can do at the moment.

use std::path::{Path, PathBuf};

use super::act::is_in_force;
use super::ask::{Ask, Target};
use super::settings::of_settings;
use crate::app::command::{Command, CompareWith, Side};
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
use crate::scene::environment::BUILT_IN;
use crate::settings::{Settings, ShaderValue, Value};
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::number;
use crate::shader::{Mode, ShaderSet};

/// The action of an entry.
#[derive(Clone, Debug)]
pub(super) enum Action {
    Mode(String),
    Do(Command),
    Environment(String),
    /// Sets the setting at a path.
    Set(String, Value),
    /// Shows or hides the histogram of the picture's values.
    ToggleHistogram,
    /// Shows or hides the map of a comparison's differences.
    ToggleDifference,
    /// Sets a value of a parameter or constant of the shaders.
    Value(String, ShaderValue),
    /// Asks for a number, and sets it.
    Number(Box<Ask>),
    Pass(String, bool),
    Open(Panel),
    Arrange(Preset),
    ResetLayout,
    /// Shows the user's own arrangement of the panels.
    ArrangeOwn,
    /// Asks in the timeline whether to write a version to the files.
    WriteVersion(u64),
    /// Shows the field for an expression.
    AskExpression,
    /// Shows an expression of the shaders over the model.
    Watch(String),
    /// Asks whether to write the values of parameters to the files.
    WriteDefaults,
    TogglePanels,
    ToggleTheme,
    ShowKeys,
}

/// A row that the palette can show.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) group: &'static str,
    pub(super) title: String,
    /// More words by which it is found.
    pub(super) words: String,
    /// Key that does the same, or the value of a number; may be empty.
    pub(super) key: String,
    pub(super) action: Action,
    /// Whether it comes after entries that match as well: it shows or switches the inside of an effect.
    pub(super) is_minor: bool,
    /// Whether it is the choice in force, so that choosing it changes nothing.
    pub(super) is_in_force: bool,
}

impl Entry {
    pub(super) fn new(group: &'static str, title: String, action: Action) -> Self {
        Self { group, title, words: String::new(), key: String::new(), action, is_minor: false, is_in_force: false }
    }
}

/// All entries.
pub(super) fn entries(state: &State) -> Vec<Entry> {
    let mut entries = commands();
    let settings = &state.session.settings;
    entries.extend(files(state));
    entries.extend(lessons());
    entries.extend(of_settings(state));
    entries.extend(of_picture(state));
    if let Some(shaders) = &state.session.shaders {
        constants(&mut entries, shaders, settings);
        parameters(&mut entries, shaders, settings);
        passes(&mut entries, shaders, settings);
        entries.extend(shaders.modes.iter().enumerate().map(|(index, mode)| of_mode(index, mode)));
    }
    for entry in &mut entries {
        entry.is_in_force = is_in_force(&entry.action, state);
    }
    entries
}

/// Environments, models and shader trees: the built-in ones and the files that were open.
fn files(state: &State) -> impl Iterator<Item = Entry> {
    let entry = |group: &'static str, path: &Path, action: Action| {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let words = path.display().to_string();
        Entry { words, ..Entry::new(group, format!("{group}: {name}"), action) }
    };
    let recent = &state.recent;
    let built_in = BUILT_IN.into_iter().chain(["none"]).map(PathBuf::from);
    let environment = move |path: PathBuf| entry("Environment", &path, Action::Environment(path.display().to_string()));
    let model = move |path: PathBuf| entry("Model", &path, Action::Do(Command::OpenModel(path.clone())));
    let tree = move |path: PathBuf| entry("Shaders", &path, Action::Do(Command::OpenTree(path.clone())));
    let environments = built_in.chain(recent.of(Kind::Environment).iter().cloned()).map(environment);
    let models = crate::scene::BUILT_IN.into_iter().map(PathBuf::from).chain(recent.of(Kind::Model).iter().cloned());
    environments.chain(models.map(model)).chain(recent.of(Kind::Tree).iter().cloned().map(tree))
}

/// The exercises.
fn lessons() -> impl Iterator<Item = Entry> {
    exercises().iter().map(|exercise| {
        let title = format!("Exercise {}: {}", exercise.number, exercise.title);
        let entry = Entry::new("Learn", title, Action::Do(Command::Learn(LearnCommand::Open(exercise.number))));
        Entry { words: format!("learn {} {}", exercise.slug(), exercise.idea), is_minor: true, ..entry }
    })
}

/// Entries that depend on the current picture: comparisons, versions to write to the files, views of the model.
fn of_picture(state: &State) -> Vec<Entry> {
    let compare = |title: String, with| Entry::new("Compare", title, Action::Do(Command::Compare(with)));
    let newest = state.shown_generation();
    let mut entries = match state.compare.is_on() {
        true => vec![
            compare("Stop comparing".to_owned(), CompareWith::Nothing),
            Entry {
                words: "FLIP map heat".to_owned(),
                ..Entry::new("Compare", "Show or hide the differences".to_owned(), Action::ToggleDifference)
            },
        ],
        false => vec![compare("Keep this picture and compare".to_owned(), CompareWith::ThisPicture)],
    };
    entries[0].key = "Ctrl+K".to_owned();
    let choose = |title: &str, words: &str, dialog| {
        let entry = Entry::new("Compare", title.to_owned(), Action::Do(Command::Choose(dialog)));
        Entry { words: words.to_owned(), ..entry }
    };
    entries.push(choose("Compare with a picture…", "file image PNG JPEG EXR HDR reference", Dialog::Picture));
    entries.push(choose("Compare with another shader tree…", "second folder A B", Dialog::SecondTree));
    for version in state.versions.iter().filter(|version| state.versions.can_show(version, newest)) {
        let title = format!("Compare with version {}: {}", version.number, version.title());
        entries.push(compare(title, CompareWith::Version(version.number)));
    }
    let mut show = |title: String, version| {
        entries.push(Entry::new("Compare", title, Action::Do(Command::ShowVersion(version))));
    };
    if state.edits.restored.is_some() {
        show("Go back to the newest version".to_owned(), None);
    }
    for version in state.versions.iter().filter(|version| state.versions.can_show(version, newest)) {
        show(format!("Show version {} alone: {}", version.number, version.title()), Some(version.number));
    }
    for version in state.versions.iter().filter(|version| !state.files_of_version(version.number).is_empty()) {
        let title = format!("Write version {} to the files…", version.number);
        entries.push(Entry::new("Compare", title, Action::WriteVersion(version.number)));
    }
    entries.extend(Side::ALL.map(|side| {
        let (name, key) = side.words();
        let entry = Entry::new("Camera", format!("View from the {name}"), Action::Do(Command::ViewFrom(side)));
        Entry { key: key.to_owned(), ..entry }
    }));
    entries.extend(of_scene(state));
    if state.workspace.sight.has_own_arrangement {
        entries.push(Entry::new("Layout", "Layout: Own".to_owned(), Action::ArrangeOwn));
    }
    entries
}

/// Most nodes that the palette lists; the panel Scene has a search of its own.
const MOST_NODES: usize = 300;

/// Nodes, materials and cameras of the model, and lights with a handle.
fn of_scene(state: &State) -> Vec<Entry> {
    let Some(model) = state.session.model() else { return Vec::new() };
    let select = |title: String, selected| {
        let entry = Entry::new("Scene", title, Action::Do(Command::Select(selected)));
        Entry { is_minor: true, ..entry }
    };
    let nodes = model.nodes.iter().enumerate().filter(|(_, node)| !node.name.is_empty()).take(MOST_NODES);
    let mut entries: Vec<Entry> =
        nodes.map(|(at, node)| select(format!("Select node {}", node.name), Selected::Node(at))).collect();
    entries.extend(
        (1..model.materials.len())
            .take(MOST_NODES)
            .map(|index| select(format!("Select material {}", model.material_key(index)), Selected::Material(index))),
    );
    entries.extend((0..state.session.settings.lights.orbit.len()).map(|light| {
        select(format!("Move light {} in the picture", light + 1), Selected::Light(LightId::Orbit(light)))
    }));
    entries.extend(model.cameras.iter().enumerate().map(|(index, camera)| {
        let name = name_or(&camera.name, || index.to_string());
        Entry::new("Camera", format!("Look through camera {name}"), Action::Do(Command::LookThrough(index)))
    }));
    entries
}

/// Commands, panels and arrangements.
pub(super) fn commands() -> Vec<Entry> {
    let commands = [
        ("Open the gallery", "built-in models environments pictures browse", "", Action::Do(Command::ShowGallery)),
        ("Restore the last session", "continue", "", Action::Do(Command::RestoreSession)),
        ("Open a file", "model environment shader measured BRDF", "Ctrl+O", Action::Do(Command::Choose(Dialog::File))),
        ("Open a shader tree", "folder", "", Action::Do(Command::Choose(Dialog::Tree))),
        ("Frame the model", "camera", "R", Action::Do(Command::FrameModel)),
        ("Reload all shaders", "compile", "F5", Action::Do(Command::Reload)),
        ("Watch an expression of the shaders…", "variable value debug line", "", Action::AskExpression),
        ("Write the values of parameters to GLSL…", "save defaults annotation", "", Action::WriteDefaults),
        ("Undo", "", "Ctrl+Z", Action::Do(Command::Undo)),
        ("Redo", "", "Ctrl+Shift+Z", Action::Do(Command::Redo)),
        ("Screenshot", "capture PNG", "F12", Action::Do(Command::Screenshot)),
        ("Keys", "shortcuts help", "F1", Action::ShowKeys),
        ("Show or hide the histogram", "distribution values", "", Action::ToggleHistogram),
        ("Reset the arrangement of the panels", "default layout restore tiles", "", Action::ResetLayout),
        ("Hide or show the panels", "", "H", Action::TogglePanels),
        ("Light or dark theme", "colors appearance", "", Action::ToggleTheme),
        ("Hide the selection", "scene node primitive", "Ctrl+H", Action::Do(Command::HideSelected)),
        ("Isolate the selection", "scene node solo local view", "/", Action::Do(Command::IsolateSelected)),
        ("Show everything", "scene hidden unhide reveal", "Alt+H", Action::Do(Command::ShowAll)),
        ("Select nothing", "scene deselect", "Esc", Action::Do(Command::Select(Selected::Nothing))),
        ("Place the rectangular light", "area light handle gizmo", "", Action::Do(Command::PlaceRectangle)),
        ("Quit", "close", "Ctrl+Q", Action::Do(Command::Quit)),
    ];
    let command = |(title, words, key, action): (&str, &str, &str, Action)| {
        let entry = Entry::new("Command", title.to_owned(), action);
        Entry { words: words.to_owned(), key: key.to_owned(), ..entry }
    };
    let preset = |preset: Preset| {
        let entry = Entry::new("Layout", format!("Layout: {}", preset.title()), Action::Arrange(preset));
        Entry { words: preset.doc().to_owned(), ..entry }
    };
    let panel = |panel: Panel| {
        let entry = Entry::new("Panel", format!("Panel: {}", panel.title()), Action::Open(panel));
        Entry { words: panel.words().to_owned(), ..entry }
    };
    let page = |page: Page| {
        let (name, doc) = page.words();
        let entry = Entry::new("Panel", format!("Panel: Inspector, {name}"), Action::Do(Command::OpenInspector(page)));
        Entry { words: format!("polar plot curves {doc}"), ..entry }
    };
    let presets = Preset::ALL.into_iter().map(preset);
    let panels = Panel::GROUPS.concat().into_iter().map(panel).chain(Page::ALL.map(page));
    commands.into_iter().map(command).chain(presets).chain(panels).collect()
}

/// A mode with its keys.
fn of_mode(index: usize, mode: &Mode) -> Entry {
    let digit = (index < 10).then(|| char::from_digit((index as u32 + 1) % 10, 10)).flatten();
    let keys: Vec<String> =
        mode.key.map(|key| key.to_ascii_uppercase()).into_iter().chain(digit).map(String::from).collect();
    Entry {
        words: format!("{} {} {}", mode.slug, mode.group, mode.words),
        key: keys.join(" "),
        is_minor: mode.pass.is_some(),
        ..Entry::new("Mode", mode.name.clone(), Action::Mode(mode.slug.clone()))
    }
}

/// An entry that switches something on or off.
pub(super) fn switch(
    group: &'static str,
    label: &str,
    name: &str,
    is_on: bool,
    action: impl Fn(bool) -> Action,
) -> Entry {
    let turns = if is_on { "off" } else { "on" };
    Entry { words: name.to_owned(), ..Entry::new(group, format!("{label}: turn {turns}"), action(!is_on)) }
}

/// An entry for each choice of a constant or parameter.
fn choices<'a>(
    group: &'static str,
    label: &'a str,
    name: &'a str,
    choices: &'a [(String, i64)],
) -> impl Iterator<Item = Entry> + 'a {
    choices.iter().map(move |(choice, _)| {
        let action = Action::Value(name.to_owned(), ShaderValue::Name(choice.clone()));
        Entry { words: name.to_owned(), ..Entry::new(group, format!("{label}: {choice}"), action) }
    })
}

fn constants(entries: &mut Vec<Entry>, shaders: &ShaderSet, settings: &Settings) {
    for constant in &shaders.constants {
        let (name, label, default) = (&constant.name, &constant.label, default_of(constant));
        let group = if is_switch(shaders, name) { "Pass" } else { "Parameter" };
        let now = settings.shader.get(name).and_then(|value| number(value, &constant.choices)).unwrap_or(default);
        if constant.scalar == Scalar::Bool {
            let action = |on| Action::Value(name.clone(), ShaderValue::Bool(on));
            entries.push(switch(group, label, name, now != 0.0, action));
        } else if let Some(scale) = of_constant(constant) {
            let target = Target::Shader(name.clone(), constant.scalar != Scalar::Float);
            let (title, doc) = (label.clone(), constant.doc.clone());
            entries.push(Ask { title, group, doc, scale, now, target }.entry());
        }
        entries.extend(choices(group, label, name, &constant.choices));
    }
}

fn parameters(entries: &mut Vec<Entry>, shaders: &ShaderSet, settings: &Settings) {
    for parameter in &shaders.parameters {
        let (name, label) = (&parameter.name, &parameter.label);
        let is_of_pass = is_of_pass(shaders, parameter);
        let group = if is_of_pass { "Pass" } else { "Parameter" };
        let set = settings.shader.get(name).and_then(|value| number(value, &parameter.choices));
        let now = set.or_else(|| parameter.default.first().copied()).unwrap_or_default();
        if parameter.kind == ParameterType::Bool {
            let action = |on| Action::Value(name.clone(), ShaderValue::Bool(on));
            entries.push(switch(group, label, name, now != 0.0, action));
        } else if let Some(scale) = of_parameter(parameter) {
            let target = Target::Shader(name.clone(), parameter.kind != ParameterType::Float);
            let (title, doc) = (label.clone(), parameter.doc.clone());
            entries.push(Ask { title, group, doc, scale, now, target }.entry());
        } else if parameter.choices.is_empty() {
            // Colors and vectors have no single number to type.
            let panel = if is_of_pass { Panel::Passes } else { Panel::Parameters };
            entries.push(Entry { words: name.clone(), ..Entry::new(group, label.clone(), Action::Open(panel)) });
        }
        entries.extend(choices(group, label, name, &parameter.choices));
    }
}

fn passes(entries: &mut Vec<Entry>, shaders: &ShaderSet, settings: &Settings) {
    let internal = &shaders.graph.internal;
    for pass in shaders.graph.passes.iter().filter(|pass| pass.has_switch() && pass.desc.when.is_none()) {
        let action = |on| Action::Pass(pass.name().to_owned(), on);
        let entry = switch("Pass", &pass.desc.label, pass.name(), pass.is_wanted(&settings.passes), action);
        entries.push(Entry { is_minor: internal.contains(pass.name()), ..entry });
    }
}
