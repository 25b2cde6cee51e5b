//! State that the panels show but do not change.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::shader_log::ShaderLog;
use crate::events::ReloadEvent;
use crate::frame::PipelineRequest;
use crate::shader::Mode;

/// Duration of a passing message.
const NOTICE: Duration = Duration::from_secs(6);

/// The state of the shader tree.
#[derive(Default)]
pub(super) struct ShaderStatus {
    /// Name of the tree: its folder, or that of the built-in tree.
    pub(super) tree: String,
    /// Folder or file of a tree on disk.
    pub(super) location: Option<PathBuf>,
    /// Whether the tree is a single file of another playground.
    pub(super) is_single_file: bool,
    /// Whether a compile is under way.
    pub(super) compiling: bool,
    /// The last finished reload.
    pub(super) last: Option<ReloadEvent>,
    /// Log of the last edits.
    pub(super) log: ShaderLog,
    /// Whether to ask the driver about the machine code of each picture.
    pub(super) asks_driver: bool,
    /// The picture that the driver was last asked about.
    pub(super) told: Option<PipelineRequest>,
}

/// Messages over the picture.
#[derive(Default)]
pub(super) struct Notices {
    /// The passing message and the time it appeared.
    passing: Option<(String, Instant)>,
    /// Shown until it is dismissed.
    kept: Vec<String>,
}

impl Notices {
    /// Shows a message for a few seconds.
    pub(super) fn say(&mut self, text: String) {
        self.passing = Some((text, Instant::now()));
    }

    /// Shows a message until the user dismisses it. Returns whether the message is new.
    pub(super) fn keep(&mut self, text: String) -> bool {
        let is_new = !self.kept.contains(&text);
        if is_new {
            self.kept.push(text);
        }
        is_new
    }

    /// The passing message and the time that it has left, which is endless if `stays`.
    pub(super) fn passing(&self, stays: bool) -> Option<(&str, Duration)> {
        let (text, since) = self.passing.as_ref()?;
        let left = if stays { Duration::MAX } else { NOTICE.saturating_sub(since.elapsed()) };
        (!left.is_zero()).then_some((text, left))
    }

    /// The messages that the user has not dismissed.
    pub(super) fn kept(&self) -> &[String] {
        &self.kept
    }

    /// Removes a kept message whose reason is gone.
    pub(super) fn end(&mut self, text: &str) {
        self.kept.retain(|kept| kept != text);
    }

    /// Removes all kept messages.
    pub(super) fn dismiss(&mut self) {
        self.kept.clear();
    }
}

/// The title over the picture: the mode on screen and the selected mode that is being built. The final picture has no title.
/// `paths` is the number of random paths per pixel so far in an accumulating mode.
pub(super) fn title(shown: &Mode, set: Option<&Mode>, paths: Option<u32>) -> Option<String> {
    match (set.filter(|set| set.slug != shown.slug), paths) {
        (Some(next), _) => Some(format!("{}  ➡  {} …", shown.name, next.name)),
        (None, Some(1)) => Some(format!("{}   1 path per pixel", shown.name)),
        (None, Some(paths)) => Some(format!("{}   {paths} paths per pixel", shown.name)),
        (None, None) => Some(shown.name.clone()).filter(|_| shown.slug != "final"),
    }
}
