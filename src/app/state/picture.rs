//! A description of the picture on screen. The engine has the frame itself.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::waits::Waits;
use crate::frame::{Clock, FrameState};
use crate::render::NotFinitePixels;
use crate::settings::Settings;

/// The contents of a complete frame.
#[derive(Clone)]
pub(in crate::app) struct ShownPicture {
    pub(in crate::app) state: Arc<FrameState>,
    pub(in crate::app) settings: Arc<Settings>,
    /// Whether a shader of it reads the time or what it drew before, or its model has an animation.
    pub(in crate::app) is_animated: bool,
    /// Whether it stays the same while the time runs.
    pub(in crate::app) rests: bool,
    /// Whether a shader of it reads keys.
    pub(in crate::app) reads_keys: bool,
}

/// How far the search for NaN in the picture is. Pictures have numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::app) enum Scan {
    /// The picture may change with the next frame.
    #[default]
    Moves,
    /// The picture has been the same since this time.
    Rests(u64, Instant),
    /// A frame copies its pixels.
    Asked(u64),
    Done(u64),
}

/// The picture on screen, and what it lacks of the settings.
#[derive(Default)]
pub(in crate::app) struct Picture {
    /// The last complete frame: the one that the engine draws again until the next one is complete.
    pub(in crate::app) shown: Option<ShownPicture>,
    /// The time in the last frame.
    pub(in crate::app) clock: Clock,
    /// Whether nothing was missing for the last frame.
    pub(in crate::app) is_complete: bool,
    /// Whether the last frame showed the settings, and lacked nothing but stages that it does not need.
    pub(in crate::app) shows_settings: bool,
    /// The shader generation that was last shown with all of its stages and light.
    pub(in crate::app) settled: Option<u64>,
    /// The pixels with NaN or infinity in the last picture that has come to rest, and the generation of its shaders.
    pub(in crate::app) not_finite: Option<(u64, NotFinitePixels)>,
    pub(in crate::app) scan: Scan,
    /// The work that the picture waits for, and since when; `None` when it has everything.
    waits: Option<(Waits, Instant)>,
}

impl Picture {
    /// Whether the picture stays the same while the clock runs: an animation that is not repeated has ended.
    pub(in crate::app) fn rests(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.rests)
    }

    /// Notes what the picture waits for. The time counts from the first frame that waits for it.
    pub(in crate::app) fn wait_for(&mut self, waits: Option<Waits>) {
        let since = self.waits.filter(|(before, _)| Some(*before) == waits).map(|(_, since)| since);
        self.waits = waits.map(|waits| (waits, since.unwrap_or_else(Instant::now)));
    }

    /// The work that the picture waits for, and for how long it has waited.
    pub(in crate::app) fn waits_for(&self) -> Option<(Waits, Duration)> {
        self.waits.map(|(waits, since)| (waits, since.elapsed()))
    }
}
