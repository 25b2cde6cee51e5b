//! The debug modes by group, as a gallery of thumbnails or as a list, with a search. The picture previews the mode that the mouse rests
//! on.

mod tile;

use std::collections::BTreeSet;

use egui::{RichText, Ui, vec2};

use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};

use crate::app::command::modes::{GRID, GridModes};
use crate::app::command::program::SAY;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::gallery::{Preview, Thumbnails};
use crate::app::state::grid::Grid;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, icon, small_mono};
use crate::shader::annotation::{Mode, listed};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Modes", Group::Modes, "debug gallery thumbnails side by side grid", || Box::<Modes>::default())
        .scrolls_itself();

/// Width of the button that switches between gallery and list, points.
const TOGGLE: f32 = 34.0;

/// The panel.
pub(super) struct Modes {
    search: String,
    /// Whether the modes are shown as thumbnails; else as a list.
    has_thumbnails: bool,
    /// Slug of the mode that the list was last scrolled to.
    scrolled_to: String,
    preview: Preview,
}

impl Default for Modes {
    fn default() -> Self {
        Self { search: String::new(), has_thumbnails: true, scrolled_to: String::new(), preview: Preview::default() }
    }
}

impl PanelUi for Modes {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        if context.state.session.shaders.is_none() {
            ui.label(RichText::new("Compiling shaders…").color(QUIET));
            return;
        }
        let grid = &context.state.grid;
        search_bar(ui, &mut self.search, &mut self.has_thumbnails);
        if grid.is_on() {
            side_by_side(ui, grid, commands);
        }
        let (clicked, hovered) = self.list(ui, context, commands);
        // Cells that change under the mouse would not be those that their names say.
        commands.sight.preview = self.preview.follow(ui.ctx(), hovered.filter(|_| !grid.is_on()));
        let Some(mode) = clicked else { return };
        if !ui.input(|input| input.modifiers.command) {
            commands.settings.mode.clone_from(&mode.slug);
            return;
        }
        match grid.toggled(&mode.slug, &commands.settings.mode).filter(|_| Grid::can_show(mode)) {
            Some(modes) => commands.push(GRID.with(GridModes { modes })),
            None => {
                let text = "At most nine modes fit side by side. Modes of random paths can only be shown alone";
                commands.push(SAY.with(text.into()));
            }
        }
    }
}

impl Modes {
    /// Shows the list. Returns the clicked mode, and the slug of the mode under the mouse.
    fn list<'m>(
        &mut self,
        ui: &mut Ui,
        context: &'m Context<'_>,
        commands: &mut Commands,
    ) -> (Option<&'m Mode>, Option<String>) {
        let (shaders, features) = (&context.shaders, context.state.session.features());
        let Commands { settings, sight, .. } = commands;
        let current = &settings.mode;
        let search = &self.search;
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
        let shown = egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let (columns, size) = tile::columns(ui.available_width());
            sight.thumbnail_size = size.into();
            let tiles = self.has_thumbnails.then_some(Tiles { columns, size, thumbnails: context.readings.thumbnails });
            let (beside, scrolled_to, in_sight) =
                (context.state.grid.modes(), &mut self.scrolled_to, &mut sight.thumbnails);
            let mut list = List { current, beside, scrolled_to, tiles, in_sight, clicked: None, hovered: None };
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
            (list.clicked, list.hovered)
        });
        shown.inner
    }
}

/// The search, and the button that switches between gallery and list.
fn search_bar(ui: &mut Ui, search: &mut String, has_thumbnails: &mut bool) {
    ui.horizontal(|ui| {
        search::field(ui, search, "modes", TOGGLE);
        let (symbol, hint) =
            if *has_thumbnails { (icon::LIST, "Show names only") } else { (icon::GRID_FOUR, "Show thumbnails") };
        let toggle = named(ui.add_sized([TOGGLE - 6.0, 18.0], egui::Button::new(symbol)), hint);
        if toggle.on_hover_text(hint).clicked() {
            *has_thumbnails ^= true;
        }
    });
}

/// The button that returns to the selected mode alone.
fn side_by_side(ui: &mut Ui, grid: &Grid, commands: &mut Commands) {
    let text = format!("{}  {} modes side by side", icon::SQUARES_FOUR, grid.modes().len());
    let close = egui::Button::new(RichText::new(text).small()).right_text(icon::X);
    let hint = "Click to show only the selected mode (Esc). Ctrl+click a mode to add or remove it";
    if ui.add(close.min_size(vec2(ui.available_width(), 18.0))).on_hover_text(hint).clicked() {
        commands.push(GRID.with(GridModes::default()));
    }
}

/// The list of modes.
struct List<'a, 'm> {
    /// Slug of the selected mode.
    current: &'a str,
    /// Slugs of the modes that are shown side by side.
    beside: &'a [String],
    scrolled_to: &'a mut String,
    /// How thumbnails are shown; `None` for a list of names.
    tiles: Option<Tiles<'a>>,
    /// Slugs of the modes whose thumbnails are in sight.
    in_sight: &'a mut BTreeSet<String>,
    clicked: Option<&'m Mode>,
    hovered: Option<String>,
}

/// The form of the thumbnails.
#[derive(Clone, Copy)]
struct Tiles<'a> {
    /// Tiles in a row.
    columns: usize,
    size: egui::Vec2,
    thumbnails: &'a Thumbnails,
}

impl<'m> List<'_, 'm> {
    /// Shows modes, each with its index in the shaders.
    fn show(&mut self, ui: &mut Ui, modes: &[(usize, &'m Mode)]) {
        match self.tiles {
            Some(Tiles { columns, .. }) => tile::grid(ui, columns, modes, |ui, mode| self.item(ui, *mode)),
            None => modes.iter().for_each(|mode| self.item(ui, *mode)),
        }
    }

    fn item(&mut self, ui: &mut Ui, (index, mode): (usize, &'m Mode)) {
        let is_current = self.current == mode.slug;
        let is_shown = is_current || self.beside.contains(&mode.slug);
        let response = match self.tiles {
            Some(Tiles { size, thumbnails, .. }) => {
                let key = keys(index, mode).first().copied();
                let (response, is_visible) = tile::show(ui, mode, key, is_shown, (thumbnails, size));
                if is_visible {
                    self.in_sight.insert(mode.slug.clone());
                }
                response
            }
            None => row(ui, index, mode, is_shown),
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
            self.hovered = Some(mode.slug.clone());
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
