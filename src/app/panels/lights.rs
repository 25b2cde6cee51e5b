//! The panel Lights: which lights are on, the orbiting lights, the rectangle and the ambient light.

use egui::{DragValue, Slider, Ui};

use super::{angle, color, row, slide};
use crate::settings::{LightSettings, LightSource, RectLight};

/// Shows the panel. `in_model` is the number of lights in the model. `has_environment`: an environment replaces the ambient light.
pub(super) fn show(ui: &mut Ui, lights: &mut LightSettings, in_model: usize, has_environment: bool) {
    row(ui, "Source", "Which lights are on (--lights)", |ui| {
        ui.selectable_value(&mut lights.source, LightSource::Orbit, "Orbit");
        let model = egui::Button::selectable(lights.source == LightSource::Model, format!("Model ({in_model})"));
        if ui.add_enabled(in_model > 0, model).clicked() {
            lights.source = LightSource::Model;
        }
        ui.selectable_value(&mut lights.source, LightSource::None, "None");
    });
    row(
        ui,
        "Terms of light",
        "The light whose BRDF terms the modes show. All: the terms of light 1, and the sum of the lobes over all lights",
        |ui| {
            ui.selectable_value(&mut lights.chosen, 0, "All");
            let count = if lights.source == LightSource::Model { in_model.min(4) as u32 } else { 3 };
            for light in 1..=count {
                ui.selectable_value(&mut lights.chosen, light, light.to_string());
            }
        },
    );
    if lights.source == LightSource::Orbit {
        row(ui, "Orbit", "Speed around the model in degrees per second (L)", |ui| {
            slide(ui, Slider::new(&mut lights.spin, -90.0..=90.0).suffix("°/s").max_decimals(0));
        });
        for (i, light) in lights.orbit.iter_mut().enumerate() {
            ui.push_id(i, |ui| {
                ui.separator();
                row(
                    ui,
                    &format!("Light {}", i + 1),
                    "Color, and illuminance in lux at a distance of one model radius",
                    |ui| {
                        color(ui, &mut light.color);
                        slide(ui, Slider::new(&mut light.strength, 0.0..=60.0).max_decimals(1));
                    },
                );
                place(ui, &mut light.distance, &mut light.azimuth, &mut light.polar);
            });
        }
    }
    if lights.source != LightSource::None {
        ui.separator();
        rect(ui, &mut lights.rect);
    }
    ui.separator();
    let doc = "Color, and luminance of every direction in cd/m^2. An environment replaces it";
    row(ui, "Ambient", doc, |ui| {
        ui.add_enabled_ui(!has_environment, |ui| {
            color(ui, &mut lights.ambient_color);
            slide(ui, Slider::new(&mut lights.ambient_strength, 0.0..=2.0).max_decimals(2));
        });
    });
}

/// The rectangular light.
fn rect(ui: &mut Ui, light: &mut RectLight) {
    row(ui, "Rectangle", "One-sided area light: color, and luminance of white in cd/m^2", |ui| {
        ui.checkbox(&mut light.enabled, "");
        if light.enabled {
            color(ui, &mut light.color);
            slide(ui, Slider::new(&mut light.strength, 0.0..=60.0).max_decimals(1));
        }
    });
    if !light.enabled {
        return;
    }
    ui.push_id("rectangle", |ui| {
        row(ui, "Size", "Width and height in model radii", |ui| {
            ui.add(DragValue::new(&mut light.width).range(0.01..=20.0).speed(0.01).prefix("w "));
            ui.add(DragValue::new(&mut light.height).range(0.01..=20.0).speed(0.01).prefix("h "));
        });
        place(ui, &mut light.distance, &mut light.azimuth, &mut light.polar);
    });
}

/// The place of a light around the model.
fn place(ui: &mut Ui, distance: &mut f32, azimuth: &mut f32, polar: &mut f32) {
    row(ui, "Distance", "From the model center, in model radii", |ui| {
        slide(ui, Slider::new(distance, 0.5..=10.0).max_decimals(2).logarithmic(true));
    });
    angle(ui, "Azimuth", "Degrees around +Y, from +Z towards +X", azimuth, -180.0..=360.0);
    angle(ui, "Polar", "Degrees from +Y", polar, 0.0..=180.0);
}
