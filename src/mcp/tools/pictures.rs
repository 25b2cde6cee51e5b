//! Tools that draw and compare pictures.

use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::arguments::{LARGEST, has, read, size, text as text_argument};
use super::tool::{Caller, Content, Effect, Tool, failed, text};
use crate::mcp::program::Failure;

pub static RENDER: Tool = Tool {
    name: "render",
    title: "Render a picture",
    doc: "Draws the model with the present shaders and settings, and shows you the picture (PNG). Its number in the answer is for `diff`. \
        With `save` it is also written to a new file in the output folder.",
    effect: Effect::Changes,
    schema: || {
        let properties = json!({
            "mode": text_argument("Debug mode, such as `d` or `shading-normal` (`modes` lists them); without it, the one that is set: \
                `final` at the start"),
            "size": size("Width and height in pixels; without it, the size in which `probe` and `trace` count pixels"),
            "save": text_argument("New file below the output folder: .png, or .exr or .npy for raw floats"),
        });
        (properties, &[])
    },
    run: render,
};

pub static MODES: Tool = Tool {
    name: "modes",
    title: "List debug modes",
    doc: "Lists the debug modes: each a picture of one channel, BRDF term or check.",
    effect: Effect::Reads,
    schema: || (json!({ "find": text_argument("Only modes whose name, group or description has this text") }), &[]),
    run: modes,
};

pub static DIFF: Tool = Tool {
    name: "diff",
    title: "Compare two pictures",
    doc: "Compares two pictures of the same size: the mean of FLIP (0 to 1, how different they look), the largest difference of a channel \
        and its pixel, and a map of the differences.",
    effect: Effect::Reads,
    schema: || {
        let picture = |which: &str| {
            json!({ "type": ["integer", "string"], "description": format!("{which} picture: the number that `render` has told, or a file \
                in the output folder") })
        };
        (json!({ "a": picture("First"), "b": picture("Second") }), &["a", "b"])
    },
    run: diff,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Render {
    mode: Option<String>,
    size: Option<[u32; 2]>,
    save: Option<String>,
}

fn render(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Render { mode, size, save } = read(arguments)?;
    if let Some([width, height]) = size.filter(|size| size.iter().any(|side| !(1..=LARGEST).contains(side))) {
        return Err(failed(format!("`size` is {width}x{height}; a side has 1 to {LARGEST} pixels")));
    }
    let save = save.map(|name| new_file(caller, &name)).transpose().map_err(failed)?;
    let (number, path) = caller.places().new_picture();
    let drawn = caller.ask("picture", &json!({ "file": path, "mode": mode, "size": size }))?;
    let mut said = format!("Picture {number}: {} x {} pixels", drawn["width"], drawn["height"]);
    if let Some(file) = save {
        save_as(caller, &file, &path, &json!({ "mode": mode, "size": size }))?;
        said += &format!(". Wrote {}", file.display());
    }
    Ok(vec![text(said), image(&path)?])
}

/// The path of a picture in the output folder that is not there yet.
fn new_file(caller: &Caller<'_>, name: &str) -> Result<PathBuf, String> {
    let file = caller.places().output(name)?;
    if !["png", "exr", "npy"].iter().any(|ending| file.extension().is_some_and(|of| of == *ending)) {
        return Err(format!("`save` is `{name}`; it ends in .png, .exr or .npy"));
    }
    match file.symlink_metadata().is_ok() {
        true => Err(format!("{} is there already, and stays as it is; choose another name", file.display())),
        false => Ok(file),
    }
}

/// Writes a picture to the output folder.
fn save_as(caller: &Caller<'_>, file: &Path, png: &Path, fields: &Value) -> Result<(), Failure> {
    let cannot = |error: std::io::Error| failed(format!("cannot write {}: {error}", file.display()));
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(cannot)?;
    }
    if file.extension().is_some_and(|ending| ending == "png") {
        let mut from = std::fs::File::open(png).map_err(cannot)?;
        let mut to = std::fs::File::create_new(file).map_err(cannot)?;
        std::io::copy(&mut from, &mut to).map_err(cannot)?;
    } else {
        let mut fields = fields.clone();
        (fields["file"], fields["raw"]) = (json!(file), true.into());
        caller.ask("picture", &fields)?;
    }
    Ok(())
}

/// A PNG as content.
fn image(path: &Path) -> Result<Value, Failure> {
    let bytes = std::fs::read(path).map_err(|error| failed(format!("the picture cannot be read: {error}")))?;
    Ok(json!({ "type": "image", "data": BASE64_STANDARD.encode(bytes), "mimeType": "image/png" }))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Find {
    find: Option<String>,
}

fn modes(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Find { find } = read(arguments)?;
    let modes = caller.ask("modes", &json!({}))?;
    let mut lines = Vec::new();
    let mut group = String::new();
    for mode in modes.as_array().into_iter().flatten() {
        let field = |name: &str| mode[name].as_str().unwrap_or_default();
        let line = format!("{}: {}. {}", field("slug"), field("name"), field("doc"));
        let is_asked = find.as_ref().is_none_or(|find| has(&format!("{} {line}", field("group")), find));
        if is_asked {
            if group != field("group") {
                group = field("group").to_owned();
                lines.push(format!("## {group}"));
            }
            lines.push(line);
        }
    }
    Ok(vec![text(if lines.is_empty() { "No mode has this text.".to_owned() } else { lines.join("\n") })])
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Diff {
    a: Picture,
    b: Picture,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Picture {
    Number(u64),
    File(String),
}

impl Picture {
    fn path(&self, caller: &Caller<'_>) -> Result<PathBuf, Failure> {
        match self {
            Self::File(name) => caller.places().output(name).map_err(failed),
            Self::Number(number) => {
                let path = caller.places().picture(*number);
                let gone = || {
                    failed(format!(
                        "picture {number} is not kept: `render` tells the numbers of pictures, and the last 32 are kept"
                    ))
                };
                path.exists().then_some(path).ok_or_else(gone)
            }
        }
    }
}

fn diff(caller: &Caller<'_>, arguments: Map<String, Value>) -> Content {
    let Diff { a, b } = read(arguments)?;
    let map = caller.places().passing("png");
    let found = caller.ask("diff", &json!({ "a": a.path(caller)?, "b": b.path(caller)?, "out": map }));
    let shown = found.as_ref().ok().and_then(|_| image(&map).ok());
    let _ = std::fs::remove_file(&map);
    let pair = found?["pictures"][0].take();
    if let Some(why) = pair["why"].as_str() {
        return Err(failed(why.to_owned()));
    }
    let number = |name: &str| if pair[name].is_null() { "infinite".to_owned() } else { pair[name].to_string() };
    let measure = if pair["measure"] == "flip" { "mean FLIP" } else { "RMSE" };
    let mut content = vec![text(match pair["differing"].as_u64() {
        Some(0) => "The pictures are equal, bit by bit.".to_owned(),
        _ => format!(
            "{measure} {}; largest difference of a channel {} at pixel {}; {} of {} pixels differ. The map shows where.",
            number("error"),
            number("largest"),
            pair["largest_at"],
            pair["differing"],
            pair["pixels"]
        ),
    })];
    content.extend(shown);
    Ok(content)
}
