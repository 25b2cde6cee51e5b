//! The panel Parameters: a control for each `//@ui` constant and parameter. Reloads keep their values by name.

pub(in crate::app) mod defaults;

use std::collections::BTreeMap;

use egui::{Response, RichText, Ui};

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::numbers::{component, default_of, of_constant, of_parameter};
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::shaders::effects::{is_of_pass, switches};
use crate::app::widgets::color;
use crate::app::widgets::rows::{self, Row, edit_number, heading, set_option, short};
use crate::app::widgets::search;
use crate::app::widgets::theme::QUIET;
use crate::settings::ShaderValue;
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::number;
use crate::shader::{Constant, Parameter, ShaderSet};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Parameters", Group::Parameters, "sliders values defaults", || Box::new(ui));

/// Values of constants and parameters that were set, by name.
pub(super) type Values = BTreeMap<String, ShaderValue>;

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    // A pass that is still being compiled may have a constant that would otherwise stand here first.
    if context.shaders.generation == 1 && !context.shaders.is_complete() && !context.state.has_errors() {
        ui.label(RichText::new("Compiling shaders…").color(QUIET));
        return;
    }
    show(ui, &context.shaders, &mut commands.settings.shader, context.state.shader.is_single_file);
}

/// Shows the panel: all constants and parameters except those of passes, which the passes panel shows. With `is_of_file`, the
/// shaders are a single file without a model, and only what that file and those beside it declare is shown.
fn show(ui: &mut Ui, shaders: &ShaderSet, values: &mut Values, is_of_file: bool) {
    let is_wanted = |parameter: &&Parameter| {
        let switch = shaders.constants.iter().find(|constant| Some(&constant.name) == parameter.when.as_ref());
        let is_here = if is_of_file { is_own(&parameter.file) } else { !is_of_pass(shaders, parameter) };
        is_here && switch.is_none_or(|switch| is_true(switch, values))
    };
    let parameters: Vec<&Parameter> = shaders.parameters.iter().filter(is_wanted).collect();
    let switches: Vec<u32> = switches(shaders).map(|switch| switch.id).collect();
    let is_wanted = |constant: &&Constant| !switches.contains(&constant.id) && (!is_of_file || is_own(&constant.file));
    let constants: Vec<&Constant> = shaders.constants.iter().filter(is_wanted).collect();
    if constants.is_empty() && parameters.is_empty() {
        if is_of_file {
            ui.label(RichText::new("This shader declares no parameters").small().color(QUIET));
        }
        return;
    }
    let all: Vec<&String> = parameters.iter().map(|p| &p.name).chain(constants.iter().map(|c| &c.name)).collect();
    let set: Vec<String> = all.iter().filter(|name| values.contains_key(**name)).map(|name| (*name).clone()).collect();
    let words = search::above_kept(ui, "parameters", all.len());
    let is_found = |texts: [&str; 4]| words.is_empty() || words.are_in(&texts.join(" "));
    let parameters: Vec<&Parameter> =
        parameters.into_iter().filter(|p| is_found([&p.label, &p.name, &p.group, &p.doc])).collect();
    let constants: Vec<&Constant> =
        constants.into_iter().filter(|c| is_found([&c.label, &c.name, &c.group, &c.doc])).collect();
    if constants.is_empty() && parameters.is_empty() {
        words.no_match(ui, "parameter");
    }
    // First those without a group, then group by group in the tree's order.
    let mut groups = vec![""];
    let named = parameters.iter().map(|p| p.group.as_str()).chain(constants.iter().map(|c| c.group.as_str()));
    named.for_each(|group| {
        if !groups.contains(&group) {
            groups.push(group)
        }
    });
    for group in groups {
        if !group.is_empty() {
            heading(ui, group);
        }
        for parameter in parameters.iter().filter(|parameter| parameter.group == group) {
            show_parameter(ui, parameter, values, None);
        }
        for constant in constants.iter().filter(|constant| constant.group == group) {
            show_constant(ui, constant, values);
        }
    }
    let button = ui.add_enabled(!set.is_empty(), egui::Button::new("Defaults"));
    let resets = button.on_hover_text("Reset all parameters above to the values in the shader files").clicked();
    defaults::button(ui, !set.is_empty());
    if resets {
        set.iter().for_each(|name| drop(values.remove(name)));
    }
}

/// Whether a file, as displayed, is the author's, and not one of the tree in the program.
fn is_own(file: &str) -> bool {
    !file.starts_with("embedded:")
}

/// Shows the row of a constant.
pub(super) fn show_constant(ui: &mut Ui, constant: &Constant, values: &mut Values) {
    let Constant { name, label, doc, choices, choice_docs, .. } = constant;
    let (default, is_switch) = (&[default_of(constant)], constant.scalar == Scalar::Bool);
    let about = About { name, label, doc, choices, choice_docs, default, is_switch, is_indented: false };
    setting(ui, &about, values, |ui, value| edit_constant(ui, constant, value));
}

/// Shows the row of a parameter. `effect`: the label of the row above to which it belongs.
pub(super) fn show_parameter(ui: &mut Ui, parameter: &Parameter, values: &mut Values, effect: Option<&str>) {
    let Parameter { name, label, doc, choices, choice_docs, .. } = parameter;
    let label = label_below(label, effect.unwrap_or_default());
    let (default, is_switch) = (&parameter.default, parameter.kind == ParameterType::Bool);
    let about =
        About { name, label: &label, doc, choices, choice_docs, default, is_switch, is_indented: effect.is_some() };
    setting(ui, &about, values, |ui, value| edit_parameter(ui, parameter, value));
}

/// A label without the name of its effect: `FXAA: edge threshold` becomes `Edge threshold`.
fn label_below(label: &str, effect: &str) -> String {
    let rest = label.strip_prefix(effect).and_then(|rest| rest.strip_prefix(": "));
    let Some(rest) = rest.filter(|_| !effect.is_empty()) else { return label.to_owned() };
    let mut letters = rest.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// The texts of a setting of the shaders.
struct About<'a> {
    name: &'a str,
    label: &'a str,
    doc: &'a str,
    choices: &'a [(String, i64)],
    choice_docs: &'a [String],
    /// A number for each component.
    default: &'a [f64],
    is_switch: bool,
    is_indented: bool,
}

impl About<'_> {
    /// The meaning of the setting, and of the choice with this number.
    fn doc_with(&self, number: Option<f64>) -> String {
        let at = self.choices.iter().position(|(_, value)| Some(*value as f64) == number);
        let of_choice = at.and_then(|at| Some((&self.choices[at].0, self.choice_docs.get(at)?)));
        match of_choice.filter(|(_, doc)| !doc.is_empty()) {
            Some((choice, doc)) if !self.doc.is_empty() => format!("{}\n\n{choice}: {doc}", self.doc),
            Some((choice, doc)) => format!("{choice}: {doc}"),
            None => self.doc.to_owned(),
        }
    }
}

/// Shows the row of a setting of the shaders.
fn setting(
    ui: &mut Ui,
    about: &About<'_>,
    values: &mut Values,
    control: impl FnOnce(&mut Ui, Option<&ShaderValue>) -> (Option<ShaderValue>, Response),
) {
    if rows::skips(ui) {
        return;
    }
    let About { name, label, choices, is_indented, .. } = *about;
    let value = values.get(name).cloned();
    let number = value.as_ref().and_then(|value| number(value, choices)).or(about.default.first().copied());
    let doc = &about.doc_with(number);
    let now = value.as_ref().map_or_else(|| default_text(about), |value| option_of(value, about));
    let row = Row { name: label, doc, option: set_option(name, &now), is_changed: value.is_some(), is_indented };
    let mut new = None;
    let edit = |ui: &mut Ui| {
        let (edited, response) = control(ui, value.as_ref());
        new = edited;
        response
    };
    let resets = row.show_with(ui, edit, |ui| defaults::menu(ui, name, value.is_some()));
    if resets {
        values.remove(name);
    } else if let Some(new) = new {
        values.insert(name.to_owned(), new);
    }
}

/// The default as `--set` takes it.
fn default_text(about: &About<'_>) -> String {
    let value = match about.default {
        [number] if about.is_switch => ShaderValue::Bool(*number != 0.0),
        [number] if !about.choices.is_empty() => ShaderValue::Int(*number as i64),
        numbers => ShaderValue::Vector(numbers.to_vec()),
    };
    option_of(&value, about)
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

/// Whether a constant is not 0.
pub(super) fn is_true(constant: &Constant, values: &Values) -> bool {
    let value = values.get(&constant.name).and_then(|value| number(value, &constant.choices));
    value.map_or(constant.default != 0, |value| value != 0.0)
}

fn edit_parameter(ui: &mut Ui, parameter: &Parameter, value: Option<&ShaderValue>) -> (Option<ShaderValue>, Response) {
    let Parameter { name, choices, choice_docs, .. } = parameter;
    let mut numbers = match value {
        Some(ShaderValue::Vector(numbers)) if numbers.len() == parameter.default.len() => numbers.clone(),
        Some(value) => number(value, choices).map_or_else(|| parameter.default.clone(), |n| vec![n]),
        None => parameter.default.clone(),
    };
    numbers.resize(parameter.default.len(), 0.0);
    let before = numbers.clone();
    let scale = of_parameter(parameter);
    let response = match (parameter.kind, numbers.as_mut_slice()) {
        (ParameterType::Bool, [number]) => check(ui, number),
        (_, [number]) if !choices.is_empty() => choose(ui, name, (choices, choice_docs), number),
        (_, [number]) => edit_number(ui, &parameter.label, number, &scale.unwrap_or_else(|| component(parameter))),
        (ParameterType::Vec3, [r, g, b]) if parameter.color => {
            let mut linear = [*r as f32, *g as f32, *b as f32];
            let response = color::edit(ui, &mut linear);
            (*r, *g, *b) = (linear[0].into(), linear[1].into(), linear[2].into());
            response
        }
        (_, numbers) => edit_vector(ui, parameter, numbers),
    };
    let whole = matches!(parameter.kind, ParameterType::Int | ParameterType::Uint);
    let value = |numbers: Vec<f64>| match (parameter.kind, numbers.as_slice()) {
        (ParameterType::Bool, [number]) => ShaderValue::Bool(*number != 0.0),
        (_, [number]) if whole => ShaderValue::Int(*number as i64),
        (_, [number]) => ShaderValue::Float(*number),
        _ => ShaderValue::Vector(numbers),
    };
    // The color picker works with f32, which rounds numbers that the user has not changed.
    let is_new = numbers != before && (!parameter.color || response.changed());
    (is_new.then(|| value(numbers)), response)
}

/// A number for each component, side by side.
fn edit_vector(ui: &mut Ui, parameter: &Parameter, numbers: &mut [f64]) -> Response {
    let mut scale = component(parameter);
    // The unit is in the hover text of the row, since the numbers are narrow.
    scale.suffix.clear();
    ui.spacing_mut().item_spacing.x = 3.0;
    let count = numbers.len().max(1) as f32;
    let width = (ui.available_width() - 3.0 * (count - 1.0)) / count;
    let mut drags = numbers.iter_mut().map(|number| rows::drag(ui, number, &scale, width));
    let first = drags.next();
    let all = drags.fold(first, |all, next| all.map(|all| all.union(next)));
    all.unwrap_or_else(|| ui.label(""))
}

fn edit_constant(ui: &mut Ui, constant: &Constant, value: Option<&ShaderValue>) -> (Option<ShaderValue>, Response) {
    let Constant { name, choices, choice_docs, .. } = constant;
    let default = default_of(constant);
    let before = value.and_then(|value| number(value, choices)).unwrap_or(default);
    let mut now = before;
    let response = match of_constant(constant) {
        _ if !choices.is_empty() => choose(ui, name, (choices, choice_docs), &mut now),
        Some(scale) => edit_number(ui, &constant.label, &mut now, &scale),
        None => check(ui, &mut now),
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
    let response = rows::check(ui, &mut on);
    *number = f64::from(u8::from(on));
    response
}

fn choose(ui: &mut Ui, id: &str, (choices, docs): (&[(String, i64)], &[String]), number: &mut f64) -> Response {
    let current = choices.iter().position(|(_, value)| *value as f64 == *number);
    let text = current.map_or_else(|| number.to_string(), |at| choices[at].0.clone());
    let doc = |at: usize| docs.get(at).filter(|doc| !doc.is_empty());
    rows::choose(ui, id, text, |ui| {
        for (at, (name, value)) in choices.iter().enumerate() {
            let choice = ui.selectable_value(number, *value as f64, name);
            if let Some(doc) = doc(at) {
                choice.on_hover_text(doc);
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_untouched_setting_has_the_option_of_its_default() {
        let choices = [("GGX".to_owned(), 0), ("Beckmann".to_owned(), 1)];
        let text = |default: &[f64], choices, is_switch| {
            default_text(&About {
                name: "x",
                label: "",
                doc: "",
                choices,
                choice_docs: &[],
                default,
                is_switch,
                is_indented: false,
            })
        };
        assert_eq!(text(&[1.0], &choices, false), "Beckmann");
        assert_eq!(text(&[1.0], &[], true), "true");
        assert_eq!(text(&[0.12], &[], false), "0.12");
        assert_eq!(text(&[1.0, 0.8, 0.6], &[], false), "1,0.8,0.6");
    }

    #[test]
    fn a_label_does_not_repeat_its_effect() {
        assert_eq!(label_below("FXAA: edge threshold", "FXAA"), "Edge threshold");
        assert_eq!(label_below("Bloom strength", "Bloom"), "Bloom strength");
        assert_eq!(label_below(": x", ""), ": x");
    }
}
