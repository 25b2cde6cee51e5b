//! The panel Camera: field of view, framing, and the cameras in the model.

use egui::{Button, Label, RichText, Ui};

use super::rows::{heading, number, option_text};
use super::{ACCENT, QUIET};
use crate::app::command::Command;
use crate::app::numbers::FIELD_OF_VIEW;
use crate::scene::Model;
use crate::settings::Settings;

pub(super) fn show(ui: &mut Ui, settings: &mut Settings, model: &Model, commands: &mut Vec<Command>) {
    number(ui, settings, &FIELD_OF_VIEW);
    bookmarks(ui, settings, commands);
    let settings = &mut settings.camera;
    if ui.button("Frame the model").on_hover_text("Show the whole model (R or Home)").clicked() {
        commands.push(Command::FrameModel);
    }
    for (index, camera) in model.cameras.iter().enumerate() {
        let name = if camera.name.is_empty() { "Unnamed camera" } else { &camera.name };
        if ui.add(Button::new(name).truncate()).on_hover_text("Look through this camera").clicked() {
            commands.push(Command::LookThrough(index));
        }
    }
    if let (Some(eye), Some(target)) = (settings.eye, settings.target) {
        let list = |v: [f32; 3]| v.map(|c| format!("{c:.3}")).join(",");
        let text = format!("--eye {} --target {}", list(eye), list(target));
        let label = ui.add(Label::new(option_text(&text).color(QUIET)).sense(egui::Sense::click()));
        if label.on_hover_text("Position and target in meters. Click to copy the options").clicked() {
            ui.ctx().copy_text(text);
        }
    }
    let help = "Drag to orbit, Shift+drag to pan, wheel to zoom, Alt+drag to turn the environment.\n\
                Hold the right button and W A S D Q E to fly.";
    ui.label(RichText::new(help).small().color(QUIET));
}

/// The cameras that the user has kept.
fn bookmarks(ui: &mut Ui, settings: &mut Settings, commands: &mut Vec<Command>) {
    heading(ui, "Saved cameras");
    ui.horizontal_wrapped(|ui| {
        for number in 1..=9_u32 {
            let is_kept = settings.bookmarks.contains_key(&number.to_string());
            let text = RichText::new(number.to_string()).monospace();
            let button = ui.add(Button::new(if is_kept { text.color(ACCENT) } else { text.color(QUIET) }));
            let hint = match is_kept {
                true => {
                    format!("Return to this camera (Ctrl+{number}). Shift+click to replace it with the current camera")
                }
                false => format!("Store the current camera as {number} (Ctrl+Shift+{number})"),
            };
            if button.on_hover_text(hint).clicked() {
                let keeps = !is_kept || ui.input(|input| input.modifiers.shift);
                commands.push(if keeps { Command::KeepCamera(number) } else { Command::RecallCamera(number) });
            }
        }
    });
}
