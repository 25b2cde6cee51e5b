//! The mark of a preview: what is shown has fewer pixels than the picture.

use egui::{Align2, Id, Label, Rect, RichText};

use super::card::{area, card};
use crate::app::state::State;
use crate::app::widgets::theme::WARNING;

/// Shows the mark while the picture moves and a preview is shown, also without panels. `free` is the part of the picture above other cards.
pub(super) fn show(egui: &egui::Context, state: &State, free: Rect) {
    if !state.previews.is_preview() {
        return;
    }
    area(Id::new("preview"), Align2::RIGHT_BOTTOM, free).fade_in(false).interactable(false).show(egui, |ui| {
        card(WARNING).show(ui, |ui| ui.add(Label::new(RichText::new("Preview of lower resolution").small()).extend()));
    });
}
