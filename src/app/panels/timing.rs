//! The panel GPU time: device time of each pass of the last frame.

use egui::{RichText, Ui};

use super::{QUIET, Readings, section};

/// The newest time of every pass of the last whole frame. Rows stay while only the panels are drawn, so that the list does not
/// jump.
#[derive(Default)]
pub(super) struct Timing {
    passes: Vec<(String, f64)>,
}

pub(super) fn show(ui: &mut Ui, timing: &mut Timing, readings: &Readings, device: &str) {
    if readings.passes.iter().any(|pass| pass.name == "model") {
        timing.passes.retain(|(name, _)| readings.passes.iter().any(|pass| pass.name == *name));
    }
    for pass in &readings.passes {
        match timing.passes.iter_mut().find(|(name, _)| *name == pass.name) {
            Some((_, ms)) => *ms = pass.ms,
            None => timing.passes.push((pass.name.to_string(), pass.ms)),
        }
    }
    section(ui, "GPU time", false, |ui| {
        ui.label(RichText::new(device).small().color(QUIET));
        egui::Grid::new("passes").num_columns(2).show(ui, |ui| {
            for (name, ms) in &timing.passes {
                ui.label(name);
                ui.label(RichText::new(format!("{ms:>8.2} ms")).monospace());
                ui.end_row();
            }
            if let Some(ms) = readings.device_ms {
                ui.label("last frame")
                    .on_hover_text("If only the panels change, a frame skips the model and only tone maps");
                ui.label(RichText::new(format!("{ms:>8.2} ms")).monospace());
                ui.end_row();
            }
        });
    });
}
