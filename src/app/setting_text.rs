//! A setting with its value as the panels name them: `Tone map: aces`, `Diffuse: Lambert`.

use super::numbers::{Number, default_of, of_constant, of_parameter, title};
use crate::settings::{Settings, ShaderValue, Value, setting};
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::number;
use crate::shader::{Constant, Parameter, ShaderSet};

/// Most characters of a value.
const LONGEST: usize = 24;

/// The setting at a path with its value, or with the default that the shaders declare. `stored`: the value as it is stored.
pub(super) fn setting_text(path: &str, stored: Option<&str>, settings: &Settings, shaders: &ShaderSet) -> String {
    let declared = || of_shader(path.strip_prefix("shader.")?, settings, shaders);
    let (label, value) = declared()
        .or_else(|| of_pass(path.strip_prefix("passes.")?, settings, shaders))
        .or_else(|| of_setting(path, settings))
        .unwrap_or_else(|| (path.to_owned(), stored.unwrap_or("default").to_owned()));
    match value.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{label}: {}…", &value[..end]),
        None => format!("{label}: {value}"),
    }
}

fn of_shader(name: &str, settings: &Settings, shaders: &ShaderSet) -> Option<(String, String)> {
    let value = settings.shader.get(name);
    let constant = shaders.constants.iter().find(|constant| constant.name == name);
    if let Some(constant @ Constant { label, choices, scalar, .. }) = constant {
        let number = value.and_then(|value| number(value, choices)).unwrap_or_else(|| default_of(constant));
        let plain = || of_constant(constant).map_or_else(|| number.to_string(), |scale| scale.text(number));
        return Some((label.clone(), number_text(number, choices, *scalar == Scalar::Bool, plain)));
    }
    let parameter @ Parameter { label, choices, kind, default, .. } =
        shaders.parameters.iter().find(|parameter| parameter.name == name)?;
    let numbers = match value {
        Some(ShaderValue::Vector(numbers)) => numbers.clone(),
        Some(value) => vec![number(value, choices)?],
        None => default.clone(),
    };
    let text = match numbers.as_slice() {
        [number] => {
            let plain = || of_parameter(parameter).map_or_else(|| number.to_string(), |scale| scale.text(*number));
            number_text(*number, choices, *kind == ParameterType::Bool, plain)
        }
        numbers => numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", "),
    };
    Some((label.clone(), text))
}

fn of_pass(name: &str, settings: &Settings, shaders: &ShaderSet) -> Option<(String, String)> {
    let pass = shaders.graph.pass(name)?;
    Some((pass.desc.label.clone(), switch(pass.is_wanted(&settings.passes))))
}

fn of_setting(path: &str, settings: &Settings) -> Option<(String, String)> {
    let setting = setting(path).filter(|setting| !setting.entry.label.is_empty())?;
    if let Some(number) = Number::of(setting).find(|number| number.path() == path) {
        return Some((number.title(), number.scale().text(number.get(settings))));
    }
    Some((title(setting, setting.entry.label), text(settings.value(path)?)))
}

fn text(value: Value) -> String {
    match value {
        Value::Switch(on) => switch(on),
        value => value.to_string(),
    }
}

/// A number of the shaders: a choice by its name, a switch as on or off.
fn number_text(number: f64, choices: &[(String, i64)], is_switch: bool, plain: impl Fn() -> String) -> String {
    let choice = choices.iter().find(|(_, value)| *value as f64 == number);
    match choice {
        Some((name, _)) => name.clone(),
        None if is_switch => switch(number != 0.0),
        None => plain(),
    }
}

fn switch(on: bool) -> String {
    if on { "on" } else { "off" }.to_owned()
}
