//! The panel Camera: field of view, framing, and the cameras in the model.

use egui::{Label, RichText, Ui};

use super::QUIET;
use super::rows::{number, option_text};
use crate::app::command::Command;
use crate::app::numbers::FIELD_OF_VIEW;
use crate::scene::Model;
use crate::settings::Settings;

pub(super) fn show(ui: &mut Ui, settings: &mut Settings, model: &Model, commands: &mut Vec<Command>) {
    number(ui, settings, &FIELD_OF_VIEW);
    let settings = &mut settings.camera;
    if ui.button("Frame the model").on_hover_text("Show the whole model (R or Home)").clicked() {
        commands.push(Command::FrameModel);
    }
    for (index, camera) in model.cameras.iter().enumerate() {
        let name = if camera.name.is_empty() { "Camera of the model" } else { &camera.name };
        if ui.add(egui::Button::new(name).truncate()).on_hover_text("Look through this camera of the model").clicked() {
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
