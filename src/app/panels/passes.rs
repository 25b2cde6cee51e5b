//! The panel Passes: the clock of animated shaders, then the effects that the tree declares, those of the user first, each with its
//! parameters below, and last the passes that only work for others.

use std::collections::BTreeSet;

use egui::{CollapsingHeader, RichText, Ui};

use super::clock;
use super::parameters::{is_true, show_constant, show_parameter};
use crate::app::command::playback::PLAYBACK;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::shaders::effects::{is_shipped, of_effect, of_switch, own, switches};
use crate::app::widgets::rows::{INITIAL, Row, check, set_option, skips};
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::QUIET;
use crate::settings::Settings;
use crate::shader::{Constant, GraphPass, Parameter, ShaderSet};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Passes", Group::Parameters, "clock time effects switch", || Box::new(ui));

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let Commands { settings, list, .. } = commands;
    let shaders = &*context.shaders;
    if context.state.is_animated() {
        let asked = clock::buttons(ui, &context.state.playback, &clock::time_text(&context.state.playback));
        list.extend(asked.map(|asked| PLAYBACK.with(asked)));
    }
    let words = search::above_kept(ui, "passes", own(shaders).count() + switches(shaders).count());
    let FoundPasses { added, switches, shipped, inside } = FoundPasses::new(shaders, &words);
    if !words.is_empty() && added.len() + switches.len() + shipped.len() + inside.len() == 0 {
        words.no_match(ui, "pass");
    }
    // A parameter that several effects use is shown once.
    let mut shown = BTreeSet::new();
    let show_effect = |ui: &mut Ui, pass: &GraphPass, settings: &mut Settings, shown: &mut BTreeSet<_>| {
        if show_switch(ui, shaders, pass, settings) {
            show_parameters(ui, of_effect(shaders, pass), &pass.desc.label, settings, shown);
        }
    };
    // A shader without a model covers what the other passes draw.
    let is_covered = words.is_empty() && added.iter().any(|pass| pass.covers());
    added.into_iter().for_each(|pass| show_effect(ui, pass, settings, &mut shown));
    let mut show_others = |ui: &mut Ui| {
        for switch in &switches {
            show_constant(ui, switch, &mut settings.shader);
            if is_true(switch, &settings.shader) {
                let of_switch = of_switch(shaders, switch);
                show_parameters(ui, of_switch, &switch.label, settings, &mut shown);
            }
        }
        shipped.iter().for_each(|pass| show_effect(ui, pass, settings, &mut shown));
    };
    if is_covered {
        let title = RichText::new("Passes of the model").small().color(QUIET);
        CollapsingHeader::new(title).id_salt("covered passes").show_unindented(ui, show_others);
    } else {
        show_others(ui);
    }
    if !inside.is_empty() {
        let title = RichText::new(format!("Internal passes ({})", inside.len())).small().color(QUIET);
        let header = CollapsingHeader::new(title).id_salt("internal passes").open((!words.is_empty()).then_some(true));
        let header = header.show_unindented(ui, |ui| {
            for pass in inside {
                let _ = show_switch(ui, shaders, pass, settings);
            }
        });
        header.header_response.on_hover_text("Passes whose images the effects read");
    }
}

/// The entries of the panel: the passes and switches that match the search, or whose parameters do.
#[derive(Debug, Default)]
struct FoundPasses<'a> {
    /// Passes of the user, also those that only work for others, as the buffers of a toy.
    added: Vec<&'a GraphPass>,
    /// Constants that switch passes.
    switches: Vec<&'a Constant>,
    /// Effects that Specula comes with.
    shipped: Vec<&'a GraphPass>,
    /// Internal passes that Specula comes with.
    inside: Vec<&'a GraphPass>,
}

impl<'a> FoundPasses<'a> {
    fn new(shaders: &'a ShaderSet, words: &Words) -> Self {
        let names = &shaders.graph.internal;
        let with = |texts: [&str; 4], parameters: Vec<&Parameter>| {
            let own = std::iter::once(texts.join(" "));
            let below = parameters.iter().map(|p| [texts[0], &p.label, &p.name, &p.doc].join(" "));
            own.chain(below).any(|text| words.are_in(&text))
        };
        let is_found = |pass: &&GraphPass| {
            let desc = &pass.desc;
            words.is_empty() || with([&desc.label, pass.name(), &desc.stage, &desc.doc], of_effect(shaders, pass))
        };
        let is_switch = |switch: &&Constant| {
            let Constant { label, name, doc, group, .. } = *switch;
            words.is_empty() || with([label, name, group, doc], of_switch(shaders, switch))
        };
        let (inside, effects): (Vec<_>, Vec<_>) =
            own(shaders).filter(is_found).partition(|pass| names.contains(pass.name()) && is_shipped(pass));
        let (shipped, added) = effects.into_iter().partition(|pass| is_shipped(pass));
        Self { added, switches: switches(shaders).filter(is_switch).collect(), shipped, inside }
    }
}

/// Shows the row with the switch of a pass. Returns whether it is on.
fn show_switch(ui: &mut Ui, shaders: &ShaderSet, pass: &GraphPass, settings: &mut Settings) -> bool {
    let name = pass.name();
    let before = pass.is_wanted(&settings.passes);
    if skips(ui) {
        return before;
    }
    let mut on = before;
    let default = INITIAL.passes.get(name).copied().unwrap_or(pass.desc.on);
    let doc = format!("{}\n{}", pass.desc.doc, shaders.name_of(&pass.desc.stage));
    let option = set_option(&format!("passes.{name}"), &on.to_string());
    let row =
        Row { name: &pass.desc.label, doc: doc.trim_start(), option, is_changed: on != default, is_indented: false };
    if row.show(ui, |ui| check(ui, &mut on)) {
        on = default;
    }
    if on != before {
        match on == pass.desc.on {
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
