//! The panel Passes: a switch for each pass that the tree declares, and the clock of animated shaders.

use egui::{RichText, Ui};

use super::parameters::show_parameter;
use super::{QUIET, section};
use crate::app::playback::Playback;
use crate::settings::Settings;
use crate::shader::{Parameter, ShaderSet};

/// Shows the panel. `is_animated`: something on screen reads the time.
pub(super) fn show(
    ui: &mut Ui,
    shaders: &ShaderSet,
    settings: &mut Settings,
    playback: &mut Playback,
    is_animated: bool,
) {
    if shaders.graph.passes.is_empty() && !is_animated {
        return;
    }
    section(ui, "Passes", true, |ui| {
        for pass in &shaders.graph.passes {
            let is_own = |parameter: &&Parameter| parameter.offset.is_none() && pass.has_parameter(&parameter.name);
            let own: Vec<&Parameter> = shaders.parameters.iter().filter(is_own).collect();
            let name = pass.name();
            let mut on = settings.passes.get(name).copied().unwrap_or(pass.note.on);
            let doc = format!("{}\n\n--set passes.{name}={}\n{}", pass.note.doc, !on, pass.note.stage);
            if ui.checkbox(&mut on, &pass.note.label).on_hover_text(doc.trim_start()).changed() {
                match on == pass.note.on {
                    true => settings.passes.remove(name),
                    false => settings.passes.insert(name.to_owned(), on),
                };
            }
            if on {
                own.into_iter().for_each(|parameter| show_parameter(ui, parameter, &mut settings.shader));
            }
        }
        if is_animated {
            ui.horizontal(|ui| {
                let label = if playback.paused { "Play" } else { "Pause" };
                if ui.button(label).on_hover_text("Let frame.time_s run, or stop it").clicked() {
                    playback.paused = !playback.paused;
                }
                if ui.button("Step").on_hover_text("One frame of 1/60 s").clicked() {
                    playback.step();
                }
                if ui.button("0").on_hover_text("Back to 0 s").clicked() {
                    playback.restart();
                }
                let speed = egui::DragValue::new(&mut playback.speed).range(0.0..=10.0).speed(0.01).suffix("x");
                ui.add(speed).on_hover_text("Speed of the time");
                ui.label(RichText::new(format!("{:.1} s", playback.time_s())).monospace().color(QUIET));
            });
        }
    });
}
