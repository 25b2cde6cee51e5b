//! The panel Model: variant, material override, statistics, and the loader's warnings.

use std::path::PathBuf;

use egui::{Checkbox, RichText, Ui};

use super::{animation, beside};
use crate::app::command::file::{OPEN, Open};
use crate::app::command::models::{SCENE, SceneFields};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::model::ModelStatus;
use crate::app::state::recent::Kind;
use crate::app::widgets::rows::{self, Row, choose, group, heading, special};
use crate::app::widgets::theme::{QUIET, WARNING};
use crate::app::widgets::{check_box, plural};
use crate::scene::{BUILT_IN, Model};
use crate::settings::{MaterialChannel, Settings, setting};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Model", Group::Modes, "variant statistics transform rotation scale material override", || {
        Box::new(ui)
    });

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let recent = context.state.recent.of(Kind::Model);
    let Commands { settings, list, .. } = commands;
    let model = context.model();
    show(ui, settings, &model, &context.state.model, recent, list);
    list.extend(animation::show(ui, settings, &model, &context.state.playback));
    beside::places(ui, settings, &model);
    override_material(ui, settings);
    statistics(ui, &model, &context.state.model);
    warnings(ui, &model);
}

fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    model: &Model,
    status: &ModelStatus,
    recent: &[PathBuf],
    commands: &mut Vec<Command>,
) {
    list(ui, model, status, recent, commands);
    scenes(ui, model, commands);
    beside::list(ui, model, recent, commands);
    if !model.variants.is_empty() {
        let name = |variant: &str| if variant.is_empty() { "default materials" } else { variant }.to_owned();
        special(ui, settings, "variant", |ui, settings| {
            let variant = &mut settings.variant;
            choose(ui, "variant", name(variant), |ui| {
                for choice in [""].into_iter().chain(model.variants.iter().map(String::as_str)) {
                    ui.selectable_value(variant, choice.to_owned(), name(choice));
                }
            })
        });
    }
}

/// The warnings of the loader.
fn warnings(ui: &mut Ui, model: &Model) {
    for warning in model.warnings.iter() {
        ui.label(RichText::new(warning).small().color(WARNING));
    }
    beside::hint(ui);
}

/// The list of models.
fn list(ui: &mut Ui, model: &Model, status: &ModelStatus, recent: &[PathBuf], commands: &mut Vec<Command>) {
    let doc =
        "Built-in models and recent files. To open another, drop a .gltf or .glb file on the window or press Ctrl+O";
    let row = Row { name: "Model", doc, option: String::new(), is_changed: false, is_indented: false };
    row.show(ui, |ui| {
        let shown = if status.loading { "loading…" } else { &*model.name };
        choose(ui, "model", shown, |ui| {
            for name in BUILT_IN {
                if ui.selectable_label(name == &*model.name, name).clicked() {
                    commands.push(OPEN.with(Open::Model(name.into())));
                }
            }
            for path in recent {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let button = ui.selectable_label(status.is_open(path), name);
                if button.on_hover_text(path.display().to_string()).clicked() {
                    commands.push(OPEN.with(Open::Model(path.clone())));
                }
            }
        })
    });
}

/// The scenes of the model's file, if there are several.
pub(super) fn scenes(ui: &mut Ui, model: &Model, commands: &mut Vec<Command>) {
    let (shown, count) = (model.contents.scene, model.contents.scenes.len());
    if count < 2 {
        return;
    }
    let doc = "The scene of the model's file that is shown";
    let row = Row { name: "Scene", doc, option: format!("--scene {shown}"), is_changed: false, is_indented: false };
    row.show(ui, |ui| {
        choose(ui, "scene", model.scene_name(shown), |ui| {
            for number in 0..count {
                if ui.selectable_label(number == shown, model.scene_name(number)).clicked() {
                    commands.push(SCENE.with(SceneFields::of(number)));
                }
            }
        })
    });
}

/// The material override.
fn override_material(ui: &mut Ui, settings: &mut Settings) {
    heading(ui, "Material override");
    group(ui, settings, "material", |ui, settings, path| match path {
        "material.enabled" => false,
        "material.anisotropy_rotation" => {
            !settings.material.replaces(MaterialChannel::Anisotropy) || settings.material.anisotropy <= 0.0
        }
        _ => channel(ui, settings, path),
    });
}

/// The row of a channel, with a switch in front that replaces the channel of all materials. Returns whether the setting is a channel.
fn channel(ui: &mut Ui, settings: &mut Settings, path: &str) -> bool {
    let is_of = |of: &MaterialChannel| path.strip_prefix("material.") == Some(of.name());
    let Some(of) = MaterialChannel::ALL.into_iter().find(is_of) else { return false };
    ui.horizontal(|ui| {
        let mut is_on = settings.material.replaces(of);
        let show = |ui: &mut Ui| check_box::show(ui, Checkbox::without_text(&mut is_on));
        let switch = ui.add_enabled_ui(!settings.material.enabled, show).inner;
        let hint = format!(
            "Replace this channel and its texture in all materials. Everything else stays\n--set material.override={}",
            of.name()
        );
        if switch.on_hover_text(hint).changed() {
            settings.material.channels.set(of, is_on);
        }
        ui.add_enabled_ui(is_on, |ui| {
            setting(path).into_iter().for_each(|setting| rows::setting(ui, settings, setting));
        });
    });
    true
}

fn statistics(ui: &mut Ui, model: &Model, status: &ModelStatus) {
    let triangles: usize = model.instances.iter().map(|i| model.primitives[i.primitive].indices.len() / 3).sum();
    let size = if model.bounds.is_empty() { glam::Vec3::ZERO } else { model.bounds.max - model.bounds.min };
    let timing = model.timing;
    let lines = [
        format!("{} in {}", plural(triangles, "triangle"), plural(model.instances.len(), "draw")),
        format!(
            "{}, {}",
            plural(model.materials.len().saturating_sub(1), "material"),
            plural(model.images.len(), "image")
        ),
        format!("{:.3} × {:.3} × {:.3} m", size.x, size.y, size.z),
        format!(
            "loaded in {:.0} ms: parse {:.0}, decode {:.0}, tangents {:.0}",
            status.load_ms, timing.parse_ms, timing.decode_ms, timing.tangents_ms
        ),
    ];
    heading(ui, "Statistics");
    ui.label(RichText::new(lines.join("\n")).small().color(QUIET));
}
