//! Says that an older version of the shaders is shown, and offers the way back.

use egui::{Align2, Id, Rect, RichText};

use super::card::{area, card};
use crate::app::command::layout::{OPEN_PANEL, PANELS};
use crate::app::command::shaders::{VERSIONS, VersionsRequest};
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::theme::{ACCENT, QUIET};

/// Shows the card over the picture while an older version is shown.
pub(super) fn show(egui: &egui::Context, state: &State, picture: Rect, commands: &mut Vec<Command>) {
    let Some(number) = state.edits.restored.as_ref().map(|restored| restored.number) else { return };
    area(Id::new(("version", number)), Align2::RIGHT_TOP, picture).fade_in(false).show(egui, |ui| {
        card(ACCENT).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).clamp(160.0, 240.0));
            ui.label(RichText::new(format!("Version {number} of the shaders")).strong());
            ui.label(RichText::new("Your files are as they were; a save ends it").small().color(QUIET));
            ui.horizontal_wrapped(|ui| {
                if ui.button("Back to the newest").on_hover_text("Show the files again").clicked() {
                    commands.push(VERSIONS.with(VersionsRequest::ShowNewest));
                }
                if ui.button("Write to the files…").on_hover_text("Asks first, in the panel Timeline").clicked() {
                    commands.push(OPEN_PANEL.with(Panel::TIMELINE));
                    commands.push(PANELS.with(PanelRequest::AskVersion(number)));
                }
            });
        });
    });
}
