//! The command palette (Ctrl+P): finds modes, panels, environments, switches, choices and commands by words of their names.

use clap::ValueEnum as _;
use egui::{Align2, Area, Id, Key, Order, RichText, TextEdit, Ui, vec2};

use super::command::Command;
use super::layout::{Layout, Panel, Preset};
use super::panels::theme::{EDGE, PANEL, QUIET};
use super::viewer::Viewer;
use crate::scene::environment::BUILT_IN;
use crate::settings::{LightSource, ShaderValue, Tonemap};
use crate::shader::ShaderSet;
use crate::shader::values::number;

/// Rows of the list.
const ROWS: usize = 12;
const WIDTH: f32 = 460.0;

/// State of the palette between frames.
#[derive(Default)]
pub(super) struct Palette {
    is_open: bool,
    query: String,
    /// The chosen row.
    row: usize,
    /// Whether it has been shown. The click that opens it does not close it.
    is_shown: bool,
}

/// What an entry does.
#[derive(Clone)]
enum Action {
    Mode(String),
    Do(Command),
    Environment(String),
    Lights(LightSource),
    Tonemap(Tonemap),
    /// A value of a parameter or constant of the shaders.
    Value(String, ShaderValue),
    Pass(String, bool),
    Open(Panel),
    Arrange(Preset),
    TogglePanels,
    ShowKeys,
}

/// A row that the palette can show.
struct Entry {
    group: &'static str,
    title: String,
    /// More words by which it is found.
    words: String,
    action: Action,
}

impl Palette {
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    pub(super) fn open(&mut self) {
        *self = Self { is_open: true, ..Self::default() };
    }

    pub(super) fn toggle(&mut self) {
        *self = Self { is_open: !self.is_open, ..Self::default() };
    }
}

/// Shows the open palette over `area`, and does what the user chooses.
pub(super) fn show(egui: &egui::Context, viewer: &mut Viewer, area: egui::Rect, commands: &mut Vec<Command>) {
    if !viewer.panels.palette.is_open {
        return;
    }
    let mut palette = std::mem::take(&mut viewer.panels.palette);
    let entries = entries(viewer);
    let chosen = window(egui, &mut palette, &entries, area);
    palette.is_open &= chosen.is_none();
    viewer.panels.palette = palette;
    if let Some(action) = chosen {
        act(viewer, action, commands);
    }
}

/// Shows the search and the list. Returns the action of the chosen entry.
fn window(egui: &egui::Context, palette: &mut Palette, entries: &[Entry], area: egui::Rect) -> Option<Action> {
    if egui.input(|input| input.key_pressed(Key::Escape)) {
        palette.is_open = false;
        return None;
    }
    // Before the field takes the arrows.
    let step = egui.input_mut(|input| {
        let down = input.count_and_consume_key(egui::Modifiers::NONE, Key::ArrowDown);
        down as isize - input.count_and_consume_key(egui::Modifiers::NONE, Key::ArrowUp) as isize
    });
    let width = WIDTH.min(area.width() - 24.0);
    let at = area.center_top() + vec2(0.0, 48.0_f32.min(0.1 * area.height()));
    let area = Area::new(Id::new("palette")).order(Order::Foreground).pivot(Align2::CENTER_TOP).fixed_pos(at);
    let mut chosen = None;
    let shown = area.fade_in(false).show(egui, |ui| {
        let frame = egui::Frame::popup(ui.style()).fill(PANEL).inner_margin(8);
        frame.show(ui, |ui| {
            ui.set_width(width);
            let id = Id::new("palette search");
            // Keys of the same frame are already the search's.
            if !ui.memory(|memory| memory.has_focus(id)) {
                ui.memory_mut(|memory| memory.request_focus(id));
            }
            let field = TextEdit::singleline(&mut palette.query).id(id).desired_width(f32::INFINITY);
            let field = field.background_color(EDGE).hint_text("Find a mode, setting, panel or command");
            if ui.add(field).changed() {
                palette.row = 0;
            }
            let found = find(entries, &palette.query);
            palette.row = palette.row.saturating_add_signed(step).min(found.len().saturating_sub(1));
            if found.is_empty() {
                ui.label(RichText::new("Nothing has these words").color(QUIET));
            }
            let first = palette.row.saturating_sub(ROWS - 1);
            for (index, entry) in found.iter().enumerate().skip(first).take(ROWS) {
                if row(ui, entry, index == palette.row) {
                    chosen = Some(entry.action.clone());
                }
            }
            if ui.input(|input| input.key_pressed(Key::Enter)) {
                chosen = chosen.take().or_else(|| found.get(palette.row).map(|entry| entry.action.clone()));
                palette.is_open = false;
            }
        });
    });
    if std::mem::replace(&mut palette.is_shown, true) && shown.response.clicked_elsewhere() {
        palette.is_open = false;
    }
    chosen
}

/// Shows a row. Returns whether it was clicked.
fn row(ui: &mut Ui, entry: &Entry, is_chosen: bool) -> bool {
    let size = vec2(ui.available_width(), 22.0);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    if is_chosen || response.hovered() {
        let fill = if is_chosen { ui.visuals().selection.bg_fill } else { EDGE };
        ui.painter().rect_filled(rect, 3.0, fill);
    }
    let text = rect.shrink2(vec2(6.0, 0.0));
    let color = if is_chosen { egui::Color32::WHITE } else { ui.visuals().text_color() };
    let font = egui::TextStyle::Body.resolve(ui.style());
    let small = egui::TextStyle::Small.resolve(ui.style());
    ui.painter().text(text.left_center(), Align2::LEFT_CENTER, &entry.title, font, color);
    let quiet = if is_chosen { egui::Color32::WHITE } else { QUIET };
    ui.painter().text(text.right_center(), Align2::RIGHT_CENTER, entry.group, small, quiet);
    response.clicked()
}

/// The entries that have all words of the query. Those whose title begins with it come first, then those whose title has it.
fn find<'a>(entries: &'a [Entry], query: &str) -> Vec<&'a Entry> {
    let query = query.trim().to_lowercase();
    let words: Vec<&str> = query.split_whitespace().collect();
    let mut found: Vec<(usize, &Entry)> = Vec::new();
    for entry in entries {
        let title = entry.title.to_lowercase();
        let text = format!("{title} {} {}", entry.group.to_lowercase(), entry.words.to_lowercase());
        if words.iter().all(|word| text.contains(word)) {
            let rank = match title {
                title if title == query => 0,
                title if title.starts_with(&query) => 1,
                title if words.iter().all(|word| title.contains(word)) => 2,
                _ => 3,
            };
            found.push((rank, entry));
        }
    }
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, entry)| entry).collect()
}

fn entries(viewer: &Viewer) -> Vec<Entry> {
    let mut entries = commands();
    let mut add = |group, title: String, words: String, action| entries.push(Entry { group, title, words, action });
    for name in BUILT_IN.into_iter().chain(["none"]).chain(viewer.panels.environments.iter().map(String::as_str)) {
        add("Environment", format!("Environment: {name}"), String::new(), Action::Environment(name.to_owned()));
    }
    for name in crate::scene::BUILT_IN {
        add("Model", format!("Model: {name}"), String::new(), Action::Do(Command::OpenModel(name.into())));
    }
    for source in LightSource::value_variants() {
        let name = name_of(source);
        add("Lights", format!("Lights: {name}"), String::new(), Action::Lights(*source));
    }
    for tonemap in Tonemap::value_variants() {
        let name = name_of(tonemap);
        add("Output", format!("Tone map: {name}"), String::new(), Action::Tonemap(*tonemap));
    }
    if let Some(shaders) = &viewer.session.shaders {
        of_shaders(&mut entries, shaders, viewer);
    }
    entries
}

/// The name of a choice on the command line.
fn name_of(value: &impl clap::ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

/// Commands, panels and arrangements.
fn commands() -> Vec<Entry> {
    let commands = [
        ("Frame the model", "camera R", Action::Do(Command::FrameModel)),
        ("Reload all shaders", "compile F5", Action::Do(Command::Reload)),
        ("Undo", "Ctrl+Z", Action::Do(Command::Undo)),
        ("Redo", "Ctrl+Shift+Z", Action::Do(Command::Redo)),
        ("Screenshot", "capture PNG F12", Action::Do(Command::Screenshot)),
        ("Keys", "shortcuts help F1", Action::ShowKeys),
        ("Hide or show the panels", "H", Action::TogglePanels),
        ("Quit", "close Ctrl+Q", Action::Do(Command::Quit)),
    ];
    let entry = |group, title: String, words: &str, action| Entry { group, title, words: words.into(), action };
    let mut entries: Vec<Entry> = Vec::new();
    entries.extend(commands.map(|(title, words, action)| entry("Command", title.into(), words, action)));
    for preset in Preset::ALL {
        entries.push(entry("Layout", format!("Layout: {}", preset.title()), preset.doc(), Action::Arrange(preset)));
    }
    for panel in Panel::GROUPS.concat() {
        entries.push(entry("Panel", format!("Panel: {}", panel.title()), "", Action::Open(panel)));
    }
    entries
}

/// Modes, and what the tree declares: switches, choices, numbers and passes.
fn of_shaders(entries: &mut Vec<Entry>, shaders: &ShaderSet, viewer: &Viewer) {
    let values = &viewer.session.settings.shader;
    let mut add = |group, title: String, words: String, action| entries.push(Entry { group, title, words, action });
    for mode in &shaders.modes {
        add("Mode", mode.name.clone(), format!("{} {}", mode.slug, mode.group), Action::Mode(mode.slug.clone()));
    }
    let constants = shaders.constants.iter().map(|constant| {
        let is_switch = constant.scalar == crate::shader::spirv::reflect::Scalar::Bool;
        (&constant.name, &constant.label, &constant.choices, is_switch, constant.default != 0)
    });
    let parameters = shaders.parameters.iter().map(|parameter| {
        let is_switch = parameter.kind == crate::shader::annotation::ParameterType::Bool;
        let is_on = parameter.default.first().is_some_and(|value| *value != 0.0);
        (&parameter.name, &parameter.label, &parameter.choices, is_switch, is_on)
    });
    for (name, label, choices, is_switch, default) in constants.chain(parameters) {
        if is_switch {
            let value = values.get(name).and_then(|value| number(value, choices));
            let turns = if value.map_or(default, |value| value != 0.0) { "off" } else { "on" };
            let action = Action::Value(name.clone(), ShaderValue::Bool(turns == "on"));
            add("Parameter", format!("{label}: turn {turns}"), name.clone(), action);
        } else if choices.is_empty() {
            add("Parameter", label.clone(), name.clone(), Action::Open(Panel::Parameters));
        }
        for (choice, _) in choices {
            let action = Action::Value(name.clone(), ShaderValue::Name(choice.clone()));
            add("Parameter", format!("{label}: {choice}"), name.clone(), action);
        }
    }
    for pass in shaders.graph.passes.iter().filter(|pass| pass.has_switch() && pass.note.when.is_none()) {
        let is_on = pass.is_wanted(&viewer.session.settings.passes);
        let (turns, action) = (if is_on { "off" } else { "on" }, Action::Pass(pass.name().to_owned(), !is_on));
        add("Pass", format!("{}: turn {turns}", pass.note.label), pass.name().to_owned(), action);
    }
}

fn act(viewer: &mut Viewer, action: Action, commands: &mut Vec<Command>) {
    let settings = &mut viewer.session.settings;
    match action {
        Action::Mode(slug) => settings.mode = slug,
        Action::Do(command) => commands.push(command),
        Action::Environment(name) => settings.environment.name = name,
        Action::Lights(source) => settings.lights.source = source,
        Action::Tonemap(tonemap) => settings.view.tonemap = tonemap,
        Action::Value(name, value) => drop(settings.shader.insert(name, value)),
        Action::Pass(name, on) => drop(settings.passes.insert(name, on)),
        Action::Open(panel) => {
            viewer.panels.visible = true;
            viewer.panels.layout.open(panel);
        }
        Action::Arrange(preset) => {
            viewer.panels.visible = true;
            viewer.panels.layout = Layout::of(preset);
        }
        Action::TogglePanels => viewer.panels.visible ^= true,
        Action::ShowKeys => viewer.panels.show_keys = true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn titles(query: &str) -> Vec<String> {
        find(&commands(), query).into_iter().map(|entry| entry.title.clone()).collect()
    }

    #[test]
    fn words_are_found_in_any_order_and_titles_first() {
        assert_eq!(titles("panel output"), ["Panel: Output"]);
        assert_eq!(titles("OUT panel"), ["Panel: Output"]);
        assert_eq!(titles("undo")[0], "Undo");
        assert_eq!(titles("f12"), ["Screenshot"]);
        assert_eq!(titles("camera")[0], "Panel: Camera", "a title comes before a word of another entry");
        assert!(titles("no such words").is_empty());
        assert_eq!(titles("").len(), commands().len());
    }
}
