//! The exact value under the mouse. The picture's own value is a half float, and in some modes a color that stands for a number, so the
//! pixel is drawn once more, in 32 bits and with numbers, where the mouse rests.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::background::Background;
use super::between_request::{BetweenRequest, Build, Drawn};
use super::pointed::Pointed;
use super::sets::{BoundSets, Shown, time_to_rest};
use crate::frame::mode_sets;
use crate::gpu::{GpuError, SetLayouts};
use crate::render::{PixelModes, Resources, Thumbnails};
use crate::shader::{Mode, PixelValue};

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

    /// Draws the pixel under the mouse, if its number is outdated and the picture is idle. Returns the time until the next frame is
    /// needed.
    pub(super) fn draw(
        &mut self,
        background: &mut Background,
        request: &BetweenRequest<'_>,
        resources: &mut Resources,
        layouts: &Arc<SetLayouts>,
        drawn: &mut Drawn,
    ) -> Result<Option<Duration>, GpuError> {
        let Some(pointed) = &request.pointed else {
            *self = Self { progress: Progress::Failed, ..Self::default() };
            return Ok(None);
        };
        let Some(picture) = request.picture else { return Ok(None) };
        let now = (picture.of_pixels(pointed.size), pointed.clone());
        if self.shown.as_ref() != Some(&now) {
            if self.shown.as_ref().is_none_or(|(before, _)| *before != now.0) {
                self.asked.clear();
            }
            (self.shown, self.since, self.progress) = (Some(now), Some(Instant::now()), Progress::Missing);
        }
        if !matches!(self.progress, Progress::Missing) {
            return Ok(None);
        }
        let gpu = background.gpu().clone();
        if let Some(left) = time_to_rest(background.is_fast(), self.since) {
            return Ok(Some(left));
        }
        let Some((shown, pointed)) = &self.shown else { return Ok(None) };
        let place = |set: &Vec<_>| set.iter().position(|mode: &&Mode| mode.slug == pointed.mode);
        let sets = if pointed.is_number {
            // The set that the inspector draws, so that both use the same pipelines.
            mode_sets(picture.modes(), Thumbnails::most_at_once(&gpu))
        } else {
            // A pipeline of one mode is built in a fraction of the time.
            picture.modes().filter(|mode| mode.slug == pointed.mode).map(|mode| vec![mode]).collect()
        };
        let Some((set, place)) = sets.into_iter().find_map(|set| place(&set).map(|place| (set, place))) else {
            self.progress = Progress::Failed;
            return Ok(None);
        };
        let result = shown.bind(resources, vec![set], &mut self.asked).and_then(|bound| {
            let BoundSets { ready, missing, is_new } = bound;
            // The open inspector requests it, too.
            let is_asked = request.inspector.as_ref().is_some_and(|inspector| inspector.reading.is_some());
            drawn.builds.extend((is_new && !is_asked).then_some(Build::Inspected(missing)));
            let Some((_, frame)) = ready.first() else { return Ok(false) };
            let renderer = match &mut self.renderer {
                Some(renderer) => renderer,
                none => none.insert(PixelModes::new(&gpu, layouts, 1)?),
            };
            renderer.draw(background.encoder()?, 0, frame, (pointed.at[0], pointed.at[1]))?;
            Ok(true)
        });
        match result {
            Ok(true) => self.progress = Progress::Drawn(place),
            Ok(false) => {}
            Err(error) if error.is_shortage() => (self.renderer, self.progress) = (None, Progress::Failed),
            Err(error) => return Err(error),
        }
        Ok(None)
    }
}
