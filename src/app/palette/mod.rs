//! The command palette (Ctrl+P): finds modes, panels, files, switches, choices, numbers and commands by words of their names. The
//! value of a number is typed behind its name (`exposure 1.5`) or in a second step.

pub(super) mod entries;
mod entry;
mod paths;
mod row;
mod search;
mod settings;

use std::sync::Arc;

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Align2, Area, Id, Key, Order, RichText, TextEdit, Ui, vec2};

use super::command::registry::REGISTRY;
use super::command::settings::change;
use super::command::spec::Command;
use super::source_line::{SourceLine, watch};
use super::widgets::theme::{EDGE, ERROR, PANEL, QUIET, hide_hover_texts};
use crate::app::state::State;
use crate::app::state::dialog::Dialog;
use crate::app::state::listing::Listing;
use crate::scene::Model;
use crate::settings::Settings;
use crate::shader::{Expression, ShaderSet};
use entries::entries;
use entry::{Action, Ask, Entry};
use search::{Found, find};

/// Most rows of the list.
const ROWS: usize = 12;
/// Width in points.
const WIDTH: f32 = 480.0;
/// Height without the rows, in points.
const AROUND: f32 = 90.0;
/// Name of the field.
const SEARCH: &str = "palette search";

/// State of the palette between frames.
#[derive(Default)]
pub(super) struct Palette {
    is_open: bool,
    query: String,
    /// The chosen row.
    row: usize,
    /// The kind of file that a path in the query is chosen for.
    dialog: Option<Dialog>,
    /// The number that the palette asks for, and the text of its field.
    asks: Option<(Ask, String)>,
    /// Whether it has been shown. The click that opens it does not close it.
    is_shown: bool,
    entries: Vec<Entry>,
    /// The shaders whose expressions can be watched.
    shaders: Option<Arc<ShaderSet>>,
    /// The state that the entries describe.
    listed: Option<Revision>,
}

/// Everything on which the entries depend, but for files that are opened meanwhile.
struct Revision {
    settings: Arc<Settings>,
    model: Option<Arc<Model>>,
    generation: Option<u64>,
    shown: u64,
    restored: Option<u64>,
    is_comparing: bool,
}

impl Revision {
    fn is(&self, other: &Self) -> bool {
        let model = |revision: &Self| revision.model.as_ref().map(Arc::as_ptr);
        let rest = |revision: &Self| (revision.generation, revision.shown, revision.restored, revision.is_comparing);
        Arc::ptr_eq(&self.settings, &other.settings) && model(self) == model(other) && rest(self) == rest(other)
    }

    fn of(state: &State) -> Self {
        Self {
            settings: state.session.shared_settings(),
            model: state.session.model().cloned(),
            generation: state.session.shaders.as_ref().map(|shaders| shaders.generation),
            shown: state.shown_generation(),
            restored: state.edits.restored.as_ref().map(|restored| restored.number),
            is_comparing: state.compare.is_on(),
        }
    }
}

impl Palette {
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    pub(super) fn open(&mut self) {
        *self = Self { is_open: true, ..Self::default() };
    }

    /// Opens it with the files of the working directory.
    pub(super) fn choose_file(&mut self, dialog: Option<Dialog>) {
        let folder = std::env::current_dir().unwrap_or_default();
        let query = format!("{}/", folder.display().to_string().trim_end_matches('/'));
        *self = Self { is_open: true, query, dialog, ..Self::default() };
    }

    pub(super) fn toggle(&mut self) {
        *self = Self { is_open: !self.is_open, ..Self::default() };
    }
}

/// Shows the open palette over `area`, and gives the command that the user chooses.
pub(super) fn show(
    egui: &egui::Context,
    state: &State,
    palette: &mut Palette,
    area: egui::Rect,
    commands: &mut Vec<Command>,
) {
    if !palette.is_open {
        return;
    }
    let revision = Revision::of(state);
    if !palette.listed.as_ref().is_some_and(|listed| listed.is(&revision)) {
        (palette.listed, palette.entries) = (Some(revision), entries(state, REGISTRY));
        palette.shaders = state.session.shaders.clone();
    }
    let chosen = window(egui, &state.listing, palette, area, commands);
    if chosen.is_some() {
        *palette = Palette::default();
    }
    commands.extend(chosen);
}

/// Shows the search and the list, or asks for a number. Returns the chosen command.
fn window(
    egui: &egui::Context,
    listing: &Listing,
    palette: &mut Palette,
    area: egui::Rect,
    commands: &mut Vec<Command>,
) -> Option<Command> {
    if !palette.is_shown {
        // A menu would lie under it.
        egui::Popup::close_all(egui);
    }
    if egui.input(|input| input.key_pressed(Key::Escape)) {
        *palette = Palette::default();
        return None;
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
                None => list(ui, listing, palette, rows.clamp(3, ROWS), commands),
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

/// Puts the cursor of the search behind its text.
fn cursor_to_end(egui: &egui::Context, text: &str) {
    let id = Id::new(SEARCH);
    let mut state = TextEditState::load(egui, id).unwrap_or_default();
    state.cursor.set_char_range(Some(CCursorRange::one(CCursor::new(text.chars().count()))));
    state.store(egui, id);
}

/// A line of text that has the keys.
fn field(ui: &mut Ui, text: &mut String, hint: &str) -> egui::Response {
    let id = Id::new(SEARCH);
    // Keys of the same frame are already the search's.
    if !ui.memory(|memory| memory.has_focus(id)) {
        ui.memory_mut(|memory| memory.request_focus(id));
        cursor_to_end(ui.ctx(), text);
    }
    let field = TextEdit::singleline(text).id(id).desired_width(f32::INFINITY).margin(vec2(6.0, 5.0));
    ui.add(field.background_color(EDGE.color()).hint_text(hint))
}

/// Shows the search and the list. Returns the chosen command.
fn list(
    ui: &mut Ui,
    listing: &Listing,
    palette: &mut Palette,
    rows: usize,
    commands: &mut Vec<Command>,
) -> Option<Command> {
    // Before the field takes the arrows and Tab.
    let (step, completes) = ui.input_mut(|input| {
        let down = input.count_and_consume_key(egui::Modifiers::NONE, Key::ArrowDown);
        let step = down as isize - input.count_and_consume_key(egui::Modifiers::NONE, Key::ArrowUp) as isize;
        (step, input.consume_key(egui::Modifiers::NONE, Key::Tab))
    });
    if field(ui, &mut palette.query, "Find a mode, setting, panel or command, or type a path").changed() {
        palette.row = 0;
    }
    let query = palette.query.clone();
    // The text and the Enter behind it may come in one frame, so the entries are made from the text as it is now.
    let expression = expression(&query, palette.shaders.as_deref());
    let paths = paths::entries(listing, &query, palette.dialog, commands);
    let found = match &paths {
        Some(paths) => paths.iter().map(|entry| Found { entry, marks: Vec::new(), typed: None }).collect(),
        None => find(expression.iter().chain(&palette.entries), &query),
    };
    palette.row = palette.row.saturating_add_signed(step).min(found.len().saturating_sub(1));
    if found.is_empty() {
        ui.label(RichText::new(if paths.is_some() { "No file that can be opened" } else { "No match" }).color(QUIET));
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
    let is_complete = |found: &&Found<'_>| matches!(found.entry.action, Action::Complete(_));
    if completes {
        chosen = found.get(palette.row).filter(is_complete).or_else(|| found.iter().find(is_complete));
    } else if ui.input(|input| input.key_pressed(Key::Enter)) {
        chosen = chosen.or_else(|| found.get(palette.row));
    }
    let Found { entry, typed, .. } = chosen?;
    match &entry.action {
        Action::Run(command) => Some(command.clone()),
        Action::Complete(query) => {
            (palette.query, palette.row) = (query.clone(), 0);
            cursor_to_end(ui.ctx(), query);
            None
        }
        Action::Number(ask) => {
            let typed = typed.unwrap_or_default();
            let value = ask.scale.parse(typed);
            if value.is_err() {
                palette.asks = Some((*ask.clone(), typed.to_owned()));
            }
            value.ok().map(|value| ask.command(value))
        }
    }
}

/// The entry that watches the expression which the query names, unless no pixel shows values of its file.
fn expression(query: &str, shaders: Option<&ShaderSet>) -> Option<Entry> {
    let expression = Expression::parse(query, 0).ok()?;
    let place = shaders.and_then(|shaders| Some((shaders, SourceLine::place(shaders, query)?.0)));
    if place.is_some_and(|(shaders, path)| !shaders.can_watch(path)) {
        return None;
    }
    let at = expression.to_string();
    let command = change(format!("watch {at}"), move |settings| watch(settings, at.clone()));
    let entry = Entry::new("Expression", format!("Watch {}", query.trim()), command);
    Some(entry.words(query))
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

/// Asks for a number. Returns the command that sets it.
fn number(ui: &mut Ui, ask: &Ask, text: &mut String) -> Option<Command> {
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
    Some(ask.command(value))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::shader::TreePath;

    #[test]
    fn only_expressions_that_a_pixel_shows_are_offered() {
        let texts = BTreeMap::from([(TreePath::from("pbr.vert"), Arc::<str>::from("void main() {}\n"))]);
        let shaders = ShaderSet { texts, ..ShaderSet::default() };
        assert!(expression("pbr.vert:1:x", Some(&shaders)).is_none());
        assert!(expression("other.glsl:1:x", Some(&shaders)).is_some(), "the compiler says why it cannot be watched");
        assert!(expression("pbr.vert:1:x", None).is_some(), "nothing is known before the first shaders");
    }
}
