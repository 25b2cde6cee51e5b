//! Values of the author's constants and parameters: from settings, by name, to the bits that the shader reads.

use std::collections::BTreeMap;

use crate::gpu::Specialization;
use crate::interface::PARAMS_SIZE;
use crate::settings::ShaderValue;
use crate::shader::annotation::ParameterType;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::{Constant, Parameter, ShaderSet};

type Values = BTreeMap<String, ShaderValue>;

/// Specialization constants: all of them, in the order of their ids, so that equal values give equal pipelines. A value that
/// does not fit leaves the default.
pub(crate) fn constants(values: &Values, constants: &[Constant]) -> Specialization {
    let set = |c: &Constant| values.get(&c.name).and_then(|value| constant_bits(c, value).ok());
    constants.iter().map(|c| (c.id, set(c).unwrap_or(c.default))).collect()
}

/// What is wrong with the values that do not fit their constant or parameter, a sentence each. They are kept: the next edit may
/// make them fit again.
pub fn misfits(values: &Values, shaders: &ShaderSet) -> Vec<String> {
    let constants = shaders.constants.iter().filter_map(|c| constant_bits(c, values.get(&c.name)?).err());
    let parameters = shaders.parameters.iter().filter_map(|p| parameter_numbers(p, values.get(&p.name)).err());
    constants.chain(parameters).collect()
}

fn constant_bits(constant: &Constant, value: &ShaderValue) -> Result<u32, String> {
    let number = number(value, &constant.choices).ok_or_else(|| {
        let expected = match constant.scalar {
            _ if !constant.choices.is_empty() => format!("one of {}", names(&constant.choices)),
            Scalar::Bool => "true or false".into(),
            Scalar::Int | Scalar::Uint => "a whole number".into(),
            Scalar::Float => "a number".into(),
        };
        format!("{} cannot be {}; it takes {expected}", constant.name, shown(value))
    })?;
    let whole = number.fract() == 0.0;
    match constant.scalar {
        Scalar::Bool => Ok(u32::from(number != 0.0)),
        Scalar::Float => Ok((number as f32).to_bits()),
        Scalar::Int if whole && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number) => {
            Ok((number as i32).cast_unsigned())
        }
        Scalar::Uint if whole && (0.0..=f64::from(u32::MAX)).contains(&number) => Ok(number as u32),
        Scalar::Int => Err(format!("{} is an int; {number} does not fit", constant.name)),
        Scalar::Uint => Err(format!("{} is a uint; {number} does not fit", constant.name)),
    }
}

/// The author's parameter block, `PARAMS_SIZE` bytes. A value that does not fit leaves the default.
pub(crate) fn params(values: &Values, parameters: &[Parameter]) -> Vec<u8> {
    let mut block = vec![0; PARAMS_SIZE as usize];
    for parameter in parameters {
        let numbers = parameter_numbers(parameter, values.get(&parameter.name));
        let numbers = numbers.unwrap_or_else(|_| parameter.default.clone());
        for (i, number) in numbers.into_iter().enumerate() {
            let bits = match parameter.kind {
                ParameterType::Int => (number as i32).cast_unsigned(),
                ParameterType::Uint => number as u32,
                ParameterType::Bool => u32::from(number != 0.0),
                _ => (number as f32).to_bits(),
            };
            let at = parameter.offset as usize + i * 4;
            if let Some(place) = block.get_mut(at..at + 4) {
                place.copy_from_slice(&bits.to_ne_bytes());
            }
        }
    }
    block
}

fn parameter_numbers(parameter: &Parameter, value: Option<&ShaderValue>) -> Result<Vec<f64>, String> {
    let count = parameter.kind.components();
    let numbers = match value {
        None => Some(parameter.default.clone()),
        Some(ShaderValue::Vector(numbers)) => Some(numbers.clone()),
        Some(value) => number(value, &parameter.choices).map(|n| vec![n]),
    };
    match numbers {
        Some(numbers) if numbers.len() == count && numbers.iter().all(|n| n.is_finite()) => {
            value.map_or(Ok(()), |_| within(parameter, &numbers))?;
            Ok(numbers)
        }
        _ => {
            let expected = match count {
                _ if !parameter.choices.is_empty() => format!("one of {}", names(&parameter.choices)),
                1 => "a number".into(),
                n => format!("{n} numbers, as [{}]", vec!["0.5"; n].join(", ")),
            };
            let found = value.map(shown).unwrap_or_default();
            Err(format!("{} cannot be {found}; it takes {expected}", parameter.name))
        }
    }
}

/// Refuses numbers outside of the declared range.
fn within(parameter: &Parameter, numbers: &[f64]) -> Result<(), String> {
    let Some((low, high)) = parameter.range else { return Ok(()) };
    let Some(at) = numbers.iter().position(|n| !(low..=high).contains(n)) else { return Ok(()) };
    let component = if numbers.len() > 1 { format!(".{at}") } else { String::new() };
    Err(format!("{}{component} is {}; it can be {low} to {high}", parameter.name, numbers[at]))
}

/// Names in `values` that the tree does not have, as a message with those it has; `None` when all exist.
pub fn unknown_names(values: &Values, shaders: &ShaderSet) -> Option<String> {
    let known: Vec<&str> =
        shaders.constants.iter().map(|c| &*c.name).chain(shaders.parameters.iter().map(|p| &*p.name)).collect();
    let unknown = values.keys().find(|name| !known.contains(&name.as_str()))?;
    let list = if known.is_empty() { "none".into() } else { known.join(", ") };
    Some(format!(
        "there is no setting or shader parameter '{unknown}'. This shader tree's own are: {list}. Settings have paths, as view.ev or lights.orbit.0.strength"
    ))
}

/// A value as one number; a name is looked up in `choices`. `None` for vectors and unknown names.
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

fn names(choices: &[(String, i64)]) -> String {
    choices.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ")
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
