//! The panel Scene: the parts of the model as a tree with a search, and below it what is selected, with the factors of its material.

mod details;
pub(super) mod material;
mod row;
mod title;
pub(super) mod tree;

use egui::{RichText, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::state::arrangement::Panel;
use crate::app::state::selection::Selected;
use crate::app::viewer::Viewer;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::QUIET;
use tree::Tree;

/// Height of the part about the selection at first, points.
const DETAILS: f32 = 300.0;

/// State of the panel between frames.
#[derive(Default)]
pub(in crate::app) struct SceneState {
    search: String,
    tree: Tree,
    counts: details::Counts,
    /// Whether the list must scroll to the selection, which was made elsewhere.
    follows: bool,
}

impl SceneState {
    /// Makes the list scroll to the selection.
    pub(in crate::app) fn follow(&mut self) {
        self.follows = true;
    }
}

pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, state: &mut SceneState, commands: &mut Vec<Command>) {
    let Some(scene) = viewer.session.scene() else {
        ui.label(RichText::new("No model yet").color(QUIET));
        return;
    };
    let selected = viewer.selected;
    if selected != Selected::Nothing {
        let below =
            egui::Panel::bottom("selection").resizable(true).default_size(DETAILS.min(0.6 * ui.available_height()));
        below.frame(egui::Frame::new().inner_margin(egui::Margin { top: 6, ..Default::default() })).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                details::show(ui, viewer, &scene, selected, &mut state.counts, commands);
            });
        });
    }
    ui.horizontal(|ui| {
        let settings = &viewer.session.settings.scene;
        let is_whole = settings.hidden.is_empty() && settings.isolated.is_empty();
        search::field(ui, &mut state.search, "nodes, materials, textures", if is_whole { 0.0 } else { 66.0 });
        if !is_whole && ui.small_button("Show all").on_hover_text("Draw everything that is hidden (Alt+H)").clicked() {
            commands.push(Command::ShowAll);
        }
    });
    if state.follows {
        state.tree.reveal(&scene, selected);
    }
    state.tree.update(&scene, &state.search);
    let rows = state.tree.rows().len();
    if rows == 0 {
        Words::new(&state.search).no_match(ui, "part of the scene");
        return;
    }
    let height = row::HEIGHT + ui.spacing().item_spacing.y;
    let mut area = ScrollArea::vertical().auto_shrink(false);
    if std::mem::take(&mut state.follows)
        && let Some(at) = state.tree.place(selected)
    {
        area = area.vertical_scroll_offset((at as f32 * height - 0.4 * ui.available_height()).max(0.0));
    }
    let (mut toggled, chosen_part) = (None, state.tree.part_of(selected));
    // Leaves room for the scroll bar also while there is none, so that the switches stay in place.
    let width = ui.available_width() - ui.spacing().scroll.allocated_width();
    area.show_rows(ui, row::HEIGHT, rows, |ui, range| {
        ui.set_max_width(width);
        for at in range {
            let row = &state.tree.rows()[at];
            let shown = row::State {
                is_drawn: row.item.is_none_or(|item| state.tree.is_drawn(item)),
                is_selected: row.item.is_some() && row.item == chosen_part,
                is_found: !state.search.is_empty(),
            };
            match row::show(ui, row, &shown) {
                Some(row::Action::Toggle) => toggled = Some(at),
                Some(row::Action::Select(item)) => {
                    commands.push(Command::Select(item));
                    if matches!(item, Selected::Texture(_)) {
                        commands.push(Command::OpenPanel(Panel::Texture));
                    }
                }
                Some(row::Action::LookThrough(camera)) => commands.push(Command::LookThrough(camera)),
                Some(row::Action::Show(key, is_shown)) => {
                    let settings = &mut viewer.session.settings.scene;
                    settings.hidden.retain(|name| *name != key);
                    if !is_shown {
                        settings.hidden.push(key);
                    }
                }
                None => {}
            }
        }
    });
    if let Some(at) = toggled {
        state.tree.toggle(at);
    }
}
