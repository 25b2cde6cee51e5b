//! The panel Parameters: a control for each `//@ui` constant and parameter. Reloads keep their values by name.

use std::collections::BTreeMap;

use egui::{Slider, Ui};

use super::passes::switches;
use super::{color, row, section};
use crate::settings::ShaderValue;
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::number;
use crate::shader::{Constant, Parameter, ShaderSet};

/// Shows the panel. `values` holds the values that differ from the shader's defaults, by name.
pub(super) fn show(ui: &mut Ui, shaders: &ShaderSet, values: &mut BTreeMap<String, ShaderValue>) {
    if shaders.constants.is_empty() && shaders.parameters.is_empty() {
        return;
    }
    section(ui, "Parameters", true, |ui| {
        // Those of passes stand below the switch of their pass.
        for parameter in shaders.parameters.iter().filter(|parameter| parameter.offset.is_some()) {
            let switch = shaders.constants.iter().find(|constant| Some(&constant.name) == parameter.when.as_ref());
            if switch.is_none_or(|switch| is_true(switch, values)) {
                show_parameter(ui, parameter, values);
            }
        }
        // A switch of passes stands with them.
        let is_switch = |constant: &&Constant| switches(shaders).any(|switch| switch.id == constant.id);
        for constant in shaders.constants.iter().filter(|constant| !is_switch(constant)) {
            show_constant(ui, constant, values);
        }
        let set = !values.is_empty();
        let button = ui.add_enabled(set, egui::Button::new("Defaults"));
        if button.on_hover_text("All parameters above as the shader files say; no other setting changes").clicked() {
            values.clear();
        }
    });
}

/// Shows the row of a constant.
pub(super) fn show_constant(ui: &mut Ui, constant: &Constant, values: &mut BTreeMap<String, ShaderValue>) {
    let value = values.get(&constant.name);
    if let Some(new) = row(ui, &constant.label, &constant.name, |ui| edit_constant(ui, constant, value)) {
        values.insert(constant.name.clone(), new);
    }
}

/// Whether a constant is not 0.
pub(super) fn is_true(constant: &Constant, values: &BTreeMap<String, ShaderValue>) -> bool {
    let value = values.get(&constant.name).and_then(|value| number(value, &constant.choices));
    value.map_or(constant.default != 0, |value| value != 0.0)
}

/// Shows the row of a parameter.
pub(super) fn show_parameter(ui: &mut Ui, parameter: &Parameter, values: &mut BTreeMap<String, ShaderValue>) {
    let value = values.get(&parameter.name);
    if let Some(new) = row(ui, &parameter.label, &parameter.name, |ui| edit_parameter(ui, parameter, value)) {
        values.insert(parameter.name.clone(), new);
    }
}

fn edit_parameter(ui: &mut Ui, parameter: &Parameter, value: Option<&ShaderValue>) -> Option<ShaderValue> {
    let mut numbers = match value {
        Some(ShaderValue::Vector(numbers)) if numbers.len() == parameter.default.len() => numbers.clone(),
        Some(value) => number(value, &parameter.choices).map_or_else(|| parameter.default.clone(), |n| vec![n]),
        None => parameter.default.clone(),
    };
    numbers.resize(parameter.default.len(), 0.0);
    let before = numbers.clone();
    let whole = matches!(parameter.kind, ParameterType::Int | ParameterType::Uint);
    match (parameter.kind, numbers.as_mut_slice()) {
        (ParameterType::Bool, [number]) => *number = check(ui, *number),
        (_, [number]) if !parameter.choices.is_empty() => choose(ui, &parameter.name, &parameter.choices, number),
        (_, [number]) => slide(ui, number, parameter.range, whole),
        (ParameterType::Vec3, [r, g, b]) if parameter.color => {
            let mut linear = [*r as f32, *g as f32, *b as f32];
            color(ui, &mut linear);
            (*r, *g, *b) = (linear[0].into(), linear[1].into(), linear[2].into());
        }
        (_, numbers) => numbers.iter_mut().for_each(|number| drag(ui, number, parameter.range)),
    }
    let value = |numbers: Vec<f64>| match (parameter.kind, numbers.as_slice()) {
        (ParameterType::Bool, [number]) => ShaderValue::Bool(*number != 0.0),
        (_, [number]) if whole => ShaderValue::Int(*number as i64),
        (_, [number]) => ShaderValue::Float(*number),
        _ => ShaderValue::Vector(numbers),
    };
    (numbers != before).then(|| value(numbers))
}

fn edit_constant(ui: &mut Ui, constant: &Constant, value: Option<&ShaderValue>) -> Option<ShaderValue> {
    let default = match constant.scalar {
        Scalar::Float => f64::from(f32::from_bits(constant.default)),
        Scalar::Int => f64::from(constant.default.cast_signed()),
        Scalar::Uint | Scalar::Bool => f64::from(constant.default),
    };
    let before = value.and_then(|value| number(value, &constant.choices)).unwrap_or(default);
    let mut now = before;
    match constant.scalar {
        _ if !constant.choices.is_empty() => choose(ui, &constant.name, &constant.choices, &mut now),
        Scalar::Bool => now = check(ui, now),
        Scalar::Float => slide(ui, &mut now, constant.range, false),
        Scalar::Int | Scalar::Uint => slide(ui, &mut now, constant.range, true),
    }
    let value = match constant.scalar {
        Scalar::Bool => ShaderValue::Bool(now != 0.0),
        Scalar::Float => ShaderValue::Float(now),
        Scalar::Int | Scalar::Uint => ShaderValue::Int(now as i64),
    };
    (now != before).then_some(value)
}

fn check(ui: &mut Ui, number: f64) -> f64 {
    let mut on = number != 0.0;
    ui.checkbox(&mut on, "");
    f64::from(u8::from(on))
}

fn choose(ui: &mut Ui, id: &str, choices: &[(String, i64)], number: &mut f64) {
    let current = choices.iter().find(|(_, value)| *value as f64 == *number);
    let text = current.map_or_else(|| number.to_string(), |(name, _)| name.clone());
    egui::ComboBox::from_id_salt(id).selected_text(text).show_ui(ui, |ui| {
        for (name, value) in choices {
            ui.selectable_value(number, *value as f64, name);
        }
    });
}

fn slide(ui: &mut Ui, number: &mut f64, range: Option<(f64, f64)>, whole: bool) {
    match range {
        Some((low, high)) => {
            let slider = Slider::new(number, low..=high);
            ui.add(if whole { slider.integer() } else { slider.max_decimals(3) });
        }
        None => drag(ui, number, None),
    }
}

fn drag(ui: &mut Ui, number: &mut f64, range: Option<(f64, f64)>) {
    let value = egui::DragValue::new(number).speed(0.01);
    ui.add(match range {
        Some((low, high)) => value.range(low..=high),
        None => value,
    });
}
