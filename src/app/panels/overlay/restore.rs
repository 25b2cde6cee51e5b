//! The offer to go on with the last session.

use egui::{Align2, Id, Rect, RichText};

use super::card::{area, card};
use crate::app::command::file::{REFUSE_SESSION, RESTORE_ALWAYS, RESTORE_SESSION};
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::widgets::theme::{ACCENT, QUIET};

/// Shows the offer over the picture, until the user answers or begins something else.
pub(super) fn show(egui: &egui::Context, state: &State, picture: Rect, commands: &mut Vec<Command>) {
    if !state.offers_session {
        return;
    }
    let Some(words) = state.last_sessions.here.as_ref().map(|session| session.words()) else { return };
    area(Id::new("restore"), Align2::LEFT_TOP, picture).fade_in(false).show(egui, |ui| {
        card(ACCENT).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).clamp(180.0, 420.0));
            ui.label(RichText::new("Your last session in this folder").strong());
            ui.label(RichText::new(words).small().color(QUIET));
            ui.horizontal_wrapped(|ui| {
                let hint = "Model, shader tree, settings, camera, environment and mode as you left them";
                if ui.button("Restore").on_hover_text(hint).clicked() {
                    commands.push(RESTORE_SESSION.with(()));
                }
                let hint =
                    "Restore it now, and at every start without a model or options. The Open menu can change that";
                if ui.button("Always").on_hover_text(hint).clicked() {
                    commands.extend([RESTORE_ALWAYS.with(true), RESTORE_SESSION.with(())]);
                }
                if ui.button("Not now").on_hover_text("You can still restore it from the Open menu").clicked() {
                    commands.push(REFUSE_SESSION.with(()));
                }
            });
        });
    });
}
