//! The panel Scene: the parts of the model as a tree with a search, and below it what is selected, with the factors of its material.

mod details;
pub(super) mod material;
mod row;
pub(super) mod rows;
mod title;
mod tree;

use std::time::Duration;

use egui::{RichText, ScrollArea, Ui};

use crate::app::command::camera::LOOK_THROUGH;
use crate::app::command::layout::OPEN_PANEL;
use crate::app::command::scene::{SELECT, SHOW_ALL};
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::selection::Selected;
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ERROR, QUIET};
use crate::frame::Scene;
use crate::message::grouped;
use tree::{Listed, Tree};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Scene", Group::Modes, "nodes meshes materials textures cameras lights", || {
        Box::<SceneState>::default()
    });

/// Height of the part about the selection at first, points.
const DETAILS: f32 = 300.0;

/// Time between two looks whether the rows are there.
const POLL: Duration = Duration::from_millis(16);

/// State of the panel between frames.
#[derive(Default)]
pub(in crate::app) struct SceneState {
    search: String,
    tree: Tree,
    counts: details::Counts,
    /// Whether the list must scroll to the selection, which was made elsewhere.
    follows: bool,
}

impl PanelUi for SceneState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        match &context.scene {
            Some(scene) => show(ui, (context.state, scene), self, commands),
            None => _ = ui.label(RichText::new("No model yet").color(QUIET)),
        }
    }

    fn on_request(&mut self, request: &PanelRequest) {
        self.follows |= *request == PanelRequest::FollowSelection;
    }
}

fn show(ui: &mut Ui, (state, scene): (&State, &Scene), own: &mut SceneState, commands: &mut Commands) {
    let selected = state.selected;
    if selected != Selected::Nothing {
        let below =
            egui::Panel::bottom("selection").resizable(true).default_size(DETAILS.min(0.6 * ui.available_height()));
        below.frame(egui::Frame::new().inner_margin(egui::Margin { top: 6, ..Default::default() })).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                details::show(ui, (state, scene), selected, &mut own.counts, commands);
            });
        });
    }
    ui.horizontal(|ui| {
        let settings = &commands.settings.scene;
        let is_whole = settings.hidden.is_empty() && settings.isolated.is_empty();
        search::field(ui, &mut own.search, "nodes, materials, textures", if is_whole { 0.0 } else { 66.0 });
        if !is_whole && ui.small_button("Show all").on_hover_text("Draw everything that is hidden (Alt+H)").clicked() {
            commands.push(SHOW_ALL.with(()));
        }
    });
    match own.tree.list(scene.loaded()) {
        Listed::Ready => {}
        Listed::Coming => {
            let nodes = grouped(scene.loaded().nodes.len() as f64);
            ui.label(RichText::new(format!("Listing {nodes} nodes…")).color(QUIET));
            return ui.ctx().request_repaint_after(POLL);
        }
        Listed::Failed(why) => {
            let text = format!("Specula could not list the parts of this model. This is a bug: {why}");
            ui.label(RichText::new(text).color(ERROR));
            return;
        }
    }
    if own.follows {
        own.tree.reveal(scene, selected);
    }
    own.tree.update(scene, &own.search);
    let rows = own.tree.len();
    if rows == 0 {
        Words::new(&own.search).no_match(ui, "part of the scene");
        return;
    }
    let height = row::HEIGHT + ui.spacing().item_spacing.y;
    let mut area = ScrollArea::vertical().auto_shrink(false);
    if std::mem::take(&mut own.follows)
        && let Some(at) = own.tree.place(selected)
    {
        area = area.vertical_scroll_offset((at as f32 * height - 0.4 * ui.available_height()).max(0.0));
    }
    let (mut toggled, chosen_part) = (None, own.tree.part_of(selected));
    // Leaves room for the scroll bar also while there is none, so that the switches stay in place.
    let width = ui.available_width() - ui.spacing().scroll.allocated_width();
    area.show_rows(ui, row::HEIGHT, rows, |ui, range| {
        ui.set_max_width(width);
        for at in range {
            let Some(row) = own.tree.row(at) else { continue };
            let shown = row::RowState {
                is_wanted: row.item.is_none_or(|item| own.tree.is_wanted(item)),
                is_visible: row.item.is_none_or(|item| own.tree.is_visible(item)),
                is_selected: row.item.is_some() && row.item == chosen_part,
                is_found: !own.search.is_empty(),
            };
            match row::show(ui, row, &shown) {
                Some(row::Action::Toggle) => toggled = Some(at),
                Some(row::Action::Select(item)) => {
                    commands.push(SELECT.with(item));
                    if matches!(item, Selected::Texture(_)) {
                        commands.push(OPEN_PANEL.with(Panel::TEXTURE));
                    }
                }
                Some(row::Action::LookThrough(camera)) => commands.push(LOOK_THROUGH.with(camera)),
                Some(row::Action::Show(key, is_shown)) => {
                    let settings = &mut commands.settings.scene;
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
        own.tree.toggle(at);
    }
}
