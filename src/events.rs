//! What happens, as one JSON object a line on stdout, for programs that drive Specula (`--events json`).

use serde::Serialize;

use crate::render::BakeReport;
use crate::shader::Diagnostic;

/// An event. The field `event` names its kind.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
pub enum Event<'a> {
    /// The window shows its first frame; the model may still be loading.
    Window {
        /// Milliseconds since the start of the program.
        ms: f64,
    },
    /// The first picture of the model is there.
    Ready {
        /// Device in use.
        device: &'a str,
        /// Milliseconds since the start of the program.
        ms: f64,
    },
    /// A reload is finished.
    Reload(ReloadEvent),
    /// An environment is baked, or came from the disk.
    Bake(&'a BakeReport),
    /// A screenshot was written.
    Screenshot {
        /// Its path.
        file: &'a str,
    },
    /// A message of the compiler or of a check.
    Diagnostic(&'a Diagnostic),
}

/// A finished reload.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ReloadEvent {
    /// Generation on screen afterwards.
    pub generation: u64,
    /// Changed files, as diagnostics name them.
    pub changed: Vec<String>,
    /// Stages that were compiled.
    pub stages: Vec<String>,
    /// Whether the new shaders are on screen.
    pub ok: bool,
    /// From the first file event to the settled set of changes.
    pub detect_ms: f64,
    /// Compiling.
    pub compile_ms: f64,
    /// Creating pipelines.
    pub pipeline_ms: f64,
    /// From the swap to the end of the first frame.
    pub first_frame_ms: f64,
}

/// Prints an event when asked to.
pub fn emit(wanted: bool, event: &Event<'_>) {
    if !wanted {
        return;
    }
    if let Ok(line) = serde_json::to_string(event) {
        use std::io::Write as _;
        // A reader that went away is no reason to stop.
        let _ = writeln!(std::io::stdout().lock(), "{line}");
    }
}
