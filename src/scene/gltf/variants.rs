//! Reads KHR_materials_variants: named sets of materials for the same primitives.

use gltf::json;

use super::super::error::Problem;
use super::values::{self, Fields};

const NAME: &str = "KHR_materials_variants";

/// The names of a file's variants. Warns of duplicates.
pub fn names(root: &json::Root, warnings: &mut Vec<String>) -> Result<Vec<String>, Problem> {
    let Some(others) = root.extensions.as_ref().map(|extensions| &extensions.others) else { return Ok(Vec::new()) };
    let Some(fields) = Fields::open(others, NAME, "extensions")? else { return Ok(Vec::new()) };
    let mut names: Vec<String> = Vec::new();
    for (index, variant) in list(&fields, "variants")?.iter().enumerate() {
        let Some(name) = variant.get("name").and_then(json::Value::as_str).filter(|name| !name.is_empty()) else {
            let place = format!("{}[{index}]", fields.at("variants"));
            return Err(Problem::invalid(place, "a variant with a name", values::quote(variant)));
        };
        names.push(name.to_owned());
    }
    let mut sorted: Vec<&String> = names.iter().collect();
    sorted.sort_unstable();
    for pair in sorted.windows(2).filter(|pair| pair[0] == pair[1]) {
        warnings.push(format!("The variant '{}' is there more than once: the first is the one to choose.", pair[0]));
    }
    Ok(names)
}

/// The materials of a primitive by variant: (variant, material), as indices of the file.
pub fn mapping(
    primitive: &json::mesh::Primitive,
    variants: usize,
    materials: usize,
    place: &str,
) -> Result<Vec<(usize, usize)>, Problem> {
    let Some(others) = primitive.extensions.as_ref().map(|extensions| &extensions.others) else {
        return Ok(Vec::new());
    };
    // Without variants, which may be left out, mappings are for nobody.
    let fields = if variants > 0 { Fields::open(others, NAME, &format!("{place}.extensions"))? } else { None };
    let Some(fields) = fields else { return Ok(Vec::new()) };
    let mut mapping = Vec::new();
    for (index, entry) in list(&fields, "mappings")?.iter().enumerate() {
        let place = format!("{}[{index}]", fields.at("mappings"));
        let material = indexed(entry.get("material"), &format!("{place}.material"), "materials", materials)?;
        let place = format!("{place}.variants");
        let Some(of) = entry.get("variants").and_then(json::Value::as_array) else {
            return Err(Problem::invalid(place, "a list of variants", values::quote(entry)));
        };
        for variant in of {
            mapping.push((indexed(Some(variant), &place, "variants", variants)?, material));
        }
    }
    mapping.sort_unstable();
    match mapping.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        None => Ok(mapping),
        Some(pair) => {
            let found = format!("variant {} twice", pair[0].0);
            Err(Problem::invalid(fields.at("mappings"), "each variant once at most", found))
        }
    }
}

fn list<'a>(fields: &Fields<'a>, key: &str) -> Result<&'a [json::Value], Problem> {
    match fields.get(key) {
        None => Ok(&[]),
        Some(json::Value::Array(values)) => Ok(values),
        Some(other) => Err(Problem::invalid(fields.at(key), "a list", values::quote(other))),
    }
}

fn indexed(value: Option<&json::Value>, place: &str, kind: &str, count: usize) -> Result<usize, Problem> {
    let index = values::index(value, place, kind)?;
    if index < count { Ok(index) } else { Err(super::place::out_of_range(place, kind, index, count)) }
}
