//! The models that are shown side by side: their list, how to add one, and where each stands.

use std::path::PathBuf;

use egui::{RichText, Ui};

use crate::app::command::file::{CHOOSE_BESIDE, OPEN, Open};
use crate::app::command::models::REMOVE_MODEL;
use crate::app::command::spec::Command;
use crate::app::widgets::elide::middle;
use crate::app::widgets::rows::{self, choose, group, heading};
use crate::app::widgets::theme::{QUIET, body_font};
use crate::scene::{BUILT_IN, Model};
use crate::settings::{ModelSettings, Settings, setting};

/// The models beside the first, and the choice of one more.
pub(super) fn list(ui: &mut Ui, model: &Model, recent: &[PathBuf], commands: &mut Vec<Command>) {
    for (number, member) in model.members.iter().skip(1).enumerate() {
        ui.horizontal(|ui| {
            let hint = format!("Show {} no longer", member.name);
            if ui.small_button("×").on_hover_text(hint).clicked() {
                commands.push(REMOVE_MODEL.with(number));
            }
            let shown = middle(ui.painter(), &member.name, &body_font(), ui.available_width());
            ui.label(shown).on_hover_text(&member.file);
        });
    }
    let hint = "Show another model beside this one. Or drop it on the window with Shift held";
    let button = choose(ui, "add a model", "Add a model beside", |ui| {
        let mut add = |ui: &mut Ui, name: &str, path: PathBuf| {
            let button = ui.selectable_label(false, name).on_hover_text(path.display().to_string());
            if button.clicked() {
                commands.push(OPEN.with(Open::Beside(path)));
            }
        };
        for path in recent {
            add(ui, &path.file_name().unwrap_or_default().to_string_lossy(), path.clone());
        }
        BUILT_IN.iter().for_each(|name| add(ui, name, name.into()));
        if ui.selectable_label(false, "File…").clicked() {
            commands.push(CHOOSE_BESIDE.with(()));
        }
    });
    button.on_hover_text(hint);
}

/// The rows of where each model stands.
pub(super) fn places(ui: &mut Ui, settings: &mut Settings, model: &Model) {
    if model.members.is_empty() {
        heading(ui, "Transform");
        return place(ui, settings, 0);
    }
    for (number, member) in model.members.iter().enumerate() {
        heading(ui, &format!("Transform of {}", member.name));
        place(ui, settings, number);
    }
}

/// The rows of where the model with this number stands; the first is 0.
pub(super) fn place(ui: &mut Ui, settings: &mut Settings, number: usize) {
    let Some(added) = number.checked_sub(1) else {
        group(ui, settings, "model", |_, _, _| false);
        return reset(ui, &mut settings.model);
    };
    for name in ["rotation", "scale", "translation"] {
        let setting = setting(&format!("added.{added}.place.{name}"));
        setting.into_iter().for_each(|setting| rows::setting(ui, settings, setting));
    }
    settings.added.get_mut(added).into_iter().for_each(|model| reset(ui, &mut model.place));
}

fn reset(ui: &mut Ui, place: &mut ModelSettings) {
    let is_moved = *place != ModelSettings::default();
    if is_moved && ui.small_button("Reset").on_hover_text("Return to the transform in the file").clicked() {
        *place = ModelSettings::default();
    }
}

/// A hint about other ways to open models.
pub(super) fn hint(ui: &mut Ui) {
    let hint = "Drop a model (.gltf, .glb), an environment (.hdr, .exr) or a shader folder on the window; with Shift held, a model stands \
        beside those on screen.";
    ui.label(RichText::new(hint).small().color(QUIET));
}
