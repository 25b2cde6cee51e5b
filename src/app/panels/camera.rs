//! The panel Camera: field of view, framing, and the cameras in the model.

use egui::{RichText, Ui};

use super::{QUIET, angle};
use crate::app::command::Command;
use crate::scene::{CameraView, Model};
use crate::settings::CameraSettings;

pub(super) fn show(ui: &mut Ui, settings: &mut CameraSettings, model: &Model, commands: &mut Vec<Command>) {
    angle(ui, "Field of view", "Vertical field of view in degrees (--fovy)", &mut settings.fovy, 5.0..=120.0);
    ui.horizontal(|ui| {
        if ui.button("Frame the model").on_hover_text("Show the whole model (R or Home)").clicked() {
            commands.push(Command::FrameModel);
        }
    });
    for camera in &model.cameras {
        let name = if camera.name.is_empty() { "Camera of the model" } else { &camera.name };
        if ui.button(name).clicked() {
            let view = CameraView::of_camera(camera, 1.0, &model.bounds);
            settings.eye = Some(view.eye.to_array());
            settings.target = Some(view.target.to_array());
            settings.fovy = view.fovy_rad.to_degrees();
        }
    }
    if let (Some(eye), Some(target)) = (settings.eye, settings.target) {
        let list = |v: [f32; 3]| v.map(|c| format!("{c:.3}")).join(",");
        let text = format!("--eye {} --target {}", list(eye), list(target));
        let label = ui.label(RichText::new(&text).monospace().small().color(QUIET));
        if label.on_hover_text("Click to copy").interact(egui::Sense::click()).clicked() {
            ui.ctx().copy_text(text);
        }
    }
    let help = "Drag to orbit, Shift+drag to pan, wheel to zoom, Alt+drag to turn the light around.\nHold the right button and W A S D Q E to fly.";
    ui.label(RichText::new(help).small().color(QUIET));
}
