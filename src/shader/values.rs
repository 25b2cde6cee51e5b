//! Looks up the values of the shader tree's constants and parameters in the settings, and converts them to the bits that the
//! shader reads.

use std::collections::BTreeMap;

use crate::interface::PARAMS_SIZE;
use crate::message::{did_you_mean, either};
use crate::settings::{ShaderValue, unknown_setting};
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::{Constant, Parameter, ShaderSet};

type Values = BTreeMap<String, ShaderValue>;
/// Specialization constants: ids and the bits of their values.
type Specialization = Vec<(u32, u32)>;

/// The values of all specialization constants by ascending id, so that equal values give equal pipelines. A constant whose value
/// does not fit gets its default.
pub(crate) fn constants(values: &Values, constants: &[Constant]) -> Specialization {
    let set = |c: &Constant| values.get(&c.name).and_then(|value| constant_bits(c, value).ok());
    constants.iter().map(|c| (c.id, set(c).unwrap_or(c.default))).collect()
}

/// A message for each value that does not fit its constant or parameter. The settings keep these values, since they may fit
/// after the next edit.
pub fn misfits(values: &Values, shaders: &ShaderSet) -> Vec<String> {
    let constants = shaders.constants.iter().filter_map(|c| constant_bits(c, values.get(&c.name)?).err());
    let parameters = shaders.parameters.iter().filter_map(|p| parameter_numbers(p, values.get(&p.name)).err());
    constants.chain(parameters).collect()
}

fn constant_bits(constant: &Constant, value: &ShaderValue) -> Result<u32, String> {
    let number = constant_number(constant, value)?;
    Ok(match constant.scalar {
        Scalar::Bool => u32::from(number != 0.0),
        Scalar::Float => (number as f32).to_bits(),
        Scalar::Int => (number as i32).cast_unsigned(),
        Scalar::Uint => number as u32,
    })
}

/// A value as the number of a constant.
pub(super) fn constant_number(constant: &Constant, value: &ShaderValue) -> Result<f64, String> {
    let number = fitting(value, constant.scalar, &constant.choices)
        .ok_or_else(|| misfit(&constant.name, value, &takes_constant(constant), &constant.choices))?;
    within(&constant.name, constant.range, &[number])?;
    Ok(number)
}

/// The `PARAMS_SIZE` bytes of the uniform block `Params`. A parameter whose value does not fit gets its default.
pub(crate) fn params(values: &Values, parameters: &[Parameter]) -> Vec<u8> {
    let mut block = vec![0; PARAMS_SIZE as usize];
    for parameter in parameters {
        if let Some(offset) = parameter.offset {
            write(&mut block, offset, parameter, values);
        }
    }
    block
}

/// The bytes of a pass's own uniform block: `size` bytes with the members at these offsets. A member without `//@ui` is 0.
pub(crate) fn block(values: &Values, parameters: &[Parameter], members: &[(u32, String)], size: u32) -> Vec<u8> {
    let mut block = vec![0; size as usize];
    for (offset, name) in members {
        if let Some(parameter) = parameters.iter().find(|parameter| parameter.name == *name) {
            write(&mut block, *offset, parameter, values);
        }
    }
    block
}

/// Writes a parameter's value to a block. A value that does not fit counts as the default.
fn write(block: &mut [u8], offset: u32, parameter: &Parameter, values: &Values) {
    let numbers = parameter_numbers(parameter, values.get(&parameter.name));
    let numbers = numbers.unwrap_or_else(|_| parameter.default.clone());
    for (i, number) in numbers.into_iter().enumerate() {
        let bits = match parameter.kind {
            ParameterType::Int => (number as i32).cast_unsigned(),
            ParameterType::Uint => number as u32,
            ParameterType::Bool => u32::from(number != 0.0),
            _ => (number as f32).to_bits(),
        };
        let at = offset as usize + i * 4;
        if let Some(place) = block.get_mut(at..at + 4) {
            place.copy_from_slice(&bits.to_ne_bytes());
        }
    }
}

/// The numbers of a parameter, one per component; without a value its default.
pub(super) fn parameter_numbers(parameter: &Parameter, value: Option<&ShaderValue>) -> Result<Vec<f64>, String> {
    let Some(value) = value else { return Ok(parameter.default.clone()) };
    let numbers = match value {
        ShaderValue::Vector(numbers) => Some(numbers.clone()),
        value => fitting(value, parameter.kind.scalar(), &parameter.choices).map(|number| vec![number]),
    };
    let fits = |numbers: &Vec<f64>| {
        let scalar = parameter.kind.scalar();
        let fits = |number: &f64| fitting(&ShaderValue::Float(*number), scalar, &parameter.choices).is_some();
        numbers.len() == parameter.kind.components() && numbers.iter().all(fits)
    };
    let numbers = numbers
        .filter(fits)
        .ok_or_else(|| misfit(&parameter.name, value, &takes_parameter(parameter), &parameter.choices))?;
    within(&parameter.name, parameter.range, &numbers)?;
    Ok(numbers)
}

/// The number of a value, if it is valid for a constant or parameter of this type. Of a list of choices, only the names and
/// their numbers are valid.
fn fitting(value: &ShaderValue, scalar: Scalar, choices: &[(String, i64)]) -> Option<f64> {
    let number = number(value, choices)?;
    let is_bool = matches!(value, ShaderValue::Bool(_));
    let is_whole = number.fract() == 0.0;
    let fits = match scalar {
        _ if !choices.is_empty() => !is_bool && choices.iter().any(|(_, known)| *known as f64 == number),
        Scalar::Bool => is_bool || number == 0.0 || number == 1.0,
        _ if is_bool => false,
        Scalar::Float => (number as f32).is_finite(),
        Scalar::Int => is_whole && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number),
        Scalar::Uint => is_whole && (0.0..=f64::from(u32::MAX)).contains(&number),
    };
    fits.then_some(number)
}

fn misfit(name: &str, value: &ShaderValue, takes: &str, choices: &[(String, i64)]) -> String {
    let hint = match value {
        ShaderValue::Name(typed) => did_you_mean(typed, choices.iter().map(|(name, _)| name.as_str())),
        _ => String::new(),
    };
    format!("{name} cannot be {}; it takes {takes}.{hint}", shown(value))
}

/// Refuses numbers outside the declared range.
fn within(name: &str, range: Option<(f64, f64)>, numbers: &[f64]) -> Result<(), String> {
    let Some((low, high)) = range else { return Ok(()) };
    let Some(at) = numbers.iter().position(|n| !(low..=high).contains(n)) else { return Ok(()) };
    let component = if numbers.len() > 1 { format!(".{at}") } else { String::new() };
    Err(format!("{name}{component} is {}; it can be {low} to {high}", numbers[at]))
}

fn takes_constant(constant: &Constant) -> String {
    takes(constant.scalar, 1, &constant.choices, constant.range)
}

fn takes_parameter(parameter: &Parameter) -> String {
    takes(parameter.kind.scalar(), parameter.kind.components(), &parameter.choices, parameter.range)
}

/// The valid values of a constant or parameter: `GGX or Beckmann (0 or 1)`, `a number, 0 to 1`.
fn takes(scalar: Scalar, components: usize, choices: &[(String, i64)], range: Option<(f64, f64)>) -> String {
    let within = range.map(|(low, high)| format!(", {low} to {high}")).unwrap_or_default();
    match scalar {
        _ if !choices.is_empty() => {
            let (names, numbers): (Vec<&str>, Vec<i64>) = choices.iter().map(|(name, n)| (name.as_str(), *n)).unzip();
            format!("{} ({})", either(&names), either(&numbers))
        }
        Scalar::Bool => "true or false".to_owned(),
        Scalar::Float if components > 1 => {
            format!("{components} numbers, as {}{within}", vec!["0.5"; components].join(","))
        }
        Scalar::Float => format!("a number{within}"),
        Scalar::Uint if range.is_none() => "a whole number, 0 or more".to_owned(),
        Scalar::Int | Scalar::Uint => format!("a whole number{within}"),
    }
}

/// Whether a value is the default of the constant or parameter of this name.
pub(crate) fn is_default(shaders: &ShaderSet, name: &str, value: &ShaderValue) -> bool {
    let constant = shaders.constants.iter().find(|constant| constant.name == name);
    let parameter = shaders.parameters.iter().find(|parameter| parameter.name == name);
    match (constant, parameter) {
        (Some(constant), _) => constant_bits(constant, value) == Ok(constant.default),
        (None, Some(parameter)) => {
            let narrow = |numbers: &[f64]| numbers.iter().map(|number| *number as f32).collect::<Vec<_>>();
            parameter_numbers(parameter, Some(value)).is_ok_and(|now| narrow(&now) == narrow(&parameter.default))
        }
        (None, None) => false,
    }
}

/// A message about the first name in `values` that the tree lacks, with the nearest name. `None` if all exist.
pub fn unknown_names(values: &Values, shaders: &ShaderSet) -> Option<String> {
    let constants = shaders.constants.iter().map(|c| (c.name.as_str(), takes_constant(c)));
    let parameters = shaders.parameters.iter().map(|p| (p.name.as_str(), takes_parameter(p)));
    let known: Vec<(&str, String)> = constants.chain(parameters).collect();
    let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
    let unknown = values.keys().find(|name| !names.contains(&name.as_str()))?;
    let describe = |name: &str| known.iter().find(|(known, _)| *known == name).map(|(_, takes)| takes.clone());
    Some(unknown_setting(unknown, &names, describe))
}

/// A value as a number. A name is looked up in `choices`, ignoring case. `None` for vectors and unknown names.
pub fn number(value: &ShaderValue, choices: &[(String, i64)]) -> Option<f64> {
    match value {
        ShaderValue::Bool(b) => Some(f64::from(u8::from(*b))),
        ShaderValue::Int(i) => Some(*i as f64),
        ShaderValue::Float(f) => Some(*f).filter(|f| f.is_finite()),
        ShaderValue::Vector(v) => <[f64; 1]>::try_from(v.clone()).ok().map(|[n]| n),
        ShaderValue::Name(name) => {
            choices.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, value)| *value as f64)
        }
    }
}

fn shown(value: &ShaderValue) -> String {
    match value {
        ShaderValue::Bool(b) => b.to_string(),
        ShaderValue::Int(i) => i.to_string(),
        ShaderValue::Float(f) => f.to_string(),
        ShaderValue::Vector(v) => format!("{v:?}"),
        ShaderValue::Name(name) => format!("'{name}'"),
    }
}
