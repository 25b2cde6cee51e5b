//! The panel Parameters: a control for each `//@ui` constant and parameter. Reloads keep their values by name.

use std::collections::BTreeMap;

use egui::{Response, RichText, Slider, Ui};

use super::passes::switches;
use super::{ACCENT, NAME, QUIET, color};
use crate::settings::ShaderValue;
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::number;
use crate::shader::{Constant, Parameter, ShaderSet};

/// Shows the panel. `values` holds the values that were set, by name.
pub(super) fn show(ui: &mut Ui, shaders: &ShaderSet, values: &mut BTreeMap<String, ShaderValue>) {
    if shaders.constants.is_empty() && shaders.parameters.is_empty() {
        return;
    }
    // Those of passes stand below the switch of their pass.
    let is_wanted = |parameter: &&Parameter| {
        let switch = shaders.constants.iter().find(|constant| Some(&constant.name) == parameter.when.as_ref());
        parameter.offset.is_some() && switch.is_none_or(|switch| is_true(switch, values))
    };
    // A switch of passes stands with them.
    let is_switch = |constant: &&Constant| switches(shaders).any(|switch| switch.id == constant.id);
    let parameters: Vec<&Parameter> = shaders.parameters.iter().filter(is_wanted).collect();
    let constants: Vec<&Constant> = shaders.constants.iter().filter(|constant| !is_switch(constant)).collect();
    // Without a group first, then group by group in the order in which the tree names them.
    let mut groups = vec![""];
    let named = parameters.iter().map(|p| p.group.as_str()).chain(constants.iter().map(|c| c.group.as_str()));
    named.for_each(|group| {
        if !groups.contains(&group) {
            groups.push(group)
        }
    });
    for group in groups {
        if !group.is_empty() {
            ui.label(RichText::new(group).small().color(QUIET));
        }
        for parameter in parameters.iter().filter(|parameter| parameter.group == group) {
            show_parameter(ui, parameter, values);
        }
        for constant in constants.iter().filter(|constant| constant.group == group) {
            show_constant(ui, constant, values);
        }
    }
    let set = !values.is_empty();
    let button = ui.add_enabled(set, egui::Button::new("Defaults"));
    if button.on_hover_text("All parameters above as the shader files say; no other setting changes").clicked() {
        values.clear();
    }
}

/// Shows the row of a constant.
pub(super) fn show_constant(ui: &mut Ui, constant: &Constant, values: &mut BTreeMap<String, ShaderValue>) {
    let Constant { name, label, doc, choices, .. } = constant;
    setting(ui, &About { name, label, doc, choices }, values, |ui, value| edit_constant(ui, constant, value));
}

/// Shows the row of a parameter.
pub(super) fn show_parameter(ui: &mut Ui, parameter: &Parameter, values: &mut BTreeMap<String, ShaderValue>) {
    let Parameter { name, label, doc, choices, .. } = parameter;
    setting(ui, &About { name, label, doc, choices }, values, |ui, value| edit_parameter(ui, parameter, value));
}

/// The words about a setting of the shaders.
struct About<'a> {
    name: &'a str,
    label: &'a str,
    doc: &'a str,
    choices: &'a [(String, i64)],
}

/// Shows a row: the name, which has another color once the value was set, and the control. Both have the same hover text. A double
/// click on the name resets the value; its menu can copy the option that sets it.
fn setting(
    ui: &mut Ui,
    about: &About<'_>,
    values: &mut BTreeMap<String, ShaderValue>,
    control: impl FnOnce(&mut Ui, Option<&ShaderValue>) -> (Option<ShaderValue>, Response),
) {
    let About { name, label, doc, .. } = *about;
    let value = values.get(name).cloned();
    let option = value.as_ref().map_or_else(|| name.to_owned(), |value| format!("{name}={}", option_of(value, about)));
    let reset = if value.is_some() { "\nDouble-click the name to reset it" } else { "" };
    let doc = format!("{doc}{}--set {option}{reset}", if doc.is_empty() { "" } else { "\n\n" });
    let text = RichText::new(label);
    let text = if value.is_some() { text.color(ACCENT) } else { text };
    ui.horizontal(|ui| {
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let title = |ui: &mut Ui| {
            ui.set_min_size(NAME);
            ui.add(egui::Label::new(text).truncate().sense(egui::Sense::click()))
        };
        let title = ui.allocate_ui_with_layout(NAME, layout, title).inner.on_hover_text(&doc);
        let (new, response) = control(ui, value.as_ref());
        response.on_hover_text(&doc);
        if let Some(new) = new {
            values.insert(name.to_owned(), new);
        }
        let mut resets = title.double_clicked();
        title.context_menu(|ui| {
            if ui.button(format!("Copy --set {option}")).clicked() {
                ui.ctx().copy_text(format!("--set {option}"));
                ui.close();
            }
            if ui.add_enabled(value.is_some(), egui::Button::new("Reset")).clicked() {
                resets = true;
                ui.close();
            }
        });
        if resets {
            values.remove(name);
        }
    });
}

/// A value as `--set` takes it.
fn option_of(value: &ShaderValue, about: &About<'_>) -> String {
    let name = |number: i64| about.choices.iter().find(|(_, choice)| *choice == number).map(|(name, _)| name.clone());
    match value {
        ShaderValue::Bool(on) => on.to_string(),
        ShaderValue::Int(number) => name(*number).unwrap_or_else(|| number.to_string()),
        ShaderValue::Float(number) => short(*number),
        ShaderValue::Vector(numbers) => numbers.iter().map(|number| short(*number)).collect::<Vec<_>>().join(","),
        ShaderValue::Name(name) => name.clone(),
    }
}

/// A number with at most four digits behind the point.
fn short(number: f64) -> String {
    ((number * 1e4).round() / 1e4).to_string()
}

/// Whether a constant is not 0.
pub(super) fn is_true(constant: &Constant, values: &BTreeMap<String, ShaderValue>) -> bool {
    let value = values.get(&constant.name).and_then(|value| number(value, &constant.choices));
    value.map_or(constant.default != 0, |value| value != 0.0)
}

fn edit_parameter(ui: &mut Ui, parameter: &Parameter, value: Option<&ShaderValue>) -> (Option<ShaderValue>, Response) {
    let Parameter { name, choices, range, unit, .. } = parameter;
    let mut numbers = match value {
        Some(ShaderValue::Vector(numbers)) if numbers.len() == parameter.default.len() => numbers.clone(),
        Some(value) => number(value, choices).map_or_else(|| parameter.default.clone(), |n| vec![n]),
        None => parameter.default.clone(),
    };
    numbers.resize(parameter.default.len(), 0.0);
    let before = numbers.clone();
    let whole = matches!(parameter.kind, ParameterType::Int | ParameterType::Uint);
    let response = match (parameter.kind, numbers.as_mut_slice()) {
        (ParameterType::Bool, [number]) => check(ui, number),
        (_, [number]) if !choices.is_empty() => choose(ui, name, choices, number),
        (_, [number]) => edit_number(ui, number, *range, whole, unit),
        (ParameterType::Vec3, [r, g, b]) if parameter.color => {
            let mut linear = [*r as f32, *g as f32, *b as f32];
            let response = color(ui, &mut linear);
            (*r, *g, *b) = (linear[0].into(), linear[1].into(), linear[2].into());
            response
        }
        (_, numbers) => {
            let mut drags = numbers.iter_mut().map(|number| drag(ui, number, *range, unit));
            let first = drags.next();
            let all = drags.fold(first, |all, next| all.map(|all| all.union(next)));
            all.unwrap_or_else(|| ui.label(""))
        }
    };
    let value = |numbers: Vec<f64>| match (parameter.kind, numbers.as_slice()) {
        (ParameterType::Bool, [number]) => ShaderValue::Bool(*number != 0.0),
        (_, [number]) if whole => ShaderValue::Int(*number as i64),
        (_, [number]) => ShaderValue::Float(*number),
        _ => ShaderValue::Vector(numbers),
    };
    // The color picker works with f32, which rounds numbers that nobody has changed.
    let is_new = numbers != before && (!parameter.color || response.changed());
    (is_new.then(|| value(numbers)), response)
}

fn edit_constant(ui: &mut Ui, constant: &Constant, value: Option<&ShaderValue>) -> (Option<ShaderValue>, Response) {
    let Constant { name, choices, range, unit, .. } = constant;
    let default = match constant.scalar {
        Scalar::Float => f64::from(f32::from_bits(constant.default)),
        Scalar::Int => f64::from(constant.default.cast_signed()),
        Scalar::Uint | Scalar::Bool => f64::from(constant.default),
    };
    let before = value.and_then(|value| number(value, choices)).unwrap_or(default);
    let mut now = before;
    let response = match constant.scalar {
        _ if !choices.is_empty() => choose(ui, name, choices, &mut now),
        Scalar::Bool => check(ui, &mut now),
        Scalar::Float => edit_number(ui, &mut now, *range, false, unit),
        Scalar::Int | Scalar::Uint => edit_number(ui, &mut now, *range, true, unit),
    };
    let value = match constant.scalar {
        Scalar::Bool => ShaderValue::Bool(now != 0.0),
        Scalar::Float => ShaderValue::Float(now),
        Scalar::Int | Scalar::Uint => ShaderValue::Int(now as i64),
    };
    ((now != before).then_some(value), response)
}

fn check(ui: &mut Ui, number: &mut f64) -> Response {
    let mut on = *number != 0.0;
    let response = ui.checkbox(&mut on, "");
    *number = f64::from(u8::from(on));
    response
}

fn choose(ui: &mut Ui, id: &str, choices: &[(String, i64)], number: &mut f64) -> Response {
    let current = choices.iter().find(|(_, value)| *value as f64 == *number);
    let text = current.map_or_else(|| number.to_string(), |(name, _)| name.clone());
    let list = egui::ComboBox::from_id_salt(id).selected_text(text).show_ui(ui, |ui| {
        for (name, value) in choices {
            ui.selectable_value(number, *value as f64, name);
        }
    });
    list.response
}

fn edit_number(ui: &mut Ui, number: &mut f64, range: Option<(f64, f64)>, whole: bool, unit: &str) -> Response {
    match range {
        Some((low, high)) => {
            let slider = Slider::new(number, low..=high).suffix(suffix(unit));
            super::slide(ui, if whole { slider.integer() } else { slider.max_decimals(3) })
        }
        None => drag(ui, number, None, unit),
    }
}

fn drag(ui: &mut Ui, number: &mut f64, range: Option<(f64, f64)>, unit: &str) -> Response {
    let value = egui::DragValue::new(number).speed(0.01).suffix(suffix(unit));
    ui.add(match range {
        Some((low, high)) => value.range(low..=high),
        None => value,
    })
}

/// What follows a number with this unit.
fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}
