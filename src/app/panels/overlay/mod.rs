//! The overlay: diagnostics, messages, loading state, the legend of the mode, handles, and names over the picture.

mod card;
mod compare;
mod diagnostics;
mod gizmo;
mod grid;
mod hint;
mod labels;
pub(in crate::app) mod legend;
mod light;
mod marks;
mod preview;
mod restore;
pub(in crate::app) mod swatches;
mod version;
mod watched;

use egui::{Align2, Id, Rect, RichText, TextStyle};

use super::inspector::marker;
use crate::app::command::layout::PANELS;
use crate::app::command::program::HIDE_WARNINGS;
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::state::State;
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::theme::{LINE, WARNING};
use crate::shader::Diagnostic;
use card::{area, card, wrapped};
use compare::ShownMap;
use diagnostics::{Files, Shown};
use gizmo::Gizmo;
use labels::Labels;
use legend::{Legend, LegendState};
use marks::Marks;

/// Maximum number of model warnings to show. The rest is counted.
const MODEL_WARNINGS: usize = 4;
/// A passing message needs this many points above the diagnostics.
const NOTICE: f32 = 60.0;
/// Height of the names of what is compared, below the picture, points.
const NAMES: f32 = 36.0;

/// State of the overlay between frames.
#[derive(Default)]
pub(in crate::app) struct Overlay {
    legend: LegendState,
    files: Files,
    /// The diagnostics that the user has hidden. Others are shown again.
    hidden: Vec<Diagnostic>,
    gizmo: Gizmo,
    labels: Labels,
    map: ShownMap,
    marks: Marks,
}

/// Shows what lies over the picture. `with_panels`: the panels are shown as well.
pub(super) fn show(
    egui: &egui::Context,
    context: &Context<'_>,
    own: &mut Overlay,
    with_panels: bool,
    picture: Rect,
    commands: &mut Commands,
) {
    let state = context.state;
    in_picture(egui, context, own, with_panels, picture, commands);
    let diagnostics = &state.session.diagnostics;
    let mut free = picture;
    if diagnostics.is_empty() {
        own.hidden.clear();
    }
    if *diagnostics != own.hidden {
        let shown = Shown { diagnostics, cut_short: state.is_cut_short(), picture };
        let (card, hides) = diagnostics::show(egui, &shown, &mut own.files, &mut commands.list);
        free.max.y = card.top();
        if hides {
            own.hidden.clone_from(diagnostics);
        }
    } else if let Some(error) = state.shown_expression_error() {
        free.max.y = watched::show(egui, error, picture, &mut own.files, commands).top();
    } else if let Some(card) = with_panels.then(|| hint::show(egui, state, picture, &mut commands.list)).flatten() {
        free.max.y = card.top();
    }
    restore::show(egui, state, picture, &mut commands.list);
    version::show(egui, state, picture, &mut commands.list);
    warnings(egui, state, picture, &mut commands.list);
    light::show(egui, context, picture);
    preview::show(egui, state, if free.height() >= NOTICE { free } else { picture });
    notice(egui, state, picture, free);
    if with_panels {
        label(egui, context, &mut own.legend, picture, commands);
    }
}

/// Shows what belongs to places of the picture.
fn in_picture(
    egui: &egui::Context,
    context: &Context<'_>,
    own: &mut Overlay,
    with_panels: bool,
    picture: Rect,
    commands: &mut Commands,
) {
    let state = context.state;
    marks::show(egui, state, &mut own.marks, picture);
    compare::show(egui, state, &mut own.map, picture, &mut commands.list);
    if commands.sight.inspector || commands.sight.source || commands.sight.evaluations.is_some() {
        marker(egui, &state.inspection, picture);
    }
    gizmo::show(egui, state, &mut own.gizmo, picture, commands);
    grid::show(egui, (&state.session, &state.grid), commands.sight.preview.as_deref(), picture);
    let draws_model = state.shown().is_some_and(|shown| shown.pipelines.draws_model);
    let has_labels = with_panels && draws_model && context.readings.legend.is_some() && !state.grid.is_on();
    if let Some(model) = state.session.model().filter(|_| has_labels) {
        labels::show(egui, &mut own.labels, model, &state.session.settings.camera, picture);
    }
}

/// Kept messages and the model's warnings, until the user hides them.
fn warnings(egui: &egui::Context, state: &State, picture: Rect, commands: &mut Vec<Command>) {
    let model = state.session.model().filter(|_| state.model.shows_warnings);
    let mut lines: Vec<String> = state.notices.kept().to_vec();
    lines.extend(model.map(|model| model.first_warnings(MODEL_WARNINGS)).unwrap_or_default());
    if lines.is_empty() {
        return;
    }
    let mut hide = false;
    // An area keeps its first size, so other messages or another picture are another area.
    let id = Id::new(("warnings", &lines, picture.width() as u32));
    area(id, Align2::RIGHT_TOP, picture).fade_in(false).show(egui, |ui| {
        card(WARNING).show(ui, |ui| {
            ui.set_max_width((picture.width() * 0.5).clamp(200.0, 420.0));
            for line in &lines {
                ui.label(RichText::new(line).small());
            }
            hide = ui.small_button("Hide").clicked();
        });
    });
    if hide {
        commands.push(HIDE_WARNINGS.with(()));
    }
}

/// The passing messages, or that a model is loading, and that its textures are not on screen. `free` is the part of the picture above the diagnostics.
fn notice(egui: &egui::Context, state: &State, picture: Rect, free: Rect) {
    let has_model = state.session.model().is_some_and(|model| !model.instances.is_empty());
    // If no model could be loaded, the message stays.
    let stays = !has_model && !state.model.loading;
    let mut texts: Vec<&str> = Vec::new();
    for (text, left) in state.notices.passing(stays) {
        if !stays {
            egui.request_repaint_after(left);
        }
        texts.push(text);
    }
    match state.missing_textures() {
        Some(missing) => texts.push(missing),
        None if texts.is_empty() && state.model.loading => texts.push("Loading the model…"),
        None => {}
    }
    if texts.is_empty() {
        return;
    }
    let edge = if state.missing_textures().is_some() { WARNING } else { LINE };
    // Where the diagnostics leave no room below, it stands at the top.
    let above_names = if state.compare.is_on() { NAMES } else { 0.0 };
    let (corner, room) = match free.height() >= NOTICE {
        true => (Align2::CENTER_BOTTOM, free.with_max_y(free.max.y - above_names)),
        false => (Align2::CENTER_TOP, picture),
    };
    area(Id::new("notice"), corner, room).interactable(false).show(egui, |ui| {
        card(edge).show(ui, |ui| {
            let font = TextStyle::Body.resolve(ui.style());
            let color = ui.visuals().text_color();
            for text in texts {
                ui.label(wrapped(ui, text, font.clone(), color, room.width().min(620.0)));
            }
        });
    });
}

/// The legend of the mode, and the value under the mouse.
fn label(egui: &egui::Context, context: &Context<'_>, own: &mut LegendState, picture: Rect, commands: &mut Commands) {
    let readings = &context.readings;
    let Some(of) = &readings.legend else { return };
    let legend = Legend { title: readings.title.as_deref(), of, value: readings.value.as_ref() };
    let view = &mut commands.settings.view;
    own.shows_histogram = context.state.workspace.shows_histogram;
    if legend.value.is_none() && !legend.is_whole(view, own) {
        return;
    }
    // An area keeps its first size: one with a histogram or other swatches is another.
    let is_whole = legend.is_whole(view, own);
    let id = Id::new(("mode", is_whole, own.shows_histogram, of.swatches.len()));
    // The offer of the last session stands at the top.
    let place = if context.state.offers_session { Align2::LEFT_BOTTOM } else { Align2::LEFT_TOP };
    // Clicks on a value alone are for the pixel below.
    area(id, place, picture).fade_in(false).interactable(is_whole).show(egui, |ui| {
        card(LINE.color()).show(ui, |ui| legend::show(ui, &legend, view, own, picture.width()));
    });
    if own.shows_histogram != context.state.workspace.shows_histogram {
        commands.push(PANELS.with(PanelRequest::ToggleHistogram));
    }
}
