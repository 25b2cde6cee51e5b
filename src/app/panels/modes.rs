//! The debug modes by group, as a gallery of thumbnails or as a list, with a search. The picture previews the mode that the mouse rests
//! on.

mod tile;

use egui::{RichText, Ui, vec2};

use crate::app::gallery::GalleryState;
use crate::app::state::grid::Grid;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, icon, small_mono};
use crate::shader::ShaderSet;
use crate::shader::annotation::{Mode, listed};

/// Width of the button that switches between gallery and list, points.
const TOGGLE: f32 = 34.0;

/// State of the panel between frames.
#[derive(Default)]
pub(super) struct ModesState {
    search: String,
    /// Slug of the mode that the list was last scrolled to.
    scrolled_to: String,
}

/// Shows the modes. `current` is the slug of the selected mode. `features` are those of the model; modes for which it has no data
/// are folded away. Returns whether a mode that the user adds does not fit beside the others.
pub(super) fn show(
    ui: &mut Ui,
    shaders: Option<&ShaderSet>,
    features: Option<u32>,
    current: &mut String,
    grid: &mut Grid,
    (state, gallery): (&mut ModesState, &mut GalleryState),
) -> bool {
    let Some(shaders) = shaders else {
        ui.label(RichText::new("Compiling shaders…").color(QUIET));
        return false;
    };
    let ModesState { search, scrolled_to } = state;
    search_bar(ui, search, gallery);
    if grid.is_on() {
        side_by_side(ui, grid);
    }
    let words = Words::new(search);
    // In most frames nothing is searched, and no text is made for it.
    let is_found = |mode: &Mode| words.is_empty() || words.are_in(&text_of(mode));
    let place = |mode: &Mode| shaders.modes.iter().position(|other| std::ptr::eq(other, mode)).unwrap_or(0);
    let found =
        listed(&shaders.modes).into_iter().filter(|mode| is_found(mode)).map(|mode| (place(mode), mode)).collect();
    let found = best_first(found, &search.trim().to_lowercase());
    if found.is_empty() {
        words.no_match(ui, "mode");
    }
    // A search also shows modes without data, and the selected mode is never folded away.
    let has_data = |mode: &Mode| mode.has_data(features) || !words.is_empty() || *current == mode.slug;
    let clicked = egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let (columns, size) = tile::columns(ui.available_width());
        gallery.size = size;
        let mut list = List { current, beside: grid.modes(), scrolled_to, gallery, columns, clicked: None };
        for modes in found.chunk_by(|a, b| a.1.group == b.1.group) {
            let group = &modes[0].1.group;
            let (shown, folded): (Vec<_>, Vec<_>) = modes.iter().copied().partition(|(_, mode)| has_data(mode));
            ui.add_space(6.0);
            ui.label(RichText::new(group).small().color(QUIET));
            list.show(ui, &shown);
            if !folded.is_empty() {
                let title = RichText::new(format!("{} without data", folded.len())).small().color(QUIET);
                let header = egui::CollapsingHeader::new(title).id_salt(("without data", group));
                let header = header.show_unindented(ui, |ui| list.show(ui, &folded)).header_response;
                header.on_hover_text("The scene has no data for these modes");
            }
        }
        list.clicked
    });
    let Some(mode) = clicked.inner else { return false };
    if ui.input(|input| input.modifiers.command) {
        return !Grid::can_show(mode) || !grid.toggle(&mode.slug, current);
    }
    current.clone_from(&mode.slug);
    false
}

/// The search, and the button that switches between gallery and list.
fn search_bar(ui: &mut Ui, search: &mut String, gallery: &mut GalleryState) {
    ui.horizontal(|ui| {
        search::field(ui, search, "modes", TOGGLE);
        let (symbol, hint) =
            if gallery.is_on { (icon::LIST, "Show names only") } else { (icon::GRID_FOUR, "Show thumbnails") };
        let toggle = named(ui.add_sized([TOGGLE - 6.0, 18.0], egui::Button::new(symbol)), hint);
        if toggle.on_hover_text(hint).clicked() {
            gallery.is_on = !gallery.is_on;
        }
    });
}

/// The button that returns to the selected mode alone.
fn side_by_side(ui: &mut Ui, grid: &mut Grid) {
    let text = format!("{}  {} modes side by side", icon::SQUARES_FOUR, grid.modes().len());
    let close = egui::Button::new(RichText::new(text).small()).right_text(icon::X);
    let hint = "Click to show only the selected mode (Esc). Ctrl+click a mode to add or remove it";
    if ui.add(close.min_size(vec2(ui.available_width(), 18.0))).on_hover_text(hint).clicked() {
        grid.end();
    }
}

/// The list of modes.
struct List<'a, 'm> {
    /// Slug of the selected mode.
    current: &'a str,
    /// Slugs of the modes that are shown side by side.
    beside: &'a [String],
    scrolled_to: &'a mut String,
    gallery: &'a mut GalleryState,
    /// Tiles in a row of the gallery.
    columns: usize,
    clicked: Option<&'m Mode>,
}

impl<'m> List<'_, 'm> {
    /// Shows modes, each with its index in the shaders.
    fn show(&mut self, ui: &mut Ui, modes: &[(usize, &'m Mode)]) {
        match self.gallery.is_on {
            true => tile::grid(ui, self.columns, modes, |ui, mode| self.item(ui, *mode)),
            false => modes.iter().for_each(|mode| self.item(ui, *mode)),
        }
    }

    fn item(&mut self, ui: &mut Ui, (index, mode): (usize, &'m Mode)) {
        let is_current = self.current == mode.slug;
        let is_shown = is_current || self.beside.contains(&mode.slug);
        let response = match self.gallery.is_on {
            true => tile::show(ui, mode, keys(index, mode).first().copied(), is_shown, self.gallery),
            false => row(ui, index, mode, is_shown),
        };
        let response = response.on_hover_ui(|ui| {
            ui.set_max_width(ui.spacing().tooltip_width);
            let hint = "Ctrl+click to show it beside the others";
            ui.label(format!("{}\n\n--mode {}\n{hint}", mode.doc, mode.slug));
        });
        if is_current && *self.scrolled_to != mode.slug {
            self.scrolled_to.clone_from(&mode.slug);
            response.scroll_to_me(None);
        }
        // A path-traced frame takes seconds on a software device.
        if response.hovered() && !mode.accumulate && !mode.traces {
            self.gallery.hover(&mode.slug);
        }
        if response.clicked() {
            self.clicked = Some(mode);
        }
    }
}

/// Shows a mode with its keys at the right.
fn row(ui: &mut Ui, index: usize, mode: &Mode, is_current: bool) -> egui::Response {
    let keys = keys(index, mode).into_iter().map(String::from).collect::<Vec<_>>().join(" ");
    let keys = small_mono(keys).color(QUIET);
    let button =
        egui::Button::selectable(is_current, &mode.name).right_text(keys).min_size(vec2(ui.available_width(), 18.0));
    ui.add(button.truncate())
}

/// The keys that select a mode: its letter, and a digit for the first ten.
fn keys(index: usize, mode: &Mode) -> Vec<char> {
    let digit = (index < 10).then(|| char::from_digit((index as u32 + 1) % 10, 10)).flatten();
    mode.key.into_iter().chain(digit).collect()
}

/// Sorts found modes by how well their names match the search: those with this name first, with their group.
fn best_first<'a>(mut found: Vec<(usize, &'a Mode)>, search: &str) -> Vec<(usize, &'a Mode)> {
    if search.is_empty() {
        return found;
    }
    let rank = |mode: &Mode| match mode.name.to_lowercase() {
        name if name == search || mode.slug == search => 0,
        name if name.starts_with(search) => 1,
        name if name.contains(search) => 2,
        _ => 3,
    };
    // Groups stay whole.
    let mut groups: Vec<(&str, usize)> = Vec::new();
    for (_, mode) in &found {
        match groups.iter_mut().find(|(group, _)| *group == mode.group) {
            Some((_, best)) => *best = rank(mode).min(*best),
            None => groups.push((&mode.group, rank(mode))),
        }
    }
    groups.sort_by_key(|(_, best)| *best);
    found.sort_by_key(|(_, mode)| (groups.iter().position(|(group, _)| *group == mode.group), rank(mode)));
    found
}

/// The text that a search matches.
pub(super) fn text_of(mode: &Mode) -> String {
    format!("{} {} {} {} {}", mode.name, mode.slug, mode.group, mode.words, mode.doc)
}
