//! The state of the shader tree: what was rebuilt last, and how long each step took.

use egui::{RichText, Ui};

use super::{ERROR, QUIET, section};
use crate::app::document::Document;

pub(super) fn show(ui: &mut Ui, document: &mut Document, device_ms: Option<f64>) {
    section(ui, "Shaders", true, |ui| {
        ui.horizontal(|ui| {
            let errors = document.diagnostics.iter().filter(|d| d.severity == crate::shader::Severity::Error).count();
            match (document.shader.compiling, errors, document.shaders()) {
                // No spinner: on a software device its frames would slow down what they wait for.
                (true, ..) => ui.label("Compiling…"),
                (_, 0, Some(shaders)) => ui.label(format!("Generation {}", shaders.generation)),
                (_, 0, None) => ui.label("No shaders yet"),
                (_, 1, _) => ui.colored_label(ERROR, "1 error; showing the last good"),
                (_, n, _) => ui.colored_label(ERROR, format!("{n} errors; showing the last good")),
            };
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Reload").on_hover_text("Compile everything again (F5)").clicked() {
                    document.reload();
                }
            });
        });
        ui.label(RichText::new(&document.shader.tree).small().color(QUIET));
        if let Some(last) = &document.shader.last {
            let changed = if last.changed.is_empty() { "start".into() } else { last.changed.join(" ") };
            let names: Vec<&str> = changed.split(' ').map(|path| path.rsplit('/').next().unwrap_or(path)).collect();
            let stages = if last.stages.is_empty() { "nothing to do".into() } else { last.stages.join(" ") };
            let times = match last.ok {
                true => format!(
                    "{:.0} ms compile + {:.0} ms pipeline + {:.0} ms frame",
                    last.compile_ms, last.pipeline_ms, last.first_frame_ms
                ),
                false => format!("failed after {:.0} ms", last.compile_ms),
            };
            let text = format!("{} -> {stages}\n{times}", names.join(" "));
            ui.label(RichText::new(text).monospace().small()).on_hover_text(format!(
                "{changed}\nSeen {:.1} ms after the first file event. The frame is the first with the new shaders.",
                last.detect_ms
            ));
        }
        let frame = device_ms.map(|ms| format!("Last frame {ms:.1} ms, ")).unwrap_or_default();
        ui.label(RichText::new(format!("{frame}{}", document.device())).small().color(QUIET));
    });
}
