//! Commands that write pictures and animations, and read pixels.

use std::path::PathBuf;
use std::time::Instant;

use serde::Deserialize;
use serde_json::Value;
use winit::keyboard::NamedKey;

use super::about::Group;
use super::fields;
use super::shortcut::Shortcut;
use super::spec::{Outcome, Spec, Until};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::captures::{Destination, Job};
use crate::capture::{Turn, Turntable, check_animation, modes_of};
use crate::picture::{self, Encoding};

/// Size of a picture of a sheet, pixels.
const TILE: [u32; 2] = [320, 180];
/// Frames of a turn, and frames a second.
const FRAMES: u32 = 75;
const FPS: f32 = 25.0;
/// Versions a second.
const VERSIONS_PER_S: f32 = 1.5;

/// Fields of `capture`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Capture {
    pub(in crate::app) file: Option<PathBuf>,
    pub(in crate::app) size: Option<[u32; 2]>,
    pub(in crate::app) mode: Option<String>,
    pub(in crate::app) frames: Option<u32>,
    pub(in crate::app) ui: bool,
}

pub(in crate::app) static CAPTURE: Spec<Capture> = Spec::new("capture", capture).takes(
    r#""file"?: "a.png" | "a.exr", "size"?: [w,h], "mode"?: "d", "frames"?: n, "ui"?: true"#,
    "Writes the picture as it is on screen, or drawn anew at a size or in a mode; EXR holds raw floats; with ui the whole window. Result: file, width, height, ms",
);

pub(in crate::app) static SCREENSHOT: Spec<()> = Spec::plain("screenshot", |state, _, ()| state.screenshot = true)
    .label("Screenshot", "capture PNG")
    .shortcuts(
        Group::Picture,
        &[Shortcut::named(NamedKey::F12).everywhere()],
        "save a screenshot as specula-1.png and so on",
    )
    .of_window();

/// Fields of `picture`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Picture {
    file: PathBuf,
    format: Option<String>,
    raw: bool,
    size: Option<[u32; 2]>,
    mode: Option<String>,
}

pub(in crate::app) static PICTURE: Spec<Picture> = Spec::new("picture", render)
    .takes(
        r#""file": "a.npy" | "a.png" | "a.exr", "format"?: "npy", "raw"?: true, "size"?: [w,h], "mode"?: "d""#,
        "Writes the final picture as `specula render` does, at its size and in its mode or in others. A NumPy array (height, width, 4) holds the \
         bytes of the PNG or, with raw, the floats of the EXR; format is for a file whose name does not end so. Result: file, width, height, ms",
    )
    .required(&["file"]);

/// Fields of `probe`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Probe {
    at: [u32; 2],
    modes: Option<Vec<String>>,
}

pub(in crate::app) static PROBE: Spec<Probe> = Spec::new("probe", probe)
    .takes(
        r#""at": [x,y], "modes"?: ["d", "f"] | ["all", "paths"]"#,
        "Raw values of a pixel of the picture, in these modes; without them, in all but those of random paths. Result: pixel, modes, \
         textures (a texel of each), not_finite (the first line with NaN or Inf, if a value is one)",
    )
    .required(&["at"]);

/// Fields of `sheet`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Sheet {
    pub(in crate::app) file: PathBuf,
    pub(in crate::app) modes: Option<Value>,
    size: Option<[u32; 2]>,
    columns: Option<u32>,
}

impl Sheet {
    /// A sheet of all modes, or of those with data.
    pub(in crate::app) fn of(file: PathBuf, modes: &str) -> Self {
        Self { file, modes: Some(modes.into()), ..Self::default() }
    }
}

pub(in crate::app) static SHEET: Spec<Sheet> = Spec::new("sheet", |_, _, fields| sheet(fields))
    .takes(
        r#""file": "sheet.png", "modes"?: "modes" | "all" | ["all", "paths"] | ["d", ...], "size"?: [w,h], "columns"?: n"#,
        "Writes a contact sheet of modes with their names; size is that of one picture",
    )
    .required(&["file"]);

/// Fields of `turntable`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct TurntableFields {
    pub(in crate::app) file: PathBuf,
    pub(in crate::app) frames: Option<u32>,
    pub(in crate::app) fps: Option<f32>,
    pub(in crate::app) size: Option<[u32; 2]>,
    pub(in crate::app) turn: Option<String>,
}

pub(in crate::app) static TURNTABLE: Spec<TurntableFields> = Spec::new("turntable", |_, _, fields| turntable(fields))
    .takes(
        r#""file": "spin.mp4" | ".gif" | ".webp" | ".png", "frames"?: n, "fps"?: n, "size"?: [w,h], "turn"?: "camera" | "light" | "model""#,
        "Writes a full turn as a video, as an animation, or as numbered PNGs",
    )
    .required(&["file"]);

/// Fields of `timeline`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Timeline {
    pub(in crate::app) file: PathBuf,
    pub(in crate::app) fps: Option<f32>,
    pub(in crate::app) size: Option<[u32; 2]>,
}

pub(in crate::app) static TIMELINE: Spec<Timeline> = Spec::new("timeline", |_, _, fields| timeline(fields))
    .takes(
        r#""file": "edits.mp4" | ".gif" | ".webp" | ".png", "fps"?: n, "size"?: [w,h]"#,
        "Writes the versions of the shaders as a video or an animation",
    )
    .required(&["file"]);

/// Ends a command by the identifier in its line; all captures without one.
pub(in crate::app) static CANCEL: Spec<Option<Value>> = Spec::new("cancel", |state, _, of: Option<Value>| match of {
    None => {
        state.cancel_captures();
        Ok(Until::CapturesEnded)
    }
    Some(id) => {
        let key = (state.asking, id);
        if state.waiting.cancel_of(&key) || state.captures.cancel_of(&key) {
            return Ok(Until::DONE);
        }
        Err(format!("no command with the id {} can be canceled: it has ended, or it ends soon", key.1))
    }
})
.parsed(
    r#""of"?: id"#,
    "Ends the command with this id, which answers with the error `canceled`; without a field, all captures, sheets, animations and probes",
    |about, mut fields| {
        let of = fields::take(&mut fields, "of");
        fields::end(about, of, fields)
    },
);

/// Ends the capture with a number.
pub(in crate::app) static CANCEL_ONE: Spec<u64> =
    Spec::act("cancel-one", |state, _, number| state.captures.cancel_one(number));

fn render(state: &mut State, _: &mut Engine, Picture { file, format, raw, size, mode }: Picture) -> Outcome {
    let encoding = match format {
        None => Encoding::of(&file)?,
        Some(name) => {
            Encoding::named(&name).ok_or_else(|| format!("`format` is `{name}`; it can be npy, png or exr"))?
        }
    };
    picture::check_place(&file)?;
    let encoding = match encoding {
        Encoding::Npy { .. } => Encoding::Npy { raw },
        Encoding::Png if raw => return Err("a PNG holds no raw values: write .npy or .exr".to_owned()),
        encoding => encoding,
    };
    if let Some(mode) = mode.as_ref().filter(|_| is_compiled(state)) {
        modes_of(&state.session, std::slice::from_ref(mode))?;
    }
    let to = Destination { file: Some(file), encoding: Some(encoding), since: Instant::now() };
    Ok(Until::Rendered(to, size.map(Into::into), mode))
}

/// Whether the names of all modes are known.
fn is_compiled(state: &State) -> bool {
    state.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete())
}

fn capture(state: &mut State, _: &mut Engine, Capture { file, size, mode, frames, ui }: Capture) -> Outcome {
    if let Some(file) = &file {
        picture::check_path(file)?;
    }
    let is_light = file.as_deref().is_some_and(picture::holds_light);
    if ui {
        if !state.has_window {
            return Err("`ui` is about the window, and this session has none".to_owned());
        }
        let wrong = size.is_some() || mode.is_some() || frames.is_some() || is_light;
        return match wrong {
            true => Err("a capture with `ui` has the window's size and mode, and is a PNG".to_owned()),
            false => Ok(Until::Window(file)),
        };
    }
    let to = Destination::named(file);
    if size.is_none() && mode.is_none() && frames.is_none() && !is_light {
        return Ok(Until::Screen(to));
    }
    Ok(Until::Picture(Job::Picture { to, size: size.map(Into::into), mode, frames: frames.unwrap_or(1) }))
}

fn probe(state: &mut State, _: &mut Engine, Probe { at, modes }: Probe) -> Outcome {
    let names = modes.unwrap_or_default();
    // The names are looked up again when the picture is there.
    if is_compiled(state) {
        modes_of(&state.session, &names)?;
    }
    Ok(Until::Picture(Job::Probe { at: at.into(), names }))
}

fn sheet(fields: Sheet) -> Outcome {
    let names = match fields.modes {
        None => vec!["modes".to_owned()],
        Some(Value::String(name)) => vec![name],
        Some(Value::Array(list)) => {
            let text = |name: &Value| name.as_str().map(str::to_owned);
            list.iter().map(text).collect::<Option<_>>().ok_or("`modes` takes names of modes")?
        }
        Some(other) => {
            return Err(format!("`modes` cannot be {other}; it takes \"modes\", \"all\" or names of modes"));
        }
    };
    picture::check_path(&fields.file)?;
    let size = fields.size.unwrap_or(TILE).into();
    Ok(Until::Picture(Job::Sheet { file: fields.file, names, size, columns: fields.columns }))
}

fn turntable(fields: TurntableFields) -> Outcome {
    let (fps, frames) = (fields.fps.unwrap_or(FPS), fields.frames.unwrap_or(FRAMES));
    check_animation(&fields.file, fps)?;
    if !(1..=Turntable::MOST_FRAMES).contains(&frames) {
        return Err(format!("`frames` is {frames}; it can be 1 to {}", Turntable::MOST_FRAMES));
    }
    let turn = fields.turn.as_deref().map_or(Ok(Turn::default()), Turn::named)?;
    let size = fields.size.map(Into::into);
    Ok(Until::Picture(Job::Turntable { file: fields.file, frames, fps, size, turn }))
}

fn timeline(fields: Timeline) -> Outcome {
    let fps = fields.fps.unwrap_or(VERSIONS_PER_S);
    check_animation(&fields.file, fps)?;
    Ok(Until::Picture(Job::Timeline { file: fields.file, fps, size: fields.size.map(Into::into) }))
}
