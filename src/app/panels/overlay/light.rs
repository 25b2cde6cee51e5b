//! A small card that says that the picture has not got its light yet.

use egui::{Align2, Id, Label, Rect, RichText};

use super::card::{area, card};
use crate::app::context::Context;
use crate::app::panels::baking;
use crate::app::state::waits::Waits;
use crate::app::widgets::theme::WARNING;

/// Shows the card while the light of the picture is old.
pub(super) fn show(egui: &egui::Context, context: &Context<'_>, picture: Rect) {
    let Some((Waits::Light { of_edit }, _)) = baking::long_wait(egui, context) else { return };
    let done = context.readings.baking.map(|(done, _)| format!(", {:.0} %", 100.0 * done)).unwrap_or_default();
    let light = if of_edit { "Light from before the edit" } else { "Light not baked yet" };
    // The offer of the last session stands at the left.
    let place = if context.state.offers_session { Align2::RIGHT_TOP } else { Align2::CENTER_TOP };
    area(Id::new("old light"), place, picture).fade_in(false).interactable(false).show(egui, |ui| {
        card(WARNING).show(ui, |ui| {
            ui.add(Label::new(RichText::new(format!("{light}{done}")).small()).extend());
        });
    });
}
