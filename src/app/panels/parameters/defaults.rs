//! Writes the values of parameters into the GLSL as their defaults: the button, the entry of a row's menu, and the dialog that asks
//! first.

use egui::{Button, Grid, Id, Label, Modal, RichText, ScrollArea, Ui};

use crate::app::command::shaders::WRITE_EDITS;
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::state::shaders::edits::NO_FOLDER;
use crate::app::widgets::theme::{ACCENT, ERROR, QUIET};

/// State of the confirmation dialog.
#[derive(Default)]
pub(in crate::app) struct AskedDefaults {
    /// Of one parameter, or of all that are set. `None` while the dialog is closed.
    about: Option<Option<String>>,
}

impl AskedDefaults {
    /// Opens the dialog, about one parameter or about all.
    pub(in crate::app) fn ask(&mut self, only: Option<String>) {
        self.about = Some(only);
    }

    /// Whether the dialog is open. The keys are its own then.
    pub(in crate::app) fn is_open(&self) -> bool {
        self.about.is_some()
    }
}

/// Where rows leave their wish, so that panels need not hand it on.
fn wish() -> Id {
    Id::new("write defaults")
}

fn ask(ui: &Ui, only: Option<String>) {
    ui.data_mut(|data| data.insert_temp(wish(), only));
}

/// The button below the parameters.
pub(super) fn button(ui: &mut Ui, is_enabled: bool) {
    let button = ui.add_enabled(is_enabled, Button::new("Write to GLSL…"));
    let hint = "Make the values above the defaults in the shader files: shows each line first";
    if button.on_hover_text(hint).on_disabled_hover_text("No value above differs from the shader files").clicked() {
        ask(ui, None);
    }
}

/// The entry in the menu of a parameter's name.
pub(super) fn menu(ui: &mut Ui, name: &str, is_enabled: bool) {
    let button = ui.add_enabled(is_enabled, Button::new("Write to GLSL…"));
    if button.on_hover_text("Make this value the default in the shader file").clicked() {
        ask(ui, Some(name.to_owned()));
        ui.close();
    }
}

/// Shows the dialog while it is open.
pub(in crate::app) fn show(egui: &egui::Context, state: &State, own: &mut AskedDefaults, commands: &mut Vec<Command>) {
    if let Some(only) = egui.data_mut(|data| data.remove_temp::<Option<String>>(wish())) {
        own.ask(only);
    }
    let Some(only) = own.about.clone() else { return };
    let edits = state.edits_of_defaults(only.as_deref());
    let has_files = state.has_files();
    let mut closes = false;
    let modal = Modal::new(Id::new("write defaults dialog")).show(egui, |ui| {
        ui.set_max_width(560.0);
        ui.label(RichText::new("Write to GLSL").strong());
        let can_write = match &edits {
            Err(message) => {
                ui.add(Label::new(RichText::new(message).color(ERROR)).wrap());
                false
            }
            Ok(edits) if edits.is_empty() => {
                ui.label("The shader files have these values already.");
                false
            }
            Ok(edits) => {
                ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
                    Grid::new("defaults").num_columns(3).striped(true).show(ui, |ui| {
                        for edit in edits {
                            ui.label(&edit.name);
                            let place = format!("{}:{}", edit.path, edit.line);
                            ui.label(RichText::new(place).monospace().small().color(QUIET)).on_hover_text(&edit.before);
                            let old = if edit.old().is_empty() { "0" } else { edit.old() };
                            let new = edit.new.trim_start_matches([' ', '=']);
                            ui.label(RichText::new(format!("{old} -> {new}")).monospace().color(ACCENT));
                            ui.end_row();
                        }
                    });
                });
                if !has_files {
                    ui.add(Label::new(RichText::new(NO_FOLDER).small().color(ERROR)).wrap());
                }
                has_files
            }
        };
        ui.horizontal(|ui| {
            let write = ui.add_enabled(can_write, Button::new("Write"));
            if write.on_hover_text("Change these values in the files and nothing else").clicked() {
                commands.extend(edits.clone().ok().map(|argument| WRITE_EDITS.with(argument)));
                closes = true;
            }
            closes |= ui.button("Cancel").on_hover_text("Leave the files as they are (Escape)").clicked();
        });
    });
    if closes || modal.should_close() {
        own.about = None;
    }
}
