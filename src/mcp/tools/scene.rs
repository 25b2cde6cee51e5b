//! Tools that open files and change settings.

use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::arguments::{flag, has, number, read, text as text_argument, vector};
use super::tool::{Caller, Content, Effect, Tool, failed, text};
use crate::mcp::program::Failure;

pub static OPEN: Tool = Tool {
    name: "open",
    title: "Open a model or an environment",
    doc: "Opens one or more files: a model (.gltf, .glb, .zip, or a built-in one such as `shader-ball`, `sphere-grid`, `metal-grid`, \
        `clearcoat`), an environment that lights it (.hdr, .exr, `studio`, `sky`, `furnace`, `none`), a look (settings), or a measured \
        BRDF. The shader tree stays.",
    effect: Effect::Changes,
    schema: || {
        let properties = json!({
            "model": text_argument("Path of a model, or the name of a built-in one"),
            "environment": text_argument("Path of an environment map, or a name"),
            "look": text_argument("Path of a look file (.toml)"),
            "measured": text_argument("Path of a measured BRDF (MERL or UTIA)"),
        });
        (properties, &[])
    },
    run: open,
};

pub static SETTINGS: Tool = Tool {
    name: "settings",
    title: "List settings",
    doc: "Lists settings with what each takes, its range, unit, meaning and present value; constants and parameters of the shaders are at \
        the end. Name a part of the path or the meaning, such as `light` or `roughness`: there are hundreds.",
    effect: Effect::Reads,
    schema: || (json!({ "find": text_argument("Only settings whose path or meaning has this text") }), &[]),
    run: settings,
};

pub static SET: Tool = Tool {
    name: "set",
    title: "Change settings",
    doc: "Changes settings, all or none, and says what each was before. Names are paths such as `view.ev`, `mode`, `material.roughness`, \
        or constants and parameters of the shaders such as `NDF`. Colors are linear RGB.",
    effect: Effect::Changes,
    schema: || {
        let values = json!({ "type": "object", "description": "Values by path, such as {\"material.enabled\": true, \
            \"material.roughness\": 0.3, \"NDF\": \"Beckmann\"}" });
        (json!({ "values": values }), &["values"])
    },
    run: set,
};

pub static CAMERA: Tool = Tool {
    name: "camera",
    title: "Move the camera",
    doc: "Moves the camera, or tells where it is. `frame`, `view`, `azimuth` and `elevation` frame the model; `eye` and `target` are \
        points in world space, in meters, +Y up.",
    effect: Effect::Changes,
    schema: || {
        let properties = json!({
            "frame": flag("Frame the whole model"),
            "view": json!({ "type": "string", "enum": ["front", "back", "right", "left", "top", "bottom"], "description": "Frame the model \
                from this side" }),
            "azimuth": number("Angle around the model, degrees", -360.0, 360.0),
            "elevation": number("Angle above the horizon, degrees", -90.0, 90.0),
            "eye": vector("Position of the camera, meters"),
            "target": vector("Point that the camera looks at, meters"),
            "fovy": number("Vertical field of view, degrees", 1.0, 170.0),
        });
        (properties, &[])
    },
    run: |caller, arguments| {
        let camera = caller.ask("camera", &Value::Object(arguments))?;
        Ok(vec![text(format!(
            "The camera is at {} m, looks at {} m, with a vertical field of view of {} degrees.",
            camera["eye"], camera["target"], camera["fovy"]
        ))])
    },
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Open {
    model: Option<String>,
    environment: Option<String>,
    look: Option<String>,
    measured: Option<String>,
}

fn open(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Open { model, environment, look, measured } = read(arguments)?;
    // A picture names a shader tree, too, and an agent edits no other tree than that which it was given.
    if let Some(look) = look.as_ref().filter(|look| !look.to_lowercase().ends_with(".toml")) {
        return Err(failed(format!(
            "`look` is `{look}`: expected a .toml, since a picture would open its own shader tree"
        )));
    }
    // A look may name model and environment, which what is named here replaces.
    let asked = [("look", look), ("model", model), ("environment", environment), ("measured", measured)];
    let mut opened = Vec::new();
    for (kind, path) in asked {
        let Some(path) = path else { continue };
        caller.ask("open", &json!({ kind: path }))?;
        opened.push(format!("{kind} {path}"));
    }
    match opened.is_empty() {
        true => Err(failed("name a model, an environment, a look or a measured BRDF".to_owned())),
        false => Ok(vec![text(format!("Opened {}.", opened.join(", ")))]),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Find {
    find: Option<String>,
}

fn settings(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Find { find } = read(arguments)?;
    let (all, now) = (caller.ask("settings", &json!({}))?, caller.ask("get", &json!({}))?);
    let is_asked = |line: &str| find.as_ref().is_none_or(|find| has(line, find));
    let mut lines = Vec::new();
    for setting in all.as_array().into_iter().flatten() {
        let field = |name: &str| setting[name].as_str().unwrap_or_default();
        let [range, unit] = ["range", "unit"].map(|name| match field(name) {
            "" => String::new(),
            text => format!(" {text}"),
        });
        let path = field("path");
        let value = at(&now, path).map_or_else(|| field("default").to_owned(), Value::to_string);
        let line = format!("{path} = {value} ({}{range}{unit}): {}", field("takes"), field("doc"));
        if is_asked(&line) {
            lines.push(line);
        }
    }
    let of_shaders = now["shader"].as_object().into_iter().flatten();
    lines.extend(
        of_shaders.map(|(name, value)| format!("{name} = {value} (of the shaders)")).filter(|line| is_asked(line)),
    );
    Ok(vec![text(if lines.is_empty() { "No setting has this text.".to_owned() } else { lines.join("\n") })])
}

/// The value at a path.
fn at<'a>(settings: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(settings, |value, key| match value {
        Value::Array(list) => key.parse::<usize>().ok().and_then(|index| list.get(index)),
        value => value.get(key),
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Set {
    values: Map<String, Value>,
}

fn set(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Set { values } = read(arguments)?;
    let mut paths = Vec::new();
    flatten("", &Value::Object(values.clone()), &mut paths);
    let before = present(caller, &paths)?;
    caller.ask("set", &json!({ "values": values }))?;
    let after = present(caller, &paths)?;
    let lines = paths.iter().zip(before.iter().zip(&after)).map(|(path, (before, after))| match before == after {
        true => format!("{path} is {after}, as before"),
        false => format!("{path}: {before} -> {after}"),
    });
    Ok(vec![text(lines.collect::<Vec<_>>().join("\n"))])
}

/// The values at some paths, as text.
fn present(caller: &Caller<'_>, paths: &[String]) -> Result<Vec<String>, Failure> {
    let now = caller.ask("get", &json!({}))?;
    let value = |path: &String| at(&now, path).or_else(|| now["shader"].get(path)).map(Value::to_string);
    Ok(paths.iter().map(|path| value(path).unwrap_or_else(|| "its default".to_owned())).collect())
}

/// The paths of values that may be nested.
fn flatten(path: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            map.iter().for_each(|(key, value)| flatten(&below(key), value, found));
        }
        _ => found.push(path.to_owned()),
    }
}
