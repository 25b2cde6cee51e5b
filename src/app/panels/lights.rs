//! The panel Lights: which lights are on, the orbiting lights, the rectangle and the ambient light.

use egui::{RichText, Ui};

use super::QUIET;
use crate::app::command::Command;
use crate::app::numbers::{AMBIENT, ORBIT, RECTANGLE, SPIN};
use crate::app::state::selection::{LightId, Selected};
use crate::app::widgets::rows::{check, choose, color, heading, number, setting};
use crate::settings::{LightSettings, LightSource, RectLight, Settings};

/// Shows the panel. `in_model` is the number of lights in the model.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, in_model: usize, commands: &mut Vec<Command>) {
    let default = LightSettings::default();
    source(ui, &mut settings.lights, in_model);
    terms(ui, &mut settings.lights, in_model);
    if settings.lights.source == LightSource::Orbit {
        number(ui, settings, &SPIN);
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
    ui.push_id("ambient", |ui| {
        heading(ui, "Ambient light");
        let is_used = !settings.environment.is_lit();
        let light = &mut settings.lights.ambient_color;
        let doc = "Color of the light from every direction. An environment replaces the ambient light";
        setting(ui, ("Color", doc, "lights.ambient_color"), light, default.ambient_color, |ui, light| {
            ui.add_enabled_ui(is_used, |ui| color(ui, light)).inner
        });
        number(ui, settings, &AMBIENT);
    });
}

fn source(ui: &mut Ui, lights: &mut LightSettings, in_model: usize) {
    let name = |source: LightSource| match source {
        LightSource::Orbit => "Orbiting lights".to_owned(),
        LightSource::Model => format!("Model ({in_model})"),
        LightSource::None => "None".to_owned(),
    };
    let doc = "Lights that are on: three that orbit the model, those in the model's file, or none";
    setting(ui, ("Source", doc, "lights.source"), &mut lights.source, LightSource::default(), |ui, source| {
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

fn terms(ui: &mut Ui, lights: &mut LightSettings, in_model: usize) {
    let name = |light: u32| {
        if light == 0 { "All (D to V·H: light 1)".to_owned() } else { format!("Light {light}") }
    };
    let doc = "Light whose BRDF terms the modes show. All: the lobes are summed over all lights. D, G, V, F, weights and cosines depend on the \
        direction to a single light, so they are those of light 1";
    let count = if lights.source == LightSource::Model { in_model.min(4) as u32 } else { 3 };
    setting(ui, ("Terms of", doc, "lights.chosen"), &mut lights.chosen, 0, |ui, chosen| {
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
                    LightId::Rectangle => Command::PlaceRectangle,
                    _ => Command::Select(Selected::Light(light)),
                });
            }
        });
    });
}

/// The rows of an orbiting light.
pub(super) fn orbit(ui: &mut Ui, settings: &mut Settings, index: usize) {
    let default = LightSettings::default();
    let Some((light, default)) = settings.lights.orbit.get_mut(index).zip(default.orbit.get(index)) else { return };
    setting(ui, ("Color", "", &format!("lights.orbit.{index}.color")), &mut light.color, default.color, color);
    ORBIT.iter().for_each(|row| number(ui, settings, &row.of_light(index)));
}

/// The rows of the rectangular light.
pub(super) fn rectangle(ui: &mut Ui, settings: &mut Settings) {
    let default = RectLight::default();
    let light = &mut settings.lights.rect;
    let doc = "One-sided area light that faces the model's center";
    setting(ui, ("On", doc, "lights.rect.enabled"), &mut light.enabled, default.enabled, check);
    if light.enabled {
        setting(ui, ("Color", "", "lights.rect.color"), &mut light.color, default.color, color);
        RECTANGLE.iter().for_each(|row| number(ui, settings, row));
    }
}
