//! The exact value under the mouse. The picture's own value is a half float, and in some modes a color that stands for a number, so the
//! pixel is drawn once more, in 32 bits and with numbers, where the mouse rests.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::background::Background;
use super::sets::{BoundSets, Shown, shown, time_to_rest};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::frame::{FrameState, TargetFormat, mode_sets};
use crate::gpu::{GpuError, SetLayouts};
use crate::interface::MODE_FINAL;
use crate::render::{PixelModes, Thumbnails};
use crate::shader::graph::RenderPhase;
use crate::shader::{DrawAs, Mode, PixelValue};

/// A pixel of a mode whose value can be read in 32 bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Pointed {
    /// Slug of the mode.
    pub(super) mode: String,
    /// Pixels from the upper left corner of its picture.
    pub(super) at: [u32; 2],
    /// Width and height of the picture, pixels.
    pub(super) size: (u32, u32),
    /// Whether the picture shows a color for each number of the mode.
    pub(super) is_number: bool,
}

impl Pointed {
    /// A pixel of a frame. `None` if the pixel drawn alone would have another value than in the frame: path tracing takes many
    /// frames, lines and layers are blended, and passes may follow the model.
    pub(super) fn new(frame_state: &FrameState, at: (u32, u32)) -> Option<Self> {
        let mode = frame_state.mode()?;
        let is_number = mode.numbers.is_some();
        let is_of_model = mode.pass.is_none() && mode.id != MODE_FINAL && !mode.is_displayed;
        let is_opaque = mode.draw == DrawAs::Surfaces && !mode.through && !mode.follows_paths();
        let mut passes = frame_state.pipelines.passes.iter();
        let has_no_others = passes
            .all(|pass| matches!(pass.phase, RenderPhase::BeforeModel | RenderPhase::Model | RenderPhase::Tonemap));
        let is_same = is_number || is_of_model && is_opaque && has_no_others;
        is_same.then(|| Self { mode: mode.slug.clone(), at: [at.0, at.1], size: frame_state.size, is_number })
    }
}

/// The state of reading the pixel's number.
#[derive(Default)]
enum Progress {
    #[default]
    Missing,
    /// In flight from the device, at this place of its set.
    Drawn(usize),
    Read(PixelValue),
    /// The model has no data for the mode, memory is short, or a loop did not end.
    Failed,
}

/// Reads the value under the mouse.
#[derive(Default)]
pub(super) struct NumberReader {
    renderer: Option<PixelModes>,
    /// The pixel and its picture.
    shown: Option<(Shown, Pointed)>,
    since: Option<Instant>,
    progress: Progress,
    /// The sets of modes whose pipelines the worker was asked for, by their slugs.
    asked: HashSet<String>,
}

impl NumberReader {
    /// Draws nothing until the mouse moves or something changes.
    pub(super) fn stop(&mut self) {
        self.progress = Progress::Failed;
        if let Some(renderer) = &mut self.renderer {
            renderer.forget();
        }
    }

    /// Takes the number of a finished draw.
    pub(super) fn take(&mut self, background: &Background) {
        let Progress::Drawn(place) = self.progress else { return };
        let Some(renderer) = self.renderer.as_ref().filter(|_| background.is_finished()) else { return };
        self.progress = renderer.values(0).into_iter().nth(place).map_or(Progress::Failed, Progress::Read);
    }

    /// The value at a pixel, or `None` in it until it is read. `None` if it cannot be read.
    pub(super) fn value(&self, pointed: &Pointed) -> Option<Option<PixelValue>> {
        let is_same = self.shown.as_ref().is_some_and(|(_, shown)| shown == pointed);
        match self.progress {
            Progress::Failed => None,
            Progress::Read(value) if is_same => Some(Some(value)),
            _ => Some(None),
        }
    }

    /// Draws the pixel under the mouse, `pointed`, if its number is outdated and the picture is idle. Returns the time until the
    /// next frame is needed.
    pub(super) fn draw(
        &mut self,
        background: &mut Background,
        state: &mut State,
        engine: &mut Engine,
        layouts: &Arc<SetLayouts>,
        pointed: Option<Pointed>,
    ) -> Result<Option<Duration>, GpuError> {
        let Some(pointed) = pointed.filter(|_| !engine.recorder.is_safe_mode()) else {
            *self = Self { progress: Progress::Failed, ..Self::default() };
            return Ok(None);
        };
        let Some((shaders, mut now)) = shown(state, engine, pointed.size) else { return Ok(None) };
        (now.target, now.gives_numbers) = (TargetFormat::full(1), true);
        let now = (now, pointed);
        if self.shown.as_ref() != Some(&now) {
            if self.shown.as_ref().is_none_or(|(before, _)| *before != now.0) {
                self.asked.clear();
            }
            (self.shown, self.since, self.progress) = (Some(now), Some(Instant::now()), Progress::Missing);
        }
        if !matches!(self.progress, Progress::Missing) {
            return Ok(None);
        }
        if let Some(left) = time_to_rest(engine, self.since) {
            return Ok(Some(left));
        }
        let Some((shown, pointed)) = &self.shown else { return Ok(None) };
        let features = state.session.features();
        let place = |set: &Vec<_>| set.iter().position(|mode: &&Mode| mode.slug == pointed.mode);
        let with_data = shaders.modes.iter().filter(|mode| mode.has_data(features));
        let sets = if pointed.is_number {
            // The set that the inspector draws, so that both use the same pipelines.
            mode_sets(with_data, Thumbnails::most_at_once(&engine.gpu))
        } else {
            // A pipeline of one mode is built in a fraction of the time.
            with_data.filter(|mode| mode.slug == pointed.mode).map(|mode| vec![mode]).collect()
        };
        let Some((set, place)) = sets.into_iter().find_map(|set| place(&set).map(|place| (set, place))) else {
            self.progress = Progress::Failed;
            return Ok(None);
        };
        let drawn = shown.bind(engine, &shaders, vec![set], &mut self.asked).and_then(|bound| {
            let BoundSets { ready, missing, is_new } = bound;
            // The open inspector requests it, too.
            let is_asked = state.workspace.sight.inspector && state.inspection.reading.is_some();
            if let Some(pipelines) = engine.resources.pipelines().filter(|_| is_new && !is_asked) {
                engine.threads.worker.build_inspected(pipelines, missing);
            }
            let Some((_, frame)) = ready.first() else { return Ok(false) };
            let renderer = match &mut self.renderer {
                Some(renderer) => renderer,
                none => none.insert(PixelModes::new(&engine.gpu, layouts, 1)?),
            };
            renderer.draw(background.encoder()?, 0, frame, (pointed.at[0], pointed.at[1]))?;
            Ok(true)
        });
        match drawn {
            Ok(true) => self.progress = Progress::Drawn(place),
            Ok(false) => {}
            Err(error) if error.is_shortage() => (self.renderer, self.progress) = (None, Progress::Failed),
            Err(error) => return Err(error),
        }
        Ok(None)
    }
}
