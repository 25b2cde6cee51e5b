//! The overlay: diagnostics, messages, loading state, the legend of the mode, handles, and names over the picture.

mod card;
mod compare;
mod diagnostics;
mod gizmo;
mod grid;
mod hint;
mod labels;
pub(in crate::app) mod legend;
mod restore;
pub(in crate::app) mod swatches;
mod version;

use egui::{Align2, Id, Rect, RichText, TextStyle};

use super::inspector::marker;
use super::readings::Readings;
use crate::app::command::Command;
use crate::app::gallery::GalleryState;
use crate::app::viewer::Viewer;
use crate::app::widgets::theme::{LINE, WARNING};
use crate::settings::ViewSettings;
use card::{area, card, wrapped};
use compare::ShownMap;
use diagnostics::{Files, Shown};
use gizmo::Gizmo;
use labels::Labels;
use legend::{Legend, LegendState};

/// Maximum number of model warnings to show. The rest is counted.
const MODEL_WARNINGS: usize = 4;
/// A passing message needs this many points above the diagnostics.
const NOTICE: f32 = 60.0;
/// Height of the names of what is compared, below the picture, points.
const NAMES: f32 = 36.0;

/// State of the overlay between frames.
#[derive(Default)]
pub(in crate::app) struct Overlay {
    pub(in crate::app) legend: LegendState,
    files: Files,
    gizmo: Gizmo,
    labels: Labels,
    map: ShownMap,
}

/// Shows what lies over the picture. `with_panels`: the panels are shown as well. Returns the version of the shaders that the user wants to
/// write to the files.
pub(super) fn show(
    egui: &egui::Context,
    (viewer, state): (&mut Viewer, &mut Overlay),
    (gallery, with_panels): (&GalleryState, bool),
    readings: &Readings,
    picture: Rect,
    commands: &mut Vec<Command>,
) -> Option<u64> {
    in_picture(egui, (&mut *viewer, &mut *state), (gallery, with_panels), readings, picture);
    let cut_short = viewer.is_cut_short();
    let mut free = picture;
    if !viewer.session.diagnostics.is_empty() {
        let shown = Shown { diagnostics: &viewer.session.diagnostics, cut_short, picture };
        let (card, hides) = diagnostics::show(egui, &shown, &mut state.files, commands);
        free.max.y = card.top();
        if hides {
            viewer.session.diagnostics.clear();
        }
    }
    if with_panels && viewer.session.diagnostics.is_empty() {
        hint::show(egui, viewer, picture, commands);
    }
    restore::show(egui, viewer, picture, commands);
    let asked = version::show(egui, viewer, picture, commands);
    warnings(egui, viewer, picture);
    notice(egui, viewer, picture, free);
    if with_panels {
        label(egui, &mut viewer.session.settings.view, &mut state.legend, readings, picture);
    }
    asked
}

/// Shows what belongs to places of the picture.
fn in_picture(
    egui: &egui::Context,
    (viewer, state): (&mut Viewer, &mut Overlay),
    (gallery, with_panels): (&GalleryState, bool),
    readings: &Readings,
    picture: Rect,
) {
    compare::show(egui, viewer, &mut state.map, picture);
    marker(egui, &viewer.inspection, picture);
    gizmo::show(egui, viewer, &mut state.gizmo, picture);
    grid::show(egui, (&viewer.session, &viewer.grid), gallery, picture);
    let has_labels = with_panels && readings.legend.is_some() && !viewer.grid.is_on();
    if let Some(model) = viewer.session.model().filter(|_| has_labels) {
        labels::show(egui, &mut state.labels, model, &viewer.session.settings.camera, picture);
    }
}

/// Kept messages and the model's warnings, until the user hides them.
fn warnings(egui: &egui::Context, viewer: &mut Viewer, picture: Rect) {
    let model = viewer.session.model().filter(|_| viewer.model.shows_warnings);
    let mut lines: Vec<String> = viewer.notices.kept().to_vec();
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
        viewer.notices.dismiss();
        viewer.model.shows_warnings = false;
    }
}

/// The passing message, or that a model is loading. `free` is the part of the picture above the diagnostics.
fn notice(egui: &egui::Context, viewer: &Viewer, picture: Rect, free: Rect) {
    let has_model = viewer.session.model().is_some_and(|model| !model.instances.is_empty());
    // If no model could be loaded, the message stays.
    let stays = !has_model && !viewer.model.loading;
    let notice = viewer.notices.passing(stays);
    if let Some((_, left)) = notice.filter(|_| !stays) {
        egui.request_repaint_after(left);
    }
    let loading = viewer.model.loading.then_some("Loading the model…");
    let Some(text) = notice.map(|(text, _)| text).or(loading) else { return };
    // Where the diagnostics leave no room below, it stands at the top.
    let above_names = if viewer.compare.is_on() { NAMES } else { 0.0 };
    let (corner, room) = match free.height() >= NOTICE {
        true => (Align2::CENTER_BOTTOM, free.with_max_y(free.max.y - above_names)),
        false => (Align2::CENTER_TOP, picture),
    };
    area(Id::new("notice"), corner, room).interactable(false).show(egui, |ui| {
        card(LINE.color()).show(ui, |ui| {
            let font = TextStyle::Body.resolve(ui.style());
            let color = ui.visuals().text_color();
            ui.label(wrapped(ui, text, font, color, room.width().min(620.0)));
        });
    });
}

/// The legend of the mode, and the value under the mouse.
fn label(egui: &egui::Context, view: &mut ViewSettings, state: &mut LegendState, readings: &Readings, picture: Rect) {
    let Some(of) = &readings.legend else { return };
    let legend = Legend { title: readings.title.as_deref(), of, value: readings.value.as_ref() };
    if legend.value.is_none() && !legend.is_whole(view, state) {
        return;
    }
    // An area keeps its first size: one with a histogram or other swatches is another.
    let id = Id::new(("mode", legend.is_whole(view, state), state.shows_histogram, of.swatches.len()));
    area(id, Align2::LEFT_TOP, picture).fade_in(false).show(egui, |ui| {
        card(LINE.color()).show(ui, |ui| legend::show(ui, &legend, view, state, picture.width()));
    });
}
