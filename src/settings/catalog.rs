//! The list of all settings with what each takes, for `specula help set` and for messages.

use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::sync::LazyLock;

use clap::ValueEnum;

use super::{Channels, Colormap, LightSource, Settings, Tonemap};
use crate::message;

/// One setting, ready to be printed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Path for `--set`, as `lights.orbit.0.strength`.
    pub path: String,
    /// Kind of value: a number, three numbers, a name, ...
    pub takes: &'static str,
    /// Value without any option; empty when there is none.
    pub default: String,
    /// The range of a number; empty when any number fits, or for other types.
    pub range: String,
    /// Unit or color space; empty for pure numbers.
    pub unit: &'static str,
    /// The effect of the setting.
    pub doc: String,
}

/// Path, unit and meaning of every setting. A `*` in a path stands for the number of an orbiting light.
const DESCRIBED: &[(&str, &str, &str)] = &[
    ("mode", "", "Debug mode; `specula modes` lists them"),
    ("variant", "", "Variant of the model; without one its own materials"),
    ("measured", "", "File of a measured BRDF, for the modes `measured...`"),
    ("expression.at", "", "Expression of the shaders that the mode `expression` shows: FILE:LINE:NAME"),
    ("camera.eye", "meters", "Position of the camera; without it the model is framed"),
    ("camera.target", "meters", "Point that the camera looks at; without it the center of the model"),
    ("camera.fovy", "degrees", "Vertical field of view"),
    ("camera.azimuth", "degrees", "Framing: angle around the model, from +Z towards +X"),
    ("camera.elevation", "degrees", "Framing: angle above the horizon"),
    ("lights.source", "", "Which lights shine"),
    ("lights.spin", "degrees/s", "Speed of the orbiting lights in the window"),
    ("lights.chosen", "", "Light that the BRDF terms show, counted from 1; 0: all of them"),
    ("lights.ambient_color", "linear RGB", "Color of the flat light without an environment"),
    ("lights.ambient_strength", "cd/m^2", "Strength of the flat light without an environment"),
    ("lights.orbit.*.color", "linear RGB", "Color"),
    ("lights.orbit.*.strength", "candela", "Intensity for a model with a radius of 1 m"),
    ("lights.orbit.*.distance", "radii", "Distance from the model's center, in radii of the model"),
    ("lights.orbit.*.azimuth", "degrees", "Angle around +Y, from +Z towards +X"),
    ("lights.orbit.*.polar", "degrees", "Angle from +Y"),
    ("lights.rect.enabled", "", "Whether the rectangle shines"),
    ("lights.rect.color", "linear RGB", "Color"),
    ("lights.rect.strength", "cd/m^2", "Luminance of white; it does not depend on the size"),
    ("lights.rect.width", "radii", "Length of the horizontal edges, in radii of the model"),
    ("lights.rect.height", "radii", "Length of the other edges, in radii of the model"),
    ("lights.rect.distance", "radii", "Distance from the model's center, in radii of the model"),
    ("lights.rect.azimuth", "degrees", "Angle around +Y, from +Z towards +X"),
    ("lights.rect.polar", "degrees", "Angle from +Y"),
    ("material.enabled", "", "Whether this material replaces all of the model's"),
    ("material.override", "", "Channels that it replaces alone: base_color, metallic, roughness, anisotropy"),
    ("material.base_color", "linear RGB", "Base color: 0.5 is half the light, which a picture stores as 188 of 255"),
    ("material.metallic", "", "0 dielectric, 1 metal"),
    ("material.roughness", "", "Perceptual roughness"),
    ("material.anisotropy", "", "Strength of the anisotropy"),
    ("material.anisotropy_rotation", "degrees", "Angle from the tangent towards the bitangent"),
    ("scene.hidden", "", "Nodes and primitives that are not drawn: names, or #3 for the node with this index"),
    ("scene.isolated", "", "Nodes and primitives that alone are drawn; none: all"),
    ("model.rotation", "degrees", "Rotation of the model about its X, Y and Z axis, about Z first and Y last"),
    ("model.scale", "", "Factor on the model's lengths"),
    ("model.translation", "meters", "Where the origin of the model's file is"),
    ("environment.name", "", "studio, furnace, sky, none, or a .hdr or .exr file"),
    ("environment.rotation", "degrees", "Angle around +Y"),
    ("environment.intensity", "", "Factor on the map, whose values are cd/m^2"),
    ("environment.blur", "", "Blur behind the model, as a roughness"),
    (
        "environment.suns",
        "",
        "Whether suns of the map light the model as lamps do; otherwise they are a part of the prefiltered light",
    ),
    ("view.tonemap", "", "Tone map"),
    ("view.ev", "EV100", "Exposure: 1 / (1.2 * 2^EV100), so +1 is half as bright; Exposure in the window is -EV100"),
    ("view.channels", "", "Channels that the picture shows; a is coverage"),
    ("view.colormap", "", "Colors that stand for a number, in modes with one component and for a single channel"),
    (
        "view.dither",
        "",
        "Noise of half a step of 8 bits, which hides bands in light; the window has it, `render` does not",
    ),
    ("view.wireframe", "", "Edges of the triangles over the picture"),
];

/// The rest of [`DESCRIBED`]: what each can be is no range of floats.
const DESCRIBED_WITH_RANGE: &[(&str, &str, &str, &str)] = &[
    (
        "expression.evaluation",
        "",
        "0 to 4294967295",
        "Which evaluation of the expression in a pixel counts, from 1; 0: the last",
    ),
    ("view.background", "", "", "none (transparent), env, or #rrggbb"),
    (
        "view.range",
        "",
        "mode, auto, fit or LOW..HIGH",
        "The values shown as black and white: as the mode stores them, fit to the picture where that helps (auto) or always (fit)",
    ),
    ("view.msaa", "samples", "1 or 4", "Samples of each pixel"),
    ("view.frames", "frames", "1 to 100000", "Frames that `render` averages in modes that accumulate"),
    (
        "view.bounces",
        "reflections",
        "0 to 64",
        "Reflections of a random path after the first, in modes that trace the model",
    ),
    ("view.pass_memory", "MiB", "1 to 1048576", "Memory that images and buffers of passes may take"),
];

/// All settings, in the order in which they are documented.
pub fn catalog() -> Vec<Setting> {
    let defaults = toml::Value::try_from(Settings::default()).ok();
    let known = Settings::default().known().ok();
    let described = DESCRIBED.iter().map(|(path, unit, doc)| (*path, *unit, "", *doc));
    let all = described.chain(DESCRIBED_WITH_RANGE.iter().copied());
    let rows = all.flat_map(|(path, unit, range, doc)| {
        let lights = if path.contains('*') { 3 } else { 1 };
        (0..lights).map(move |light| (path.replace('*', &light.to_string()), unit, range, doc))
    });
    let mut rows: Vec<_> = rows.collect();
    // The lights one after the other, all else in place.
    let group = |path: &str| path.rsplit_once('.').map_or("", |(group, _)| group).to_owned();
    let groups: Vec<String> = rows.iter().map(|(path, ..)| group(path)).collect();
    rows.sort_by_key(|(path, ..)| groups.iter().position(|known| *known == group(path)));
    let row = |(path, unit, range, doc): (String, &'static str, &str, &str)| {
        let default = defaults.as_ref().and_then(|root| at(root, &path)).map(shown).unwrap_or_default();
        let takes = known.as_ref().and_then(|root| at(root, &path)).map(kind).unwrap_or_default();
        let range = limits(&path).map_or_else(|| range.to_owned(), |limits| told(&limits));
        let names = names(&path);
        let doc = if names.is_empty() { doc.to_owned() } else { format!("{doc}: {}", names.join(", ")) };
        Setting { takes: if names.is_empty() { takes } else { "name" }, path, default, range, unit, doc }
    };
    rows.into_iter().map(row).collect()
}

/// Paths of all settings.
pub(super) fn paths() -> Vec<String> {
    catalog().into_iter().map(|setting| setting.path).collect()
}

/// The names that a setting with a fixed choice takes; empty for all other settings.
pub(super) fn names(path: &str) -> Vec<String> {
    fn of<T: ValueEnum>() -> Vec<String> {
        T::value_variants().iter().filter_map(|v| Some(v.to_possible_value()?.get_name().to_owned())).collect()
    }
    match path {
        "view.tonemap" => of::<Tonemap>(),
        "lights.source" => of::<LightSource>(),
        "view.channels" => of::<Channels>(),
        "view.colormap" => of::<Colormap>(),
        _ => Vec::new(),
    }
}

/// Smallest and largest value of a number, or of each of its components; `None` when it has no limits or no such
/// setting exists.
pub fn limits(path: &str) -> Option<RangeInclusive<f32>> {
    static LIMITS: LazyLock<HashMap<String, RangeInclusive<f32>>> =
        LazyLock::new(|| Settings::default().ranges().into_iter().map(|range| (range.path, range.limits)).collect());
    LIMITS.get(path).or_else(|| LIMITS.get(&format!("{path}.0"))).cloned()
}

/// Limits in words: `0 to 1`.
pub fn told(limits: &RangeInclusive<f32>) -> String {
    let number = |x: f32| if x.abs() >= 1e4 { format!("{x:e}") } else { x.to_string() };
    format!("{} to {}", number(*limits.start()), number(*limits.end()))
}

/// The setting that is most like an unknown path, and how alike they are, 0..1. A path without a dot is also compared with the last parts of all
/// paths, since that is how people abbreviate them.
pub(super) fn nearest(typed: &str, own: &[&str]) -> Option<(f64, String)> {
    let paths = paths();
    let candidates = own.iter().copied().chain(paths.iter().map(String::as_str));
    let likeness = |path: &str| {
        let whole = message::likeness(typed, path);
        let last = path.rsplit('.').next().filter(|_| !typed.contains('.')).unwrap_or(path);
        // A full name wins over an abbreviation that is equally like it.
        whole.max(0.99 * message::likeness(typed, last))
    };
    message::best(candidates.map(|path| (likeness(path), path))).map(|path| (likeness(path), path.to_owned()))
}

/// The value at a path of a table.
fn at<'a>(root: &'a toml::Value, path: &str) -> Option<&'a toml::Value> {
    path.split('.').try_fold(root, |place, key| match place {
        toml::Value::Array(array) => array.get(key.parse::<usize>().ok()?),
        other => other.get(key),
    })
}

fn kind(value: &toml::Value) -> &'static str {
    match value {
        toml::Value::Float(_) => "number",
        toml::Value::Integer(_) => "whole number",
        toml::Value::Boolean(_) => "true or false",
        toml::Value::Array(list) if list.is_empty() => "names",
        toml::Value::Array(_) => "3 numbers",
        _ => "text",
    }
}

/// A value as it is typed after `=`. Floats are those of an `f32`.
fn shown(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(x) => (*x as f32).to_string(),
        toml::Value::Array(list) => list.iter().map(shown).collect::<Vec<_>>().join(","),
        toml::Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves(value: &toml::Value, path: &str, out: &mut Vec<String>) {
        let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        match value {
            toml::Value::Table(table) => table.iter().for_each(|(key, value)| leaves(value, &below(key), out)),
            toml::Value::Array(list) if list.iter().any(toml::Value::is_table) => {
                list.iter().enumerate().for_each(|(i, value)| leaves(value, &below(&i.to_string()), out));
            }
            _ => out.push(path.to_owned()),
        }
    }

    #[test]
    fn every_setting_is_described_once() {
        let (mut expected, mut found) = (Vec::new(), paths());
        leaves(&Settings::default().known().unwrap(), "", &mut expected);
        expected.sort();
        found.sort();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_setting_is_found_by_its_last_part() {
        for (typed, own, expected) in [
            ("tonemap", &[][..], Some("view.tonemap")),
            ("ndf", &["NDF"], Some("NDF")),
            ("view.exposure", &[], Some("view.ev")),
            ("roughness", &["roughness_scale"], Some("material.roughness")),
            ("qqqqq", &["NDF"], None),
        ] {
            assert_eq!(nearest(typed, own).as_ref().map(|(_, name)| name.as_str()), expected, "{typed}");
        }
    }

    #[test]
    fn limits_are_those_that_are_checked() {
        assert_eq!(limits("camera.fovy"), Some(1.0..=170.0));
        assert_eq!(limits("lights.orbit.2.color").map(|l| told(&l)).as_deref(), Some("0 to 1e6"));
        assert_eq!(limits("camera.eye"), None);
    }
}
