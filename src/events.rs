//! Events as JSON lines on stdout, for programs that drive Specula (`--events json`), and for the clients of a window's socket.

use serde::Serialize;

use crate::control::Clients;
use crate::learn::Finding;
use crate::message::print_output;
use crate::pipeline::{Outcome, Reload};
use crate::render::BakeReport;
use crate::shader::Diagnostic;
use crate::statistics::Difference;

/// An event. The field `event` names its kind.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
pub enum Event<'a> {
    /// The window shows its first frame; the model may still be loading.
    Window {
        /// Milliseconds since the start of the program.
        ms: f64,
    },
    /// The first picture of the model is on screen. Textures that take long to decode follow before `settled`.
    Ready {
        /// Device in use.
        device: &'a str,
        /// Milliseconds since the start of the program.
        ms: f64,
    },
    /// A reload is finished.
    Reload(ReloadEvent),
    /// After a reload: the stages that the frame did not need have been compiled.
    Completed(CompletedEvent),
    /// The window shows all of the last reload: its stages are compiled, its light is baked, and the model has its textures.
    Settled {
        /// Shader generation.
        generation: u64,
    },
    /// The window has shown previews of a lower resolution while the picture moved, and shows the whole picture again.
    Previews {
        /// How many previews it has shown.
        shown: u32,
        /// Size of the last one, pixels.
        size: [u32; 2],
        /// Milliseconds from the first preview to the last.
        ms: f64,
        /// Milliseconds from the last preview to the whole picture.
        whole_ms: f64,
    },
    /// The visible thumbnails show the current state.
    Thumbnails {
        /// How many were drawn since the last event.
        drawn: usize,
    },
    /// An environment was baked, or loaded from the disk cache.
    Bake(&'a BakeReport),
    /// A frame was rendered in a path-traced mode.
    Paths {
        /// Slug of the mode.
        mode: &'a str,
        /// Paths per pixel.
        paths_per_pixel: u64,
        /// Milliseconds for all of its frames.
        ms: f64,
    },
    /// The picture was compared with an earlier one.
    Compared {
        /// Mean FLIP, 0..1.
        flip: f64,
        /// Largest difference of a channel of the display, 0..1.
        largest: f64,
    },
    /// The goals of the exercise that is open were measured.
    Exercise {
        /// Its name, as `03-fresnel`.
        name: &'a str,
        /// Whether all goals are reached.
        passed: bool,
        /// Result of each goal.
        goals: &'a [Finding],
    },
    /// The inspector has read a pixel.
    Inspected {
        /// Pixels from the upper left corner of the picture.
        pixel: [u32; 2],
        /// Shader generation.
        generation: u64,
        /// Whether the model covers the pixel.
        hit: bool,
        /// Name of the node, if the model covers the pixel.
        node: Option<&'a str>,
        /// Name of its material.
        material: Option<&'a str>,
        /// The values by slug of the mode, as `specula probe` prints them.
        modes: serde_json::Map<String, serde_json::Value>,
        /// The texels of the material's textures, as `specula probe` prints them.
        textures: Vec<serde_json::Value>,
    },
    /// The inspector has searched for the first statement that computes NaN or infinity at the pinned pixel.
    #[serde(rename = "not-finite")]
    NotFinite {
        /// Shader generation.
        generation: u64,
        /// Mode, file, line, code and value, as `specula probe` prints them; or a message.
        not_finite: serde_json::Value,
    },
    /// Another pixel is pinned, or the picture under it has changed and rests.
    Pinned {
        /// Pixels from the upper left corner of the picture; null if none is pinned.
        pixel: Option<[u32; 2]>,
        /// Whether it has moved with its surface since it was pinned, as the picture has changed its size.
        moved: bool,
        /// Shader generation.
        generation: u64,
        /// The folder of the shader tree; null for the built-in one.
        tree: Option<&'a std::path::Path>,
    },
    /// Assertions and operations of the picture were checked, as `view.checks` says.
    Checked {
        /// Shader generation.
        generation: u64,
        /// Failures and printed values, as `specula check MODEL --json` prints them.
        #[serde(skip_serializing_if = "Option::is_none")]
        found: Option<serde_json::Value>,
        /// Why they could not be checked.
        #[serde(skip_serializing_if = "Option::is_none")]
        error: Option<&'a str>,
    },
    /// Costs of functions of the shaders were measured.
    Costs {
        /// Shader generation.
        generation: u64,
        /// The costs, as `specula bench cost --json` prints them.
        #[serde(skip_serializing_if = "Option::is_none")]
        found: Option<serde_json::Value>,
        /// Why they could not be measured.
        #[serde(skip_serializing_if = "Option::is_none")]
        error: Option<&'a str>,
    },
    /// The time of an older version of the shaders was compared with that of the newest.
    Timed {
        /// Shader generation of the newest.
        generation: u64,
        /// Number of the older version.
        version: u64,
        /// By how much the older version is slower or faster.
        #[serde(skip_serializing_if = "Option::is_none")]
        text: Option<&'a str>,
        /// The same in numbers.
        #[serde(skip_serializing_if = "Option::is_none")]
        difference: Option<Difference>,
        /// Why they could not be compared.
        #[serde(skip_serializing_if = "Option::is_none")]
        error: Option<&'a str>,
    },
    /// The statements of a file were traced at the pinned pixel, for the panel Source.
    Traced {
        /// Pixels from the upper left corner of the picture.
        pixel: [u32; 2],
        /// Shader generation.
        generation: u64,
        /// The stage.
        stage: &'a str,
        /// The file, as the tree names it.
        file: &'a str,
        /// Whether the color of the fragment that is seen is the picture's, bit by bit; nothing if there is no trace.
        equal: Option<bool>,
        /// Why there is no trace.
        error: Option<&'a str>,
        /// How many pipelines were built for it. None are if it was prepared.
        built: usize,
        /// How long it took.
        ms: f64,
    },
    /// The stages for traces of the shown file were compiled before a pixel is clicked, for the panel Source.
    Prepared {
        /// Shader generation.
        generation: u64,
        /// The stage; nothing if it cannot be traced.
        stage: Option<&'a str>,
        /// The file, as the tree names it.
        file: Option<&'a str>,
        /// How many pipelines were missing.
        built: usize,
        /// Why it cannot be traced.
        error: Option<&'a str>,
        /// How long it took.
        ms: f64,
    },
    /// The inspector has measured the BRDF of a pixel's material.
    Curves {
        /// Shader generation.
        generation: u64,
        /// Whether the shaders before the last edit were measured too.
        before: bool,
        /// Albedo at the normal, linear RGB, or nothing if it could not be measured.
        albedo: Option<[f32; 3]>,
        /// How long it took.
        ms: f64,
    },
    /// The window accepts clients on a local socket.
    Listening {
        /// Its path.
        socket: &'a str,
    },
    /// The window shows a message for a few seconds.
    Message {
        /// The message.
        message: &'a str,
    },
    /// Another part of the scene is selected.
    Selected(SelectedEvent),
    /// A screenshot was written.
    Screenshot {
        /// Its path.
        file: &'a str,
    },
    /// The window has closed.
    Closed {
        /// Frames that it has drawn.
        frames: u64,
        /// CPU time of the panels in a frame, milliseconds, in the last 4096 of them.
        ui_ms: Summary,
        /// CPU time of the window's thread for a whole frame, without the driver's time to present it, milliseconds, in the same
        /// frames; 0 where the system does not tell it.
        cpu_ms: Summary,
    },
    /// Memory or a thread of the window failed. The last picture stays.
    Failure {
        /// The message that the window shows.
        message: &'a str,
    },
    /// The device was lost or the program crashed, and this window continues the session.
    Restarted {
        /// The reason, as "the graphics device was lost".
        cause: &'a str,
        /// Losses in a row.
        losses: u32,
        /// Shader files that are not used until one of them changes, as paths in the tree.
        refused: Vec<&'a str>,
        /// Settings that were set back to their last good values.
        reset: &'a [String],
    },
    /// A diagnostic of the compiler or of a check.
    Diagnostic(&'a Diagnostic),
}

/// Median, 95th percentile and maximum of a time, milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Half of the values are at most this.
    pub median: f64,
    /// 95 % of the values are at most this.
    pub p95: f64,
    /// The largest value.
    pub max: f64,
}

impl Summary {
    /// The summary of some values; zeros if there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1) as f64;
        let at = |part: f64| sorted.get((part * last).round() as usize).copied().map_or(0.0, to_microseconds);
        Self { median: at(0.5), p95: at(0.95), max: at(1.0) }
    }
}

/// The selected part of the scene; all null if nothing is selected, or no part of the model.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SelectedEvent {
    /// Index of the instance: a primitive of a node.
    pub instance: Option<usize>,
    /// Name of the node, or `#` and its index in the file.
    pub node: Option<String>,
    /// Name of the primitive.
    pub primitive: Option<String>,
    /// Name of the material, or `#` and its index in the file.
    pub material: Option<String>,
}

/// A finished reload.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ReloadEvent {
    /// Shader generation on screen after the reload.
    pub generation: u64,
    /// Changed files, as diagnostics name them.
    pub changed: Vec<String>,
    /// Stages that were compiled.
    pub stages: Vec<String>,
    /// Whether the new shaders are on screen.
    pub ok: bool,
    /// From the first file event to the settled set of changes.
    pub detect_ms: f64,
    /// Compiling the stages.
    pub compile_ms: f64,
    /// Pipelines that were created; others were reused.
    pub pipelines: usize,
    /// Creating the pipelines.
    pub pipeline_ms: f64,
    /// From the swap to the end of the first frame.
    pub first_frame_ms: f64,
}

/// The stages of a reload that the frame did not need.
#[derive(Clone, Debug, Default, Serialize)]
pub struct CompletedEvent {
    /// Shader generation.
    pub generation: u64,
    /// Stages that were compiled.
    pub stages: Vec<String>,
    /// Whether all are good. If not, `diagnostic` events came before.
    pub ok: bool,
    /// Compiling the stages.
    pub compile_ms: f64,
}

impl CompletedEvent {
    /// The event of a reload that has been finished.
    pub fn new(reload: &Reload, generation: u64) -> Self {
        let ReloadEvent { stages, ok, compile_ms, .. } = ReloadEvent::new(reload, generation, 0.0, 0.0);
        Self { generation, stages, ok, compile_ms }
    }
}

impl ReloadEvent {
    /// The event of a finished reload.
    pub fn new(reload: &Reload, generation: u64, detect_ms: f64, first_frame_ms: f64) -> Self {
        Self {
            generation,
            changed: reload.report.changed.clone(),
            stages: reload.report.stages.iter().map(|(stage, _)| stage.clone()).collect(),
            ok: !matches!(reload.outcome, Outcome::Failed(_)),
            detect_ms: to_microseconds(detect_ms),
            compile_ms: to_microseconds(reload.report.compile_ms),
            pipelines: reload.pipelines,
            pipeline_ms: to_microseconds(reload.pipeline_ms),
            first_frame_ms: to_microseconds(first_frame_ms),
        }
    }
}

/// The stages of a report in one line: those that draw the picture first, and how many more there are.
pub fn in_short(stages: &[String]) -> String {
    /// More stages do not fit beside the names of the changed files.
    const SHOWN: usize = 4;
    // The picture's fragment stages lie at the root of the tree; below it are passes, and the bakes, which are of less interest.
    let rank = |stage: &&str| match stage.rsplit_once('/') {
        None => u32::from(!stage.ends_with(".frag")),
        Some((folder, _)) if folder.starts_with("passes") => 2,
        Some(_) => 3,
    };
    let mut sorted: Vec<&str> = stages.iter().map(String::as_str).collect();
    sorted.sort_by_key(rank);
    match sorted.as_slice() {
        [] => "nothing to do".to_owned(),
        few if few.len() <= SHOWN + 1 => few.join(" "),
        many => format!("{} and {} more stages", many[..SHOWN].join(" "), many.len() - SHOWN),
    }
}

/// Rounds milliseconds to three decimals, the resolution of the clocks behind them.
fn to_microseconds(ms: f64) -> f64 {
    (ms * 1e3).round() / 1e3
}

/// Event subscribers.
pub trait Audience {
    /// Whether there are no subscribers.
    fn is_empty(&self) -> bool;
    /// Takes the line of an event.
    fn take(&self, line: &str);
}

/// Stdout, if `true`.
impl Audience for bool {
    fn is_empty(&self) -> bool {
        !self
    }

    fn take(&self, line: &str) {
        print_output(line);
    }
}

impl Audience for &Clients {
    fn is_empty(&self) -> bool {
        Clients::is_empty(self)
    }

    fn take(&self, line: &str) {
        self.send(line);
    }
}

/// Sends an event to the subscribers.
pub fn emit(to: impl Audience, event: &Event<'_>) {
    if to.is_empty() {
        return;
    }
    if let Ok(line) = serde_json::to_string(event) {
        to.take(&line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_on_screen_come_first() {
        let stages = |names: &str| in_short(&names.split_whitespace().map(str::to_owned).collect::<Vec<_>>());
        assert_eq!(stages(""), "nothing to do");
        assert_eq!(stages("pbr.vert pbr.frag"), "pbr.frag pbr.vert");
        let all = "fullscreen.vert ibl/cube.comp ibl/dfg.comp passes/film.frag pbr.vert pbr.frag sky.frag tonemap.frag";
        assert_eq!(stages(all), "pbr.frag sky.frag tonemap.frag fullscreen.vert and 4 more stages");
    }
}
