//! The values of the inspected pixel on the device: which are out of date, when they are drawn, and when they are read.
//!
//! Like thumbnails they wait for everything else. They are drawn when the picture has come to rest, a few sets of modes after each frame, with
//! pipelines that the worker builds when it has nothing else to do. A failure leaves the values before.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::background::Background;
use super::between_request::{BetweenRequest, Build, Collected, Drawn, Inspected};
use super::sets::{BoundSets, Shown, time_to_rest};
use crate::frame::mode_sets;
use crate::gpu::{GpuError, SetLayouts};
use crate::render::{PixelModes, Resources, TexelReadback, Thumbnails, texel_places};
use crate::shader::Mode;

/// Draws of sets of modes after one frame. On a GPU each takes less than a millisecond.
const DRAWS_PER_FRAME: usize = 3;

/// A draw that may not have finished.
struct Pending {
    /// Its place among the draws of its submission.
    place: usize,
    slugs: Vec<String>,
    /// The picture and pixel that it belongs to.
    picture: u64,
}

/// Reads the inspected pixel.
#[derive(Default)]
pub(super) struct PixelReader {
    renderer: Option<PixelModes>,
    /// The picture that the values belong to, and the pixel.
    shown: Option<(Shown, [u32; 2])>,
    /// Counts the changes of `shown`.
    picture: u64,
    since: Option<Instant>,
    /// The modes that were drawn since the last change.
    drawn: HashSet<String>,
    /// The sets, by the slugs of their modes, whose pipelines the worker was asked for since the last change.
    asked: HashSet<String>,
    pending: Vec<Pending>,
    /// The texels that are copied with the first draw of a picture, and the picture.
    texels: Option<(u64, TexelReadback)>,
    /// The pixel under the mouse when it was last over the picture.
    under_mouse: Option<[u32; 2]>,
    /// Whether drawing is suspended until something changes: memory is short, or a loop did not end.
    stopped: bool,
}

impl PixelReader {
    /// Draws nothing until something changes.
    pub(super) fn stop(&mut self) {
        self.stopped = true;
    }

    /// Forgets draws whose commands were not submitted.
    pub(super) fn forget(&mut self) {
        self.pending.clear();
        self.texels = None;
        self.drawn.clear();
        self.stopped = true;
        if let Some(renderer) = &mut self.renderer {
            renderer.forget();
        }
    }

    /// Takes the values of finished draws.
    pub(super) fn take(&mut self, background: &Background, collected: &mut Collected) {
        let Some(renderer) = self.renderer.as_ref().filter(|_| background.is_finished()) else { return };
        collected.texels = self.texels.take().map(|(picture, readback)| (picture, readback.finish()));
        for Pending { place, slugs, picture } in std::mem::take(&mut self.pending) {
            if picture == self.picture {
                collected.values.push((picture, slugs.into_iter().zip(renderer.values(place)).collect()));
            }
        }
    }

    /// Draws outdated modes, if the picture is idle. Returns the time until the next frame is needed; `None` if all are drawn and
    /// read. A lack of memory is not an error.
    pub(super) fn draw(
        &mut self,
        background: &mut Background,
        request: &BetweenRequest<'_>,
        resources: &mut Resources,
        layouts: &Arc<SetLayouts>,
        drawn: &mut Drawn,
    ) -> Result<Option<Duration>, GpuError> {
        let Some(inspector) = &request.inspector else {
            // The device memory is free for other things while the panel is closed.
            (self.renderer, self.shown) = (None, None);
            return Ok(None);
        };
        if let Some((x, y)) = inspector.mouse {
            self.under_mouse = Some([x, y]);
        }
        let at = inspector.pin.or(self.under_mouse.filter(|_| inspector.follows));
        let Some(at) = at.filter(|at| at[0] < inspector.size.0 && at[1] < inspector.size.1) else {
            self.shown = None;
            return Ok(None);
        };
        let is_dropped = inspector.reading.is_none() && !self.drawn.is_empty();
        let Some(picture) = request.picture else { return Ok(None) };
        let now = (picture.of_pixels(inspector.size), at);
        if is_dropped || self.shown.as_ref() != Some(&now) {
            if self.shown.as_ref().is_none_or(|(before, _)| *before != now.0) {
                self.asked.clear();
            }
            (self.shown, self.since, self.stopped) = (Some(now), Some(Instant::now()), false);
            self.drawn.clear();
            self.picture += 1;
        }
        if self.stopped {
            return Ok(None);
        }
        let gpu = background.gpu().clone();
        let sets = mode_sets(picture.modes(), Thumbnails::most_at_once(&gpu));
        let is_stale = |set: &Vec<&Mode>| set.iter().any(|mode| !self.drawn.contains(&mode.slug));
        let stale: Vec<Vec<&Mode>> = sets.into_iter().filter(is_stale).collect();
        if stale.is_empty() {
            drawn.inspected = Some(Inspected::All(self.picture));
            return Ok(None);
        }
        if let Some(left) = time_to_rest(background.is_fast(), self.since) {
            return Ok(Some(left));
        }
        let begins = inspector.reading != Some(self.picture);
        match self.draw_sets(background, resources, layouts, (stale, begins), drawn) {
            Err(error) if error.is_shortage() => {
                (self.renderer, self.stopped) = (None, true);
                self.pending.clear();
                Ok(Some(Duration::ZERO))
            }
            result => result,
        }
    }

    fn draw_sets(
        &mut self,
        background: &mut Background,
        resources: &mut Resources,
        layouts: &Arc<SetLayouts>,
        (stale, begins): (Vec<Vec<&Mode>>, bool),
        drawn: &mut Drawn,
    ) -> Result<Option<Duration>, GpuError> {
        let Some((shown, at)) = &self.shown else { return Ok(None) };
        let gpu = background.gpu().clone();
        let BoundSets { ready, missing, is_new } = shown.bind(resources, stale, &mut self.asked)?;
        drawn.builds.extend(is_new.then_some(Build::Inspected(missing)));
        if ready.is_empty() {
            return Ok(None);
        }
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(PixelModes::new(&gpu, layouts, DRAWS_PER_FRAME)?),
        };
        let draws = if background.is_fast() { DRAWS_PER_FRAME } else { 1 };
        let encoder = background.encoder()?;
        for (place, (set, frame)) in ready.iter().take(draws).enumerate() {
            if begins && place == 0 {
                drawn.inspected = Some(Inspected::Begun(self.picture, *at, frame.state.clone()));
                let places = texel_places(&frame.state, (at[0], at[1]));
                let readback = TexelReadback::record(&gpu, encoder, resources, places)?;
                self.texels = Some((self.picture, readback));
            }
            renderer.draw(encoder, place, frame, (at[0], at[1]))?;
            let slugs: Vec<String> = set.iter().map(|mode| mode.slug.clone()).collect();
            self.drawn.extend(slugs.iter().cloned());
            self.pending.push(Pending { place, slugs, picture: self.picture });
        }
        Ok(Some(Duration::ZERO))
    }
}
