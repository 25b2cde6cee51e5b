//! The panel Passes: a switch for each pass that the tree declares, and the clock of animated shaders.

use std::sync::Arc;

use egui::{RichText, Ui};

use super::QUIET;
use super::parameters::{is_true, show_constant, show_parameter};
use crate::app::playback::Playback;
use crate::settings::Settings;
use crate::shader::{Constant, GraphPass, Parameter, ShaderSet};

/// Shows the panel. `is_animated`: something on screen reads the time.
pub(super) fn show(
    ui: &mut Ui,
    shaders: &ShaderSet,
    settings: &mut Settings,
    playback: &mut Playback,
    is_animated: bool,
) {
    for switch in switches(shaders) {
        show_constant(ui, switch, &mut settings.shader);
        if is_true(switch, &settings.shader) {
            let passes = shaders.graph.passes.iter().filter(|pass| pass.note.when.as_ref() == Some(&switch.name));
            passes.for_each(|pass| show_parameters(ui, shaders, pass, settings));
        }
    }
    let graph = &shaders.graph;
    let is_base = |pass: &GraphPass| pass.note.is_built_in() || pass.note.background;
    let active = graph.active(is_base, true, |index| graph.passes[index].is_wanted(&settings.passes), None);
    // A pass whose readers are all off is off with them.
    let is_shown = |pass: &&Arc<GraphPass>| {
        pass.note.when.is_none()
            && pass.has_switch()
            && (!pass.note.images().any(|(name, _)| graph.is_read(name))
                || !pass.is_wanted(&settings.passes)
                || active.contains(pass))
    };
    for pass in graph.passes.iter().filter(is_shown).cloned().collect::<Vec<_>>() {
        show_pass(ui, shaders, &pass, settings);
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
}

/// The constants that switch passes, in the order of their ids.
pub(super) fn switches(shaders: &ShaderSet) -> impl Iterator<Item = &Constant> {
    let is_switch =
        |constant: &&Constant| shaders.graph.passes.iter().any(|pass| pass.note.when.as_ref() == Some(&constant.name));
    shaders.constants.iter().filter(is_switch)
}

/// Shows a switch of the pass, and its parameters while it is on.
fn show_pass(ui: &mut Ui, shaders: &ShaderSet, pass: &GraphPass, settings: &mut Settings) {
    let name = pass.name();
    let mut on = pass.is_wanted(&settings.passes);
    let doc = format!("{}\n\n--set passes.{name}={}\n{}", pass.note.doc, !on, pass.note.stage);
    if ui.checkbox(&mut on, &pass.note.label).on_hover_text(doc.trim_start()).changed() {
        match on == pass.note.on {
            true => settings.passes.remove(name),
            false => settings.passes.insert(name.to_owned(), on),
        };
    }
    if on {
        show_parameters(ui, shaders, pass, settings);
    }
}

/// Shows the parameters in the pass's own uniform block.
fn show_parameters(ui: &mut Ui, shaders: &ShaderSet, pass: &GraphPass, settings: &mut Settings) {
    let is_own = |parameter: &&Parameter| parameter.offset.is_none() && pass.has_parameter(&parameter.name);
    for parameter in shaders.parameters.iter().filter(is_own) {
        show_parameter(ui, parameter, &mut settings.shader);
    }
}
