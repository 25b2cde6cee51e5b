//! The panel GPU time: device time of each pass of the last picture.

use egui::{Label, RichText, Ui};

use super::{QUIET, Readings};
use crate::gpu::PassTime;

/// The times of the last frame that drew the picture. A frame that draws only the panels says nothing about it.
#[derive(Default)]
pub(super) struct Timing {
    passes: Vec<PassTime>,
    /// Device time of the whole frame, milliseconds.
    pub(super) frame_ms: Option<f64>,
}

impl Timing {
    /// Takes the times of a frame, if it drew the picture.
    pub(super) fn record(&mut self, readings: &Readings) {
        if readings.passes.iter().any(|pass| pass.name == "model") {
            self.passes.clone_from(&readings.passes);
            self.frame_ms = readings.device_ms;
        }
    }
}

pub(super) fn show(ui: &mut Ui, timing: &Timing, device: &str) {
    ui.add(Label::new(RichText::new(device).small().color(QUIET)).wrap());
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
        if let Some(ms) = timing.frame_ms {
            ui.label("Whole frame")
                .on_hover_text("Device time of the last frame in which the picture was drawn, with the panels");
            ui.label(RichText::new(format!("{ms:>8.2} ms")).monospace());
            ui.end_row();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(names: &[&str], ms: f64) -> Readings {
        let passes = names.iter().map(|name| PassTime { name: (*name).to_owned(), ms, kept: false }).collect();
        Readings { device_ms: Some(ms), passes, value: None, title: None, legend: None }
    }

    #[test]
    fn a_frame_of_the_panels_alone_is_no_time_of_the_picture() {
        let mut timing = Timing::default();
        timing.record(&readings(&["tone map", "ui"], 1.0));
        assert_eq!(timing.frame_ms, None);
        timing.record(&readings(&["model", "tone map", "ui"], 8.0));
        timing.record(&readings(&["tone map", "ui"], 1.0));
        assert_eq!((timing.frame_ms, timing.passes.len()), (Some(8.0), 3));
        assert!(timing.passes.iter().all(|pass| pass.ms == 8.0));
        // A pass that is off is gone.
        timing.record(&readings(&["model", "ui"], 5.0));
        assert_eq!((timing.frame_ms, timing.passes.len()), (Some(5.0), 2));
    }
}
