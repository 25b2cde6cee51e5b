//! The panel Passes: the effects that the tree declares, each with its parameters below, then the passes that only work for others,
//! and the clock of animated shaders.

use std::collections::BTreeSet;

use egui::{CollapsingHeader, RichText, Ui};

use super::QUIET;
use super::parameters::{is_true, show_constant, show_parameter};
use super::rows::{Row, check, set_option};
use crate::app::playback::Playback;
use crate::settings::Settings;
use crate::shader::annotation::pass::MODEL;
use crate::shader::{Constant, GraphPass, Parameter, ShaderSet};

/// Shows the panel. `is_animated`: something on screen reads the time.
pub(super) fn show(
    ui: &mut Ui,
    shaders: &ShaderSet,
    settings: &mut Settings,
    playback: &mut Playback,
    is_animated: bool,
) {
    // A parameter that several effects use is shown once.
    let mut shown = BTreeSet::new();
    for switch in switches(shaders) {
        show_constant(ui, switch, &mut settings.shader);
        if is_true(switch, &settings.shader) {
            let of_switch = of_switch(shaders, switch);
            show_parameters(ui, of_switch, &switch.label, settings, &mut shown);
        }
    }
    let names = internal(shaders);
    let (inside, effects): (Vec<&GraphPass>, Vec<&GraphPass>) =
        own(shaders).partition(|pass| names.contains(pass.name()));
    for pass in effects {
        if show_switch(ui, pass, settings) {
            show_parameters(ui, of_effect(shaders, pass, &names), &pass.note.label, settings, &mut shown);
        }
    }
    if !inside.is_empty() {
        let title = RichText::new(format!("Internal passes ({})", inside.len())).small().color(QUIET);
        let header = CollapsingHeader::new(title).id_salt("internal passes");
        let header = header.show_unindented(ui, |ui| {
            for pass in inside {
                let _ = show_switch(ui, pass, settings);
            }
        });
        header.header_response.on_hover_text("Passes whose images the effects read");
    }
    if is_animated {
        clock(ui, playback);
    }
}

/// The passes with a switch of their own.
fn own(shaders: &ShaderSet) -> impl Iterator<Item = &GraphPass> {
    let has_own = |pass: &&GraphPass| pass.note.when.is_none() && pass.has_switch();
    shaders.graph.passes.iter().map(|pass| &**pass).filter(has_own)
}

/// The names of the passes that only work for others: they do not change the picture, and another pass needs them.
pub(in crate::app) fn internal(shaders: &ShaderSet) -> BTreeSet<&str> {
    let passes = || shaders.graph.passes.iter().map(|pass| &**pass);
    let needed = passes().flat_map(|pass| needs(shaders, pass).filter(|needed| needed.name() != pass.name()));
    let needed: BTreeSet<&str> = needed.filter(|needed| !needed.note.to_picture()).map(GraphPass::name).collect();
    passes().map(GraphPass::name).filter(|name| *name == MODEL || needed.contains(name)).collect()
}

/// A pass and those whose images and buffers it needs.
fn needs<'a>(shaders: &'a ShaderSet, pass: &GraphPass) -> impl Iterator<Item = &'a GraphPass> {
    shaders.graph.needed_by(pass.name()).into_iter().map(|index| &*shaders.graph.passes[index])
}

/// The constants that switch passes, in the order of their ids.
pub(super) fn switches(shaders: &ShaderSet) -> impl Iterator<Item = &Constant> {
    shaders.constants.iter().filter(|constant| is_switch(shaders, &constant.name))
}

/// Whether the constant with this name switches passes.
pub(in crate::app) fn is_switch(shaders: &ShaderSet, constant: &str) -> bool {
    shaders.graph.passes.iter().any(|pass| pass.note.when.as_deref() == Some(constant))
}

/// Whether a parameter belongs to a pass: it is in the pass's own block, or depends on the pass's switch.
pub(in crate::app) fn is_of_pass(shaders: &ShaderSet, parameter: &Parameter) -> bool {
    parameter.offset.is_none() || parameter.when.as_deref().is_some_and(|when| is_switch(shaders, when))
}

/// The parameters that a constant switches on with its passes.
fn of_switch<'a>(shaders: &'a ShaderSet, switch: &Constant) -> Vec<&'a Parameter> {
    let name = Some(&switch.name);
    let passes: Vec<_> = shaders.graph.passes.iter().filter(|pass| pass.note.when.as_ref() == name).collect();
    let is_own = |parameter: &&Parameter| {
        let in_block = || passes.iter().any(|pass| parameter.offset.is_none() && pass.has_parameter(&parameter.name));
        parameter.when.as_ref() == name || in_block()
    };
    shaders.parameters.iter().filter(is_own).collect()
}

/// The parameters in the uniform blocks of an effect and of the internal passes that it needs.
fn of_effect<'a>(shaders: &'a ShaderSet, effect: &GraphPass, internal: &BTreeSet<&str>) -> Vec<&'a Parameter> {
    let is_its = |pass: &&GraphPass| pass.name() == effect.name() || internal.contains(pass.name());
    let passes: Vec<_> = needs(shaders, effect).filter(|pass| pass.note.when.is_none()).filter(is_its).collect();
    let in_block = |parameter: &&Parameter| {
        parameter.offset.is_none() && passes.iter().any(|pass| pass.has_parameter(&parameter.name))
    };
    shaders.parameters.iter().filter(in_block).collect()
}

/// Shows the row with the switch of a pass. Returns whether it is on.
fn show_switch(ui: &mut Ui, pass: &GraphPass, settings: &mut Settings) -> bool {
    let name = pass.name();
    let before = pass.is_wanted(&settings.passes);
    let mut on = before;
    let default = Settings::of_window().passes.get(name).copied().unwrap_or(pass.note.on);
    let doc = format!("{}\n{}", pass.note.doc, pass.note.stage);
    let option = set_option(&format!("passes.{name}"), &on.to_string());
    let row =
        Row { name: &pass.note.label, doc: doc.trim_start(), option, is_changed: on != default, is_indented: false };
    if row.show(ui, |ui| check(ui, &mut on)) {
        on = default;
    }
    if on != before {
        match on == pass.note.on {
            true => settings.passes.remove(name),
            false => settings.passes.insert(name.to_owned(), on),
        };
    }
    on
}

/// Shows the parameters below the switch with this label.
fn show_parameters<'a>(
    ui: &mut Ui,
    parameters: Vec<&'a Parameter>,
    label: &str,
    settings: &mut Settings,
    shown: &mut BTreeSet<&'a str>,
) {
    for parameter in parameters {
        if shown.insert(&parameter.name) {
            show_parameter(ui, parameter, &mut settings.shader, Some(label));
        }
    }
}

/// The clock of animated shaders.
fn clock(ui: &mut Ui, playback: &mut Playback) {
    ui.horizontal_wrapped(|ui| {
        let label = if playback.paused { "Play" } else { "Pause" };
        if ui.button(label).on_hover_text("Run or stop frame.time_s").clicked() {
            playback.paused = !playback.paused;
        }
        if ui.button("Step").on_hover_text("Advance by 1/60 s").clicked() {
            playback.step();
        }
        if ui.button("0").on_hover_text("Restart at 0 s").clicked() {
            playback.restart();
        }
        let speed = egui::DragValue::new(&mut playback.speed).range(0.0..=10.0).speed(0.01).suffix("×");
        ui.add(speed).on_hover_text("Playback speed");
        ui.label(RichText::new(format!("{:.1} s", playback.time_s())).monospace().color(QUIET));
    });
}
