//! Tools that give numbers.

use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::arguments::{number, read, text as text_argument, texts, vector, whole};
use super::tool::{Caller, Content, Effect, Tool, text};

pub static PROBE: Tool = Tool {
    name: "probe",
    title: "Read a pixel",
    doc: "Returns the raw values of a pixel in debug modes: world space, before exposure and tone map. [r, g, b, coverage], a name or a \
        number; null where a mode has no data. Pixels are those of the picture that the program shows, whose size is in the answer.",
    effect: Effect::Reads,
    schema: || {
        let properties = json!({
            "x": whole("Pixels from the left"),
            "y": whole("Pixels from the top"),
            "modes": texts("Modes, such as [\"d\", \"f\", \"shading-normal\"]; without them, all but those of path tracing, which takes longer"),
        });
        (properties, &["x", "y"])
    },
    run: probe,
};

pub static TRACE: Tool = Tool {
    name: "trace",
    title: "Trace a pixel",
    doc: "Runs the shaders at a pixel with a log, and shows each line of a file with the values that its statements compute there. It \
        finds the line where a value goes wrong.",
    effect: Effect::Reads,
    schema: || {
        let properties = json!({
            "x": whole("Pixels from the left"),
            "y": whole("Pixels from the top"),
            "file": text_argument("File of the tree, such as brdf/ndf.glsl"),
            "stage": text_argument("Stage of the picture, such as tonemap.frag; without it, the first that has the file"),
        });
        (properties, &["x", "y", "file"])
    },
    run: trace,
};

pub static FURNACE: Tool = Tool {
    name: "furnace",
    title: "Measure the energy of the BRDF",
    doc: "Measures the directional albedo of the BRDF under uniform white light, by roughness and angle: 1 keeps all energy, more than \
        1.005 creates some, which is a mistake.",
    effect: Effect::Reads,
    schema: || {
        let properties = json!({
            "metallic": number("0 (dielectric) to 1 (metal) [1]", 0.0, 1.0),
            "base_color": vector("Linear RGB, each 0 to 1 [1, 1, 1]"),
        });
        (properties, &[])
    },
    run: furnace,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Probe {
    x: u32,
    y: u32,
    modes: Option<Vec<String>>,
}

fn probe(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Probe { x, y, modes } = read(arguments)?;
    let found = caller.ask("probe", &json!({ "at": [x, y], "modes": modes }))?;
    let mut lines = vec![format!("pixel {x} {y} of {} x {}", found["size"][0], found["size"][1])];
    lines.extend(found["modes"].as_object().into_iter().flatten().map(|(mode, value)| format!("{mode} {value}")));
    for (name, key) in [("textures", "textures"), ("first NaN or infinity", "not_finite")] {
        if !found[key].is_null() && found[key] != json!([]) {
            lines.push(format!("{name}: {}", found[key]));
        }
    }
    Ok(vec![text(lines.join("\n"))])
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Trace {
    x: u32,
    y: u32,
    file: String,
    stage: Option<String>,
}

fn trace(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Trace { x, y, file, stage } = read(arguments)?;
    let found = caller.ask("trace", &json!({ "at": [x, y], "file": file, "stage": stage }))?;
    let equal = match found["proof"]["equal"].as_bool() {
        Some(true) => ", equal to the picture bit by bit",
        Some(false) => ", not equal to the picture",
        None => "",
    };
    let mut lines = vec![format!("pixel {x} {y}, {}{equal}", found["stage"].as_str().unwrap_or_default())];
    for line in found["lines"].as_array().into_iter().flatten() {
        let field = |name: &str| line[name].as_str().unwrap_or_default();
        lines.push(format!("{}:{}  {}  // {}", field("file"), line["line"], field("code").trim(), field("text")));
    }
    if lines.len() == 1 {
        lines.push("No statement of this file runs at this pixel.".to_owned());
    }
    Ok(vec![text(lines.join("\n"))])
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Furnace {
    metallic: Option<f64>,
    base_color: Option<[f64; 3]>,
}

fn furnace(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Furnace { metallic, base_color } = read(arguments)?;
    let metallic = metallic.unwrap_or(1.0);
    let base_color = base_color.unwrap_or([1.0; 3]);
    let found = caller.ask("furnace", &json!({ "metallic": metallic, "base_color": base_color }))?;
    let rows = found["rows"].as_array().cloned().unwrap_or_default();
    let claims = match found["claims_conservation"].as_bool() {
        Some(true) => "claims",
        _ => "does not claim",
    };
    let mut lines = vec![
        format!("albedo min {} max {}; the BRDF {claims} to conserve energy", found["min"], found["max"]),
        "roughness: albedo (largest channel) by angle from the normal".to_owned(),
    ];
    for row in rows.chunk_by(|a, b| a["roughness"] == b["roughness"]) {
        let cell = |cell: &Value| {
            let angle = cell["cos_theta"].as_f64().unwrap_or(1.0).acos().to_degrees();
            let channels = cell["albedo"].as_array().into_iter().flatten().map(|x| x.as_f64().unwrap_or(f64::NAN));
            let largest =
                channels.fold(0.0, |most: f64, x| if x.is_nan() || most.is_nan() { f64::NAN } else { most.max(x) });
            format!("{angle:.0}° {largest:.3}")
        };
        // Every third angle: an agent reads the shape, and `max` has the worst.
        let cells: Vec<String> = row.iter().step_by(3).map(cell).collect();
        lines.push(format!("{}: {}", row[0]["roughness"], cells.join(", ")));
    }
    Ok(vec![text(lines.join("\n"))])
}
