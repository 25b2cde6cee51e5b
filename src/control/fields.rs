//! The fields of commands, as they stand in a line.

use std::path::PathBuf;

use serde::Deserialize;
use serde_json::Value;

/// Fields of `camera`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Camera {
    pub eye: Option<[f32; 3]>,
    pub target: Option<[f32; 3]>,
    pub fovy: Option<f32>,
    pub azimuth: Option<f32>,
    pub elevation: Option<f32>,
    pub frame: bool,
    pub view: Option<String>,
}

/// Fields of `capture`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Capture {
    pub file: Option<PathBuf>,
    pub size: Option<[u32; 2]>,
    pub mode: Option<String>,
    pub frames: Option<u32>,
    pub ui: bool,
}

/// Fields of `probe`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Probe {
    pub at: [u32; 2],
    pub modes: Option<Vec<String>>,
}

/// Fields of `compare`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Compare {
    pub with: Option<Value>,
    pub file: Option<PathBuf>,
    pub tree: Option<PathBuf>,
    pub wipe: Option<f32>,
}

/// Fields of `grid`.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Grid {
    pub(super) modes: Vec<String>,
}

/// Fields of `pick`.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Pick {
    pub(super) at: Option<[u32; 2]>,
}

/// Fields of `write-defaults`.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct WriteDefaults {
    pub(super) names: Vec<String>,
}

/// Fields of `numbers`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Numbers {
    pub at: Option<String>,
    pub values: Option<Vec<Option<f64>>>,
    pub write: bool,
}

/// Fields of `playback`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Playback {
    pub paused: Option<bool>,
    pub step: bool,
    pub restart: bool,
    pub time: Option<f32>,
    pub speed: Option<f32>,
}

/// Fields of `run`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Run {
    pub entry: String,
    pub value: Option<f64>,
}

/// Fields of `sheet`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sheet {
    pub file: PathBuf,
    pub modes: Option<Value>,
    pub size: Option<[u32; 2]>,
    pub columns: Option<u32>,
}

/// Fields of `turntable`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Turntable {
    pub file: PathBuf,
    pub frames: Option<u32>,
    pub fps: Option<f32>,
    pub size: Option<[u32; 2]>,
    pub turn: Option<String>,
}

/// Fields of `timeline`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Timeline {
    pub file: PathBuf,
    pub fps: Option<f32>,
    pub size: Option<[u32; 2]>,
}
