//! The panel Lights: which lights are on, the orbiting lights, the rectangle and the ambient light.

use egui::{RichText, Ui};

use crate::app::command::scene::{PLACE_RECTANGLE, SELECT};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::selection::{LightId, Selected};
use crate::app::widgets::rows::{choose, group, heading, special};
use crate::app::widgets::theme::QUIET;
use crate::settings::{LightSource, Settings};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Lights", Group::Settings, "color orbit rectangle ambient", || Box::new(ui));

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let Commands { settings, list, .. } = commands;
    show(ui, settings, context.model().lights.len(), list);
}

/// Shows the panel. `in_model` is the number of lights in the model.
fn show(ui: &mut Ui, settings: &mut Settings, in_model: usize, commands: &mut Vec<Command>) {
    group(ui, settings, "lights", |ui, settings, path| {
        match path {
            "lights.source" => source(ui, settings, in_model),
            "lights.chosen" => terms(ui, settings, in_model),
            "lights.spin" => return settings.lights.source != LightSource::Orbit,
            "lights.ambient_color" => {
                placed(ui, settings, commands);
                heading(ui, "Ambient light");
                return false;
            }
            _ => return false,
        }
        true
    });
}

/// The lights that have a place of their own.
fn placed(ui: &mut Ui, settings: &mut Settings, commands: &mut Vec<Command>) {
    if settings.lights.source == LightSource::Orbit {
        for i in 0..settings.lights.orbit.len() {
            ui.push_id(i, |ui| {
                titled(ui, &format!("Light {}", i + 1), LightId::Orbit(i), commands);
                orbit(ui, settings, i);
            });
        }
    }
    if settings.lights.source != LightSource::None {
        ui.push_id("rectangle", |ui| {
            titled(ui, "Rectangle", LightId::Rectangle, commands);
            rectangle(ui, settings);
        });
    }
}

fn source(ui: &mut Ui, settings: &mut Settings, in_model: usize) {
    let name = |source: LightSource| match source {
        LightSource::Orbit => "Orbiting lights".to_owned(),
        LightSource::Model => format!("Model ({in_model})"),
        LightSource::None => "None".to_owned(),
    };
    special(ui, settings, "lights.source", |ui, settings| {
        let source = &mut settings.lights.source;
        choose(ui, "source", name(*source), |ui| {
            for choice in [LightSource::Orbit, LightSource::Model, LightSource::None] {
                let is_offered = choice != LightSource::Model || in_model > 0;
                let button = egui::Button::selectable(*source == choice, name(choice));
                if ui.add_enabled(is_offered, button).on_disabled_hover_text("The model has no lights").clicked() {
                    *source = choice;
                }
            }
        })
    });
}

fn terms(ui: &mut Ui, settings: &mut Settings, in_model: usize) {
    let name = |light: u32| {
        if light == 0 { "All (D to V·H: light 1)".to_owned() } else { format!("Light {light}") }
    };
    let count = if settings.lights.source == LightSource::Model { in_model.min(4) as u32 } else { 3 };
    special(ui, settings, "lights.chosen", |ui, settings| {
        let chosen = &mut settings.lights.chosen;
        choose(ui, "terms", name(*chosen), |ui| {
            (0..=count).for_each(|light| drop(ui.selectable_value(chosen, light, name(light))));
        })
    });
}

/// A heading with a button that shows the handle of a light in the picture.
fn titled(ui: &mut Ui, title: &str, light: LightId, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.add(egui::Label::new(RichText::new(title).small().color(QUIET)).selectable(false));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let hint = "Show its handle in the picture, where you can drag it";
            if ui.small_button("Move in view").on_hover_text(hint).clicked() {
                commands.push(match light {
                    LightId::Rectangle => PLACE_RECTANGLE.with(()),
                    _ => SELECT.with(Selected::Light(light)),
                });
            }
        });
    });
}

/// The rows of an orbiting light.
pub(super) fn orbit(ui: &mut Ui, settings: &mut Settings, index: usize) {
    group(ui, settings, &format!("lights.orbit.{index}"), |_, _, _| false);
}

/// The rows of the rectangular light.
pub(super) fn rectangle(ui: &mut Ui, settings: &mut Settings) {
    group(ui, settings, "lights.rect", |_, settings, path| {
        path != "lights.rect.enabled" && !settings.lights.rect.enabled
    });
}
