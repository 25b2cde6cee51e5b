//! The command palette (Ctrl+P): finds modes, panels, files, switches, choices, numbers and commands by words of their names. The
//! value of a number is typed behind its name (`exposure 1.5`) or in a second step.

mod act;
mod ask;
mod entries;
mod row;
mod search;
mod settings;

use egui::{Align2, Area, Id, Key, Order, RichText, TextEdit, Ui, vec2};
use serde::Serialize;

use super::commands::Commands;
use super::widgets::theme::{EDGE, ERROR, PANEL, QUIET, hide_hover_texts};
use crate::app::engine::Engine;
use crate::app::execute::execute;
use crate::app::state::State;
use crate::message::did_you_mean;
use crate::shader::Expression;
use act::act;
use ask::Ask;
use entries::{Action, Entry, entries};
use search::{Found, find};

/// Most rows of the list.
const ROWS: usize = 12;
/// Width in points.
const WIDTH: f32 = 480.0;
/// Height without the rows, in points.
const AROUND: f32 = 90.0;

/// State of the palette between frames.
#[derive(Default)]
pub(super) struct Palette {
    is_open: bool,
    query: String,
    /// The chosen row.
    row: usize,
    /// The number that the palette asks for, and the text of its field.
    asks: Option<(Ask, String)>,
    /// Whether it has been shown. The click that opens it does not close it.
    is_shown: bool,
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

/// An entry, as the command `entries` tells it.
#[derive(Serialize)]
pub(super) struct Listed {
    group: &'static str,
    entry: String,
    /// Whether it is the choice in force.
    now: bool,
}

/// Everything that the palette can do at the moment.
pub(super) fn listed(state: &State) -> Vec<Listed> {
    let listed = |entry: Entry| Listed { group: entry.group, entry: entry.title, now: entry.is_in_force };
    entries(state).into_iter().map(listed).collect()
}

/// Does what the entry with this title does. `value` is for an entry that sets a number.
///
/// # Errors
/// A message: no entry has the title, or the value does not fit.
pub(super) fn run(state: &mut State, engine: &mut Engine, title: &str, value: Option<f64>) -> Result<(), String> {
    let entries = entries(state);
    let Some(entry) = entries.iter().find(|entry| entry.title.eq_ignore_ascii_case(title)) else {
        let hint = did_you_mean(title, entries.iter().map(|entry| entry.title.as_str()));
        return Err(format!("the palette has no entry `{title}`.{hint} `entries` lists them all"));
    };
    let action = match (&entry.action, value) {
        (Action::Number(ask), Some(value)) => {
            let value = ask.scale.parse(&value.to_string()).map_err(|why| format!("`{}`: {why}", entry.title))?;
            Action::Number(Box::new(ask.with(value)))
        }
        (Action::Number(ask), None) => {
            return Err(format!("`{}` needs a `value`: {}", entry.title, ask.scale.range_text()));
        }
        (_, Some(_)) => return Err(format!("`{}` takes no value", entry.title)),
        (action, None) => action.clone(),
    };
    let mut commands = Vec::new();
    act(action, &mut state.session.settings, &mut commands);
    commands.into_iter().for_each(|command| execute(state, engine, command));
    Ok(())
}

/// Shows the open palette over `area`, and does what the user chooses.
pub(super) fn show(
    egui: &egui::Context,
    state: &State,
    palette: &mut Palette,
    area: egui::Rect,
    commands: &mut Commands,
) {
    if !palette.is_open {
        return;
    }
    let mut entries = entries(state);
    let chosen = window(egui, palette, &mut entries, area);
    palette.is_open &= chosen.is_none();
    if let Some(action) = chosen {
        act(action, &mut commands.settings, &mut commands.list);
    }
}

/// Shows the search and the list, or asks for a number. Returns the chosen action.
fn window(egui: &egui::Context, palette: &mut Palette, entries: &mut Vec<Entry>, area: egui::Rect) -> Option<Action> {
    if egui.input(|input| input.key_pressed(Key::Escape)) {
        // Back from a number to the list.
        palette.is_open = palette.asks.take().is_some();
        if !palette.is_open {
            return None;
        }
    }
    let width = WIDTH.min(area.width() - 24.0);
    let top = 48.0_f32.min(0.1 * area.height());
    let rows = ((area.height() - top - AROUND) / (row::HEIGHT + egui.global_style().spacing.item_spacing.y)) as usize;
    let at = area.center_top() + vec2(0.0, top);
    let popup = Area::new(Id::new("palette")).order(Order::Foreground).pivot(Align2::CENTER_TOP).fixed_pos(at);
    let shown = popup.fade_in(false).show(egui, |ui| {
        let frame = egui::Frame::popup(ui.style()).fill(PANEL.color()).inner_margin(8);
        let content = |ui: &mut Ui| {
            ui.set_width(width);
            match &mut palette.asks {
                Some((ask, text)) => number(ui, ask, text),
                None => list(ui, palette, entries, rows.clamp(3, ROWS)),
            }
        };
        frame.show(ui, content).inner
    });
    hide_hover_texts(egui);
    if std::mem::replace(&mut palette.is_shown, true) && shown.response.clicked_elsewhere() {
        palette.is_open = false;
    }
    shown.inner
}

/// A line of text that has the keys.
fn field(ui: &mut Ui, text: &mut String, hint: &str) -> egui::Response {
    let id = Id::new("palette search");
    // Keys of the same frame are already the search's.
    if !ui.memory(|memory| memory.has_focus(id)) {
        ui.memory_mut(|memory| memory.request_focus(id));
    }
    let field = TextEdit::singleline(text).id(id).desired_width(f32::INFINITY);
    ui.add(field.background_color(EDGE.color()).hint_text(hint))
}

/// Shows the search and the list. Returns the chosen action.
fn list(ui: &mut Ui, palette: &mut Palette, entries: &mut Vec<Entry>, rows: usize) -> Option<Action> {
    // Before the field takes the arrows.
    let step = ui.input_mut(|input| {
        let down = input.count_and_consume_key(egui::Modifiers::NONE, Key::ArrowDown);
        down as isize - input.count_and_consume_key(egui::Modifiers::NONE, Key::ArrowUp) as isize
    });
    if field(ui, &mut palette.query, "Find a mode, setting, panel or command").changed() {
        palette.row = 0;
    }
    let query = palette.query.clone();
    // The text and the Enter behind it may come in one frame, so the entry is made from the text as it is now.
    entries.splice(0..0, expression(&query));
    let found = find(entries, &query);
    palette.row = palette.row.saturating_add_signed(step).min(found.len().saturating_sub(1));
    if found.is_empty() {
        ui.label(RichText::new("No match").color(QUIET));
    }
    let first = (palette.row + 1).saturating_sub(rows);
    let mut chosen = None;
    for (index, found) in found.iter().enumerate().skip(first).take(rows) {
        if row::show(ui, found, &note(found), index == palette.row) {
            chosen = Some(found);
        }
    }
    if found.len() > rows {
        let last = (first + rows).min(found.len());
        let text = format!("{} to {last} of {}", first + 1, found.len());
        ui.label(RichText::new(text).small().color(QUIET)).on_hover_text("Arrow keys show the others");
    }
    if ui.input(|input| input.key_pressed(Key::Enter)) {
        chosen = chosen.or_else(|| found.get(palette.row));
    }
    choose(palette, chosen?)
}

/// The entry that watches the expression which the query names.
fn expression(query: &str) -> Option<Entry> {
    let expression = Expression::parse(query, 0).ok()?;
    let entry = Entry::new("Expression", format!("Watch {}", query.trim()), Action::Watch(expression.to_string()));
    Some(Entry { words: query.to_owned(), ..entry })
}

/// The text at the right of a title: the key, or the number that the query sets.
fn note(found: &Found<'_>) -> String {
    match (&found.entry.action, found.typed) {
        (Action::Number(ask), Some(typed)) => {
            let value = ask.scale.parse(typed);
            value.map_or_else(|message| message, |value| format!("= {}", ask.scale.text(value)))
        }
        _ => found.entry.key.clone(),
    }
}

/// The action of a chosen entry, unless that asks for a number first.
fn choose(palette: &mut Palette, found: &Found<'_>) -> Option<Action> {
    let Action::Number(ask) = &found.entry.action else { return Some(found.entry.action.clone()) };
    let typed = found.typed.unwrap_or_default();
    let Ok(value) = ask.scale.parse(typed) else {
        palette.asks = Some((*ask.clone(), typed.to_owned()));
        return None;
    };
    Some(Action::Number(Box::new(ask.with(value))))
}

/// Asks for a number. Returns the action that sets it.
fn number(ui: &mut Ui, ask: &Ask, text: &mut String) -> Option<Action> {
    ui.label(RichText::new(&ask.title).strong());
    field(ui, text, &ask.scale.text(ask.now));
    let value = ask.scale.parse(text);
    let about = match &value {
        Err(message) if !text.trim().is_empty() => RichText::new(message).small().color(ERROR),
        _ => RichText::new(format!("{}, now {}", ask.scale.range_text(), ask.scale.text(ask.now))).small().color(QUIET),
    };
    ui.label(about);
    if !ask.doc.is_empty() {
        ui.label(RichText::new(&ask.doc).small().color(QUIET));
    }
    let value = value.ok().filter(|_| ui.input(|input| input.key_pressed(Key::Enter)))?;
    Some(Action::Number(Box::new(ask.with(value))))
}
