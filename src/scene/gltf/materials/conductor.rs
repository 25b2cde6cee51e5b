//! The complex index of refraction of a metal, `n - ik` at about 650, 550 and 450 nm. glTF has no extension for it, so it is in `extras`:
//! `{"specula": {"conductor_n": [r, g, b], "conductor_k": [r, g, b]}}`.

use gltf::json;

use crate::scene::error::Problem;
use crate::scene::extensions::LARGEST_IOR;
use crate::scene::gltf::values::{self, Fields};
use crate::scene::material::Material;

/// Specula's part of `extras`. All other members are ignored.
#[derive(serde::Deserialize)]
struct Extras {
    specula: Option<json::Value>,
}

/// Reads `extras.specula.conductor_n` and `conductor_k`.
pub fn read(material: &mut Material, source: &json::Material, place: &str) -> Result<(), Problem> {
    let text = source.extras.as_ref().map(|raw| raw.get()).filter(|text| text.starts_with('{'));
    let Some(text) = text else { return Ok(()) };
    let place = format!("{place}.extras.specula");
    let parsed: Result<Extras, _> = serde_json::from_str(text);
    let extras = parsed.map_err(|error| Problem::invalid(&place, "numbers that fit", error.to_string()))?;
    let Some(value) = extras.specula else { return Ok(()) };
    let fields = Fields::new(&value, place)?;
    let (n, k) = ("conductor_n", "conductor_k");
    match (fields.get(n), fields.get(k)) {
        (None, None) => return Ok(()),
        (Some(_), Some(_)) => {}
        (None, _) => return Err(Problem::invalid(fields.at(n), format!("3 numbers, beside {k}"), "none")),
        (_, None) => return Err(Problem::invalid(fields.at(k), format!("3 numbers, beside {n}"), "none")),
    }
    let read = |key, least: f32, expected: &str| {
        let value: [f32; 3] = fields.numbers(key, [0.0; 3])?;
        let found = || values::quote(fields.get(key).unwrap_or(&json::Value::Null));
        if !value.iter().all(|number| (least..=LARGEST_IOR).contains(number)) {
            Err(Problem::invalid(fields.at(key), expected, found()))
        } else {
            Ok(value)
        }
    };
    let n = read(n, 1e-3, "3 numbers from 0.001 to 10000")?;
    let k = read(k, 0.0, "3 numbers from 0 to 10000")?;
    material.conductor = true;
    (material.numbers.conductor_n, material.numbers.conductor_k) = (n, k);
    Ok(())
}
