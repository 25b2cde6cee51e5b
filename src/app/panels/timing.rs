//! The panel GPU time: device time of each pass of the last frame.

use egui::{RichText, Ui};

use super::{QUIET, Readings};
use crate::gpu::PassTime;

/// The newest time of every pass of the last whole frame. Rows stay while only the panels are drawn, so that the list does not
/// jump.
#[derive(Default)]
pub(super) struct Timing {
    passes: Vec<PassTime>,
}

impl Timing {
    /// Takes the times of a frame.
    pub(super) fn record(&mut self, readings: &Readings) {
        if readings.passes.iter().any(|pass| pass.name == "model") {
            self.passes.retain(|known| readings.passes.iter().any(|pass| pass.name == known.name));
        }
        for pass in &readings.passes {
            match self.passes.iter_mut().find(|known| known.name == pass.name) {
                Some(known) => known.clone_from(pass),
                None => self.passes.push(pass.clone()),
            }
        }
    }
}

pub(super) fn show(ui: &mut Ui, timing: &Timing, readings: &Readings, device: &str) {
    ui.label(RichText::new(device).small().color(QUIET));
    egui::Grid::new("passes").num_columns(2).show(ui, |ui| {
        for pass in &timing.passes {
            ui.label(&pass.name);
            if pass.kept {
                ui.label(RichText::new(format!("{:>11}", "kept")).monospace().color(QUIET))
                    .on_hover_text("Not drawn: nothing that it reads has changed, so its image is the same");
            } else {
                ui.label(RichText::new(format!("{:>8.2} ms", pass.ms)).monospace());
            }
            ui.end_row();
        }
        if let Some(ms) = readings.device_ms {
            ui.label("last frame")
                .on_hover_text("If only the panels change, a frame skips the model and only tone maps");
            ui.label(RichText::new(format!("{ms:>8.2} ms")).monospace());
            ui.end_row();
        }
    });
}
